#include "searches.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "corner_sets.hpp"
#include "part/part_data.hpp"

// Notation:
//   f(s)            Theta(s + L) - Theta(s) - theta of a reading; whole laps of L and their turn are taken off:
//                   `offset_`, `turn_`
//   block           a run of 2^level spirals with a chord of Theta and a strip around it: TurningTree::Block
//   tolerance       with the rounding of Theta and of theta: `tolerance_`
//   among, left     blocks that earlier readings left, and those that this one leaves
// Follows eqs. (4) and (5) of the paper (Jia, IROS 2001); docs/search.md, "Once per reading", step 1.
// Idea: for a block in which the roll starts and one of the same level in which it ends, f is within the sum of both
// strips of a difference of two chords. A pair that can't come within the tolerance of 0 goes; of others the halves are
// looked at.
namespace rollfix::locating {
namespace {

// The level of the tree's pairs of spirals, the lowest. To examine each spiral below costs less than to exclude some.
constexpr std::size_t kLeafLevel = 1;
// While more blocks than this are left, a further reading is asked.
constexpr std::size_t kFewBlocks = 8;
// An arc length is rounded to this share of the lengths that it is made of: times the curvature, an angle.
constexpr double kLengthRounding = 4e-15;

/// Numbers of blocks of the part's tree.
using Blocks = boost::container::small_vector<std::size_t, 16>;

/// Pairs of blocks on which a roll starts and ends, for one reading, from all spirals down to a few.
class Descent {
 public:
  /// `range`: of first contacts; `tolerance`: of |f|, radians. Whole laps of L are taken off a closed part, and their
  /// turn off theta: f is the same.
  Descent(const Part& part, const Reading& reading, const Interval& range, double tolerance)
      : turning_(part.turning()), tree_(PartAccess::data(part).tree), range_(range) {
    const double period = part.perimeter();
    const double length = reading.length[0];
    same_place_ = kSamePlaces * kLengthAccuracy * period + kLengthRounding * std::abs(length);
    tolerance_ = tolerance + kTurnAccuracy + kAngleRounding * std::abs(reading.turn);
    offset_ = length;
    turn_ = reading.turn;
    if (!part.closed()) return;
    const Wrapped laps = wrap(length, period);
    offset_ = laps.base;
    turn_ -= laps.winding * turning_.period_turn();
  }

  /// The blocks of the leaves' level on which a roll that fits can start, in order: of all, or of these.
  Blocks run(const Blocks* among, SearchCounts& counts) {
    among_ = among;
    // Start and end both on the first lap: s + L <= P, whole laps taken off L.
    const Stretch all{0, 0, turning_.perimeter()};
    visit(tree_.top(), all, all);
    if (turning_.closed()) {
      // On the next lap; and where the roll ends at s = 0 itself, at the joint that the lap before ends with.
      for (const int step : {1, -2}) {
        offset_ -= step * turning_.perimeter();
        turn_ -= step * turning_.period_turn();
        visit(tree_.top(), all, all);
      }
    }
    std::sort(left_.begin(), left_.end());
    left_.erase(std::unique(left_.begin(), left_.end()), left_.end());
    counts.intervals += intervals_;
    return std::move(left_);
  }

 private:
  /// A block and its arc lengths.
  struct Stretch {
    std::size_t index = 0;
    double lo = 0;
    double hi = 0;
  };

  /// Excludes the first contacts on block `start` whose rolls end on block `end`, or goes on to the four pairs of
  /// halves, or keeps `start` on the lowest level. Few pairs of a level remain around each answer, for a strip's width
  /// falls with the square of the block's length.
  void visit(std::size_t level, const Stretch& start, const Stretch& end) {
    // The first contacts for which the roll starts on the one block and ends on the other.
    const Interval s{std::max({start.lo, end.lo - offset_, range_.lo}),
                     std::min({start.hi, end.hi - offset_, range_.hi})};
    if (s.lo > s.hi + same_place_ || !is_asked_for(level, start)) return;
    if (!may_fit(level, start, end, s)) return;
    if (level == kLeafLevel) {
      left_.push_back(start.index);
      return;
    }
    const std::size_t below = level - 1;
    const auto [first_start, second_start] = halves(below, start);
    const auto [first_end, second_end] = halves(below, end);
    visit(below, first_start, first_end);
    visit(below, first_start, second_end);
    visit(below, second_start, first_end);
    visit(below, second_start, second_end);
  }

