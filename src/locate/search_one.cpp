#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "part/cursor.hpp"
#include "part/part_data.hpp"
#include "root_search.hpp"
#include "searches.hpp"

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

// ---- one finger
// Notation:
//   s, s + L        start and end of a roll: `here` (up to `next`), and `here + pair.offset` on the end's own spiral
//   L, theta        the reading: `length_`, `reading_->turn`
//   f(s)            Theta(s + L) - Theta(s) - theta; where the end is at a convex corner, an interval of values
//   shift, lift     of a cursor: length and turn of the whole laps that it has gone round
//   pieces          the starts on which |f| is within the tolerance; `roots`: the places worth listing in them
// Follows eqs. (4) and (5) of the paper (Jia, IROS 2001); docs/search.md, "Once per reading", steps 2 and 6. Step 1,
// what is passed over, is above; steps 3 to 5 are root_search.cpp.
// Idea: s runs along the boundary and s + L runs with it. Where either of them passes to another spiral is a cut;
// between cuts one pair of spirals is searched. A further reading is searched only on the pieces that those before it
// left.

namespace {

/// Moves the first contact along stretches of the boundary and searches f of one reading on every pair of spirals that
/// the roll's two ends pass.
class Sweep {
 public:
  Sweep(const ContactEquations& question, const LocateOptions& options)
      : part_(question.part),
        turning_(part_.turning()),
        same_place_(kLengthAccuracy * part_.perimeter()),
        allowed_(options.tolerance),
        tolerance_(options.tolerance),
        search_(options.tolerance, options.budget, part_.perimeter()) {}

  /// What is run from here on is about this reading.
  void ask(const Reading& reading) {
    reading_ = &reading;
    length_ = reading.length[0];
    tolerance_ = allowed_ + reading.pivot;
    search_.allow(allowed_, reading.pivot);
  }

  /// What all runs found together.
  Findings& found() { return search_.findings; }

  /// Walks the first contact s along [lo, hi] of the boundary: cuts it where s or its end s + L passes from one spiral
  /// to the next, searches each piece, and looks at the pivot wherever the end passes a convex corner. Stops where it
  /// gives up: after that there must be no other run.
  void run(const Interval& range) {
    if (range.width() <= same_place_) {
      look_at(range);
      return;
    }
    // On every turn of the loop all s < here are decided, and from_start and from_end are Theta and kappa at s = here
    // and at its end, as limits from above.
    Cursor start = Cursor::ahead(turning_, range.lo);
    Cursor end = Cursor::ahead(turning_, range.lo + length_);
    auto [from_start, from_end] = enter(start, end, range.lo);
    double here = range.lo;
    while (here < range.hi && search_.findings.unresolved.empty()) {
      const SpiralPair pair = pair_of(start, end);
      // The s at which the start passes to the next spiral, and the s at which the end does.
      const double start_passes = pair.start.hi;
      const double end_passes = pair.end.hi - pair.offset;
      double next = std::min({start_passes, end_passes, range.hi});
      if (range.hi - next <= same_place_) next = range.hi;
      // Both may pass at once, as where L is the period of a symmetric part.
      const bool start_moves = start_passes - next <= same_place_ && !start.is_last();
      const bool end_moves = end_passes - next <= same_place_ && !end.is_last();

      // A spiral's own end costs no evaluation, so that a cut takes one evaluation at most.
      const Turning at_start = start_moves ? end_of(pair.start, next) : turning_.on_spiral(pair.start, next);
      const Turning at_end =
          end_moves ? end_of(pair.end, next + pair.offset) : turning_.on_spiral(pair.end, next + pair.offset);
      search_.findings.counts.evaluations += (start_moves ? 0 : 1) + (end_moves ? 0 : 1);
      // Cuts that differ by rounding leave nothing between them.
      if (next - here > same_place_) {
        search_.run(pair, pair.sample(here, from_start, from_end), pair.sample(next, at_start, at_end));
      }
      // The budget is used up: what lies ahead is not decided either.
      if (!search_.findings.unresolved.empty()) search_.findings.unresolved.back().hi = range.hi;

      if (next >= range.hi && !end_moves) break;
      if (end_moves) {
        // Theta on both sides of the joint that the end passes, unwrapped. Between them f(next) is a set.
        const double before = pair.end.end.angle + end.lift();
        end.advance();
        const double after = end.angle_after();
        pass_corner(next, at_start.angle, before, after);
        if (start_moves && next < range.hi) {  // both at once: the start's other side
          pass_corner(next, turning_.spirals()[start.index() + 1].start.angle, before, after);
        }
      }
      if (next >= range.hi) break;
      if (start_moves) start.advance();
      // The same place, as the limits from above: on the spirals that begin there.
      const SpiralPair onwards = pair_of(start, end);
      from_start = start_moves ? start_of(start.spiral(), next) : at_start;
      from_end = end_moves ? start_of(end.spiral(), next + onwards.offset) : at_end;
      here = next;
    }
  }

