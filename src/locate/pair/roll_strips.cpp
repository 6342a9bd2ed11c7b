#include "roll_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "locate/searches.hpp"
#include "part/cursor.hpp"
#include "part/part_data.hpp"

// Notation:
//   s, s + L_c      first contact and contact c; place on the boundary = s + `offset_[c]`, laps (`winding_`) taken off
//   Theta           on a block: `chord` + [`below`, `above`]; `lift_` is the turn of the laps that were taken off
//   span            the spirals that a contact passes while the first one is in the range
// Follows one side of eqs. (8) and (9) of the paper (Jia, IROS 2001); docs/search.md, "Once per part" and "Two
// fingers", step 1. The strips are those of D. H. Ballard, "Strip trees: a hierarchical representation for curves"
// (1981).
// Idea: while both contacts are on one block each, Theta(s + L_c) - Theta(s) is a difference of chords, which is
// straight, plus a difference of strips. So outlines with very many spirals are bounded without being cut.
namespace rollfix::locating {
namespace {

// A contact's strips are of blocks so large that it passes no more than about this many.
constexpr std::uint32_t kMostBlocks = 2;
// Of fewer spirals cutting all at once costs less.
constexpr std::size_t kFewestSpirals = 60;

}  // namespace

/// A contact's strip while the first contact moves on, from block to block.
class RollStrips::Walk {
 public:
  Walk(const RollStrips& strips, std::size_t contact, std::uint32_t first, std::size_t level)
      : strips_(&strips), level_(level), shift_(-strips.offset_[contact]), lift_(strips.lift_[contact]) {
    const auto count = static_cast<std::uint32_t>(strips.turning_.spirals().size());
    if (first >= count) next_lap();
    enter((first >= count ? first - count : first) >> level);
  }

  /// The first contact's place where the strip ends: an open boundary's last one never does.
  double end() const { return end_; }
  /// The strip's chord at first contact s: Theta at this contact lies within [below, above] of it.
  double chord(double s) const { return block().chord(s - shift_) + lift_; }
  const TurningTree::Block& block() const { return strips_->tree_.block(level_, k_); }
  /// To the next block of the level.
  void advance() {
    const bool is_last = k_ + 1 == strips_->tree_.count(level_);
    if (is_last) next_lap();
    enter(is_last ? 0 : k_ + 1);
  }

 private:
  /// To the boundary's start, one lap further.
  void next_lap() {
    shift_ += strips_->turning_.perimeter();
    lift_ += strips_->turning_.period_turn();
  }
  void enter(std::size_t k) {
    k_ = k;
    if (k + 1 < strips_->tree_.count(level_)) {
      end_ = shift_ + strips_->tree_.block(level_, k + 1).lo;
    } else {
      end_ =
          strips_->turning_.closed() ? shift_ + strips_->turning_.perimeter() : std::numeric_limits<double>::infinity();
    }
  }