  /// The two blocks of level `below` that make up this one. The last block of a level may have only the first of them:
  /// then the second is kNone, which is empty.
  std::pair<Stretch, Stretch> halves(std::size_t below, const Stretch& whole) const {
    const std::size_t second = 2 * whole.index + 1;
    if (second >= tree_.count(below)) return {{2 * whole.index, whole.lo, whole.hi}, kNone};
    const double middle = tree_.block(below, second).lo;
    return {{2 * whole.index, whole.lo, middle}, {second, middle, whole.hi}};
  }

  /// Is there something to learn about this block: not kept already, and some part of it left by the readings before?
  bool is_asked_for(std::size_t level, const Stretch& start) const {
    if (level == kLeafLevel && !left_.empty() && left_.back() == start.index) return false;  // is in already
    if (among_ == nullptr) return true;
    // A block k of this level holds the blocks k 2^width, ..., (k + 1) 2^width - 1 of the lowest one.
    const std::size_t width = level - kLeafLevel;
    const auto next = std::lower_bound(among_->begin(), among_->end(), start.index << width);
    return next != among_->end() && *next >> width == start.index;
  }

  /// Can f be within the tolerance for some s in this interval? Pivots at the joints where the two blocks end are
  /// included. False is proved; true may be wrong, which costs time only.
  bool may_fit(std::size_t level, const Stretch& start, const Stretch& end, const Interval& s) {
    ++intervals_;
    const TurningTree::Block& at_start = tree_.block(level, start.index);
    const TurningTree::Block& at_end = tree_.block(level, end.index);
    // f less the two strips: straight in s, so its values at both ends bound it.
    const double first = at_end.chord(s.lo + offset_) - at_start.chord(s.lo) - turn_;
    const double last = at_end.chord(s.hi + offset_) - at_start.chord(s.hi) - turn_;
    // The places where the chords are taken are off by rounding, which times the slope is an angle.
    const double far = tolerance_ + same_place_ * (at_start.steepest + at_end.steepest);
    // f is above the straight line by [below, above]. The jump at a block's end is that of a pivot at its last joint.
    const double below = std::min(at_end.below, at_end.jump) - std::max(at_start.above, at_start.jump);
    const double above = std::max(at_end.above, at_end.jump) - std::min(at_start.below, at_start.jump);
    return std::min(first, last) + below <= far && std::max(first, last) + above >= -far;
  }

  static constexpr double kNowhere = std::numeric_limits<double>::infinity();
  static constexpr Stretch kNone{0, kNowhere, kNowhere};

  const TurningFunction& turning_;
  const TurningTree& tree_;
  Interval range_;
  std::size_t intervals_ = 0;  // looked at
  double same_place_ = 0;
  double tolerance_ = 0;  // what angles are accurate to included
  double offset_ = 0;     // from the start's s to the end's on its lap
  double turn_ = 0;       // theta, the laps' turn taken off
  const Blocks* among_ = nullptr;
  Blocks left_;
};

}  // namespace

Candidates find_candidates(const ContactEquations& question, const Interval& range, double tolerance) {
  const Part& part = question.part;
  const double same_place = kLengthAccuracy * part.perimeter();
  if (PartAccess::data(part).tree.is_empty() || range.width() <= same_place) return {{range}, {}};
  Candidates found;
  Blocks left;
  bool is_first = true;
  // Every reading excludes by itself: a later one is asked about the blocks that the earlier ones left.
  for (const Reading& reading : question.readings) {
    left = Descent(part, reading, range, tolerance + reading.pivot).run(is_first ? nullptr : &left, found.counts);
    is_first = false;
    if (left.size() <= kFewBlocks) break;
  }
  const std::vector<Spiral>& spirals = part.turning().spirals();
  for (std::size_t k = 0; k < left.size(); ++k) {
    // Neighbouring blocks make one stretch: the sweep enters each stretch anew.
    const std::size_t first = left[k] << kLeafLevel;
    while (k + 1 < left.size() && left[k + 1] == left[k] + 1) ++k;
    const std::size_t last = std::min((left[k] + 1) << kLeafLevel, spirals.size()) - 1;
    found.stretches.push_back({std::max(range.lo, spirals[first].lo), std::min(range.hi, spirals[last].hi)});
  }
  return found;
}

}  // namespace rollfix::locating