 private:
  /// A single place: the only first contact of an open curve for a roll as long as the curve, or what the narrowest
  /// tolerance of another reading left. |f| changes across it by its width times the slope.
  void look_at(const Interval& place) {
    const double s = place.middle();
    const double residual = residual_at({part_, {reading_, 1}}, s);
    const double slope = std::abs(turning_.curvature(s)) + std::abs(turning_.curvature(s + length_));
    if (residual > allowed_ + 0.5 * place.width() * slope) return;
    search_.findings.pieces.push_back({place.lo, place.hi});
    search_.findings.roots.push_back({s, residual <= kTurnAccuracy});
  }

  /// The pair of spirals that the start and the end of the roll are on. The end's laps are taken off L and off theta,
  /// so that Theta is evaluated on the first lap only.
  SpiralPair pair_of(const Cursor& start, const Cursor& end) const {
    return {turning_, start.spiral(), end.spiral(), length_ - end.shift(), reading_->turn - end.lift()};
  }

  /// A spiral's own ends, as seen from a place beside them that is the same up to rounding: where curvature is large
  /// that makes more of a difference than the tolerance.
  Turning start_of(const Spiral& spiral, double s) const { return beside(spiral, spiral.start, spiral.lo, s); }
  Turning end_of(const Spiral& spiral, double s) const { return beside(spiral, spiral.end, spiral.hi, s); }
  Turning beside(const Spiral& spiral, const Turning& at, double end, double s) const {
    const double turn = at.curvature * (s - end);
    if (std::abs(turn) <= kTurnAccuracy) return {at.angle + turn, at.curvature};
    // Where a curve is at rest its curvature falls from infinity: by what the spiral turns on the inside.
    const bool is_inside = s >= spiral.lo && s <= spiral.hi;
    const double inner = std::clamp(is_inside ? s : 2 * end - s, spiral.lo, spiral.hi);
    const double change = turning_.on_spiral(spiral, inner).angle - at.angle;
    return {at.angle + (is_inside ? change : -change), at.curvature};
  }

  /// Both contacts at the beginning, and the corner where the end stands, if it does.
  std::pair<Turning, Turning> enter(Cursor& start, const Cursor& end, double lo) {
    // s = P - rounding: the same place, one lap earlier.
    if (start.winding() > 0) start = Cursor::at_spiral(turning_, start.index());
    const SpiralPair pair = pair_of(start, end);
    const double s = std::max(lo, pair.start.lo);
    const Turning at_start = turning_.on_spiral(pair.start, s);
    search_.findings.counts.evaluations += 2;
    if (std::abs(lo + pair.offset - pair.end.lo) <= same_place_ && !end.is_first()) {
      pass_corner(lo, at_start.angle, end.angle_before(), end.angle_after());
    }
    return {at_start, turning_.on_spiral(pair.end, s + pair.offset)};
  }

  /// The end of the roll passes a joint while the start is at s: where that is a convex corner, or a tiny concave one,
  /// f(s) is an interval.
  void pass_corner(double s, double start_angle, double before, double after) {
    const Corner corner{s, after - before};
    if (std::abs(corner.turn) <= kTurnAccuracy || corner.is_concave()) return;
    // f(s) is anything in [least, most]: `distance` is how far 0 is outside.
    const double least = std::min(before, after) - start_angle - reading_->turn;
    const double most = std::max(before, after) - start_angle - reading_->turn;
    const double distance = std::max({least, -most, 0.0});
    if (distance > tolerance_) return;
    search_.findings.pieces.push_back({s, s, false, true});
    search_.findings.roots.push_back({s, distance <= kTurnAccuracy, true});
  }

  const Part& part_;
  const TurningFunction& turning_;
  const Reading* reading_ = nullptr;
  double length_ = 0;  // L
  double same_place_;
  double allowed_;    // of |f|
  double tolerance_;  // with what the reading leaves open
  RootSearch search_;
};

/// What the first reading allows on the stretches of the range.
void search_stretches(const ContactEquations& question, const Interval& range, const Stretches& stretches,
                      Sweep& sweep) {
  const double same_place = kLengthAccuracy * question.part.perimeter();
  // After an unresolved interval there is no further run: it is widened to the end of the range below.
  sweep.ask(question.readings.front());
  Findings& found = sweep.found();
  for (const Interval& stretch : stretches) {
    // A single place beside what is passed over is there for its corner.
    if (stretch.width() > same_place || range.width() <= same_place) sweep.run(stretch);
    if (!found.unresolved.empty()) break;
  }
  if (!found.unresolved.empty()) found.unresolved.back().hi = range.hi;
}

/// Pieces that touch are one: else what a reading cuts into pieces, though it allows all of it, as a finger at rest
/// does, a further one cuts again and again. Continua stay apart from what is beside them.
void join_touching(Pieces& pieces) {
  // Pieces are in rising order; [0, last] are joined already.
  const auto is_plain = [](const StartPiece& piece) { return !piece.exact && !piece.corner; };
  std::size_t last = 0;
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    if (is_plain(pieces[last]) && is_plain(pieces[k]) && pieces[k].lo <= pieces[last].hi) {
      pieces[last].hi = std::max(pieces[last].hi, pieces[k].hi);
    } else {
      pieces[++last] = pieces[k];
    }
  }
  if (!pieces.empty()) pieces.resize(last + 1);
}