  const RollStrips* strips_;
  std::size_t level_;
  double shift_;  // from a place on the boundary to that of the first contact
  double lift_;
  std::size_t k_ = 0;
  double end_ = 0;
};

/// The spirals that each contact passes while the first one runs over the range; laps beyond the first are counted on.
RollStrips::RollStrips(const Part& part, const RollEquations& equations, const Interval& range)
    : turning_(part.turning()),
      tree_(PartAccess::data(part).tree),
      equations_(equations),
      is_wanted_(part.corners().empty() && turning_.spirals().size() >= kFewestSpirals),
      same_place_(kSamePlaces * kLengthAccuracy * part.perimeter()) {
  if (is_empty()) return;
  const auto count = static_cast<double>(turning_.spirals().size());
  for (std::size_t c = 0; c < equations.contacts(); ++c) {
    const Cursor first(turning_, range.lo + equations.length_to(c));
    const Cursor last(turning_, range.hi + equations.length_to(c), Side::before);
    offset_.push_back(equations.length_to(c) - first.shift());
    winding_.push_back(first.winding());
    lift_.push_back(first.lift());
    // Spirals of a further lap are counted on from the first lap's number of them.
    const double laps = last.winding() - first.winding();
    const auto first_index = static_cast<std::uint32_t>(first.index());
    const auto last_index = static_cast<std::uint32_t>(laps * count + static_cast<double>(last.index()));
    whole_.push_back({first_index, std::max(first_index, last_index)});
  }
}

double RollStrips::joint(std::uint32_t index) const {
  const std::vector<Spiral>& spirals = turning_.spirals();
  return index < spirals.size() ? spirals[index].lo : spirals[index - spirals.size()].lo + turning_.perimeter();
}

/// The last spiral of these that starts at `base` or before.
std::uint32_t RollStrips::spiral_at(const Span& among, double base) const {
  std::uint32_t first = among.first;
  std::uint32_t last = among.last;
  // Spiral `first` starts at `base` or before, or is the first of all; those after `last` start beyond it.
  while (first < last) {
    const std::uint32_t middle = last - (last - first) / 2;
    if (joint(middle) <= base) {
      first = middle;
    } else {
      last = middle - 1;
    }
  }
  return first;
}

std::size_t RollStrips::cuts(const Span* spans) const {
  std::size_t sum = 0;
  for (std::size_t c = 0; c < equations_.contacts(); ++c) sum += spans[c].last - spans[c].first;
  return sum;
}

/// The first contact's place at which a contact passes into spiral `index`, to the bit as `RollCurve::make_pieces` has
/// it: uncut nodes and pieces then have the same ends. REQUIRES index > 0.
double RollStrips::place_of(std::size_t contact, std::uint32_t index) const {
  const std::vector<Spiral>& spirals = turning_.spirals();
  // The spiral before ends there: the cutting takes that end, not the next one's start, and takes laps off L in this
  // order.
  const std::size_t before = index - 1;
  const double laps = winding_[contact] + (before < spirals.size() ? 0 : 1);
  return spirals[before % spirals.size()].hi - (equations_.length_to(contact) - laps * turning_.perimeter());
}

double RollStrips::halve(const Span* spans, Span* below, Span* above) const {
  // Halves the longest span by number; the other contacts' spans are cut where they are at that moment.
  std::size_t longest = 0;
  const auto length = [&](std::size_t c) { return spans[c].last - spans[c].first; };
  for (std::size_t c = 1; c < equations_.contacts(); ++c) {
    if (length(c) > length(longest)) longest = c;
  }
  const std::uint32_t middle = spans[longest].last - length(longest) / 2;
  const double place = place_of(longest, middle);
  double first = place;  // of joints at the same place
  for (std::size_t c = 0; c < equations_.contacts(); ++c) {
    const std::uint32_t next = c == longest ? middle : spiral_at(spans[c], place + offset_[c]);
    below[c] = {spans[c].first, c == longest ? middle - 1 : next};
    above[c] = {next, spans[c].last};
    // A contact that passes its joint within rounding of the cut: the earlier of both places stands for both.
    if (next == spans[c].first) continue;
    const double other = place_of(c, next);
    if (other < first && other >= place - kLengthAccuracy * turning_.perimeter()) first = other;
  }
  return first;
}

/// A walk along a contact's strips from first contact s on, of the lowest level whose blocks it passes no more than
/// about kMostBlocks of: `bound` then takes a few steps, however many spirals there are.
RollStrips::Walk RollStrips::walk(std::size_t contact, double s, const Span& span) const {
  std::size_t level = 1;
  while (level < tree_.top() && (span.last - span.first) >> level >= kMostBlocks) ++level;
  Walk walk(*this, contact, span.first, level);
  while (walk.end() <= s) walk.advance();
  return walk;
}

/// Bounds on Theta at the end contact less Theta at the first one for first contacts in [lo, hi], on which both are on
/// one strip each; without an end contact on Theta at the first one. A difference of chords is straight: its values at
/// lo and hi bound it.
Range RollStrips::between(const Walk& start, const Walk* end, double lo, double hi) const {
  Range strip{start.block().below, start.block().above};
  double first = start.chord(lo);
  double last = start.chord(hi);
  double steepest = start.block().steepest;
  if (end != nullptr) {
    strip = Range{end->block().below, end->block().above} - strip;
    first = end->chord(lo) - first;
    last = end->chord(hi) - last;
    steepest += end->block().steepest;
  }
  // Theta's own accuracy, the rounding of the angles, and that of the places where the chords are taken.
  const double rounding = kTurnAccuracy + kAngleRounding * (std::abs(first) + std::abs(last)) + same_place_ * steepest;
  return hull(first, last) + strip + Range{-rounding, rounding};
}

/// The same for all of s: the hull over the stretches on which no contact changes its strip.
Range RollStrips::bound(const Interval& s, Walk start, Walk* end) const {
  Range all{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  // Up to the next change of a strip; what lies before `lo` is in `all`.
  for (double lo = s.lo;;) {
    const double hi = std::min({start.end(), end != nullptr ? end->end() : s.hi, s.hi});
    const Range here = between(start, end, lo, hi);
    all = {std::min(all.least, here.least), std::max(all.most, here.most)};
    if (hi >= s.hi) return all;
    if (start.end() <= hi) start.advance();
    if (end != nullptr && end->end() <= hi) end->advance();
    lo = hi;
  }
}

void RollStrips::bound(const Interval& s, const Span* spans, Range* values) const {
  const auto shifted = [](const Range& range, double by) { return range + Range{by, by}; };
  const Walk start = walk(0, s.lo, spans[0]);
  for (std::size_t k = 0; k < equations_.lengths.size(); ++k) {
    Walk end = walk(k + 1, s.lo, spans[k + 1]);
    values[k] = shifted(bound(s, start, &end), equations_.shifts[k]);
  }
  if (equations_.facing) values[equations_.lengths.size()] = shifted(bound(s, start, nullptr), *equations_.facing);
}

}  // namespace rollfix::locating