/// Keeps of each piece what a further reading allows as well; at a corner's pivot what all of them allow together.
void narrow(const ContactEquations& question, const Reading& further, double tolerance, Sweep& sweep) {
  // Off corners the readings before were applied already. A pivot is shared by all readings, so all are applied
  // together.
  const ContactEquations its_own{question.part, {&further, 1}};
  Findings& kept = sweep.found();
  Pieces pieces = std::exchange(kept.pieces, {});
  join_touching(pieces);
  sweep.ask(further);
  for (const StartPiece& piece : pieces) {
    if (!kept.unresolved.empty()) {
      // Given up: what is left of the earlier readings is listed instead.
      kept.unresolved.push_back({piece.lo, piece.hi});
    } else if (piece.lo == piece.hi) {
      const double residual = residual_at(piece.corner ? question : its_own, piece.lo);
      if (residual <= tolerance) kept.pieces.push_back(piece);
    } else {
      const std::size_t first = kept.pieces.size();
      // f = 0 on the piece only if every reading's f is.
      sweep.run({piece.lo, piece.hi});
      for (std::size_t k = first; k < kept.pieces.size(); ++k) kept.pieces[k].exact &= piece.exact;
    }
  }
}

/// A first contact at a convex corner: the finger may have pivoted there by any amount, the same for all readings.
void look_at_start(const ContactEquations& question, const Corner& corner, double tolerance, Findings& findings) {
  if (corner.is_concave()) return;
  const double residual = residual_at(question, corner.s);
  if (residual > tolerance) return;
  findings.pieces.push_back({corner.s, corner.s, false, true});
  findings.roots.push_back({corner.s, residual <= kTurnAccuracy, true});
}

/// Examines each convex corner on the stretches as a first contact. The sweep takes the two limits of Theta there, not
/// the angles in between.
void add_start_corners(const ContactEquations& question, const Stretches& stretches, double tolerance,
                       Findings& findings) {
  const Part& part = question.part;
  const std::vector<Corner>& corners = part.corners();
  if (corners.empty() || stretches.empty()) return;
  const bool ends_at_seam = part.closed() && stretches.back().hi >= part.perimeter();
  // The corner at s = 0 is also the end, s = P, of the last stretch.
  if (corners.front().s == 0 && ends_at_seam && stretches.front().lo > 0) {
    look_at_start(question, corners.front(), tolerance, findings);
  }
  for (const Interval& stretch : stretches) {
    auto next = std::lower_bound(corners.begin(), corners.end(), stretch.lo,
                                 [](const Corner& corner, double s) { return corner.s < s; });
    for (; next != corners.end() && next->s <= stretch.hi; ++next) {
      look_at_start(question, *next, tolerance, findings);
    }
  }
}

/// The same intervals, those that touch made one.
std::vector<PerFinger<Interval>> joined(std::vector<Interval> intervals) {
  std::sort(intervals.begin(), intervals.end(),
            [](const Interval& one, const Interval& two) { return one.lo < two.lo; });
  std::vector<PerFinger<Interval>> result;
  for (const Interval& interval : intervals) {
    if (!result.empty() && interval.lo <= result.back()[0].hi) {
      result.back()[0].hi = std::max(result.back()[0].hi, interval.hi);
    } else {
      result.emplace_back(interval);
    }
  }
  return result;
}

}  // namespace

/// One finger: passes over what the tree excludes, sweeps the rest for the first reading, narrows by each further one,
/// adds first contacts at corners, and makes placements. `Search::status` is left to the caller.
Search search_one(const ContactEquations& question, const LocateOptions& options) {
  const Interval range = first_contacts(question, 0);
  const Candidates candidates = find_candidates(question, range, options.tolerance);
  Sweep sweep(question, options);
  search_stretches(question, range, candidates.stretches, sweep);
  for (const Reading& further : question.readings.subspan(1)) narrow(question, further, options.tolerance, sweep);
  Findings& found = sweep.found();
  add_start_corners(question, candidates.stretches, options.tolerance, found);
  Search search;
  search.unresolved = joined(std::move(found.unresolved));
  search.counts = {found.counts.intervals + candidates.counts.intervals,
                   found.counts.evaluations + candidates.counts.evaluations};
  search.placements = make_placements(question, std::move(found));
  return search;
}

}  // namespace rollfix::locating
