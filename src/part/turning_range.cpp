#include "turning_range.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cursor.hpp"

// Notation:
//   Theta(s)        the tangent's angle, one-sided limits at corners included
//   [least, most]   of Theta over an arc of the boundary: `angles_over` exactly, TurningRange by a table
//   step            length of a cell of the table: `step_`; cells reach `kBeyondCell` farther, bounds are rounded
//                   outwards
//   least_[j][k], most_[j][k]  over the 2^j cells from k on
//   block           a run of 2^level neighbouring spirals: TurningTree::Block
//   chord           angle + slope (s - lo), straight from Theta just after the block's start to Theta just before its
//                   end
//   below, above    how far Theta gets from the chord; `jump` is of Theta at the joint where the block ends
//   sag             |change of kappa| times width / 4: how far Theta gets from its chord on one spiral, to one side
// Follows docs/two_fingers.md, "The search", step 1, docs/identify.md, "How parts are ruled out", and docs/search.md,
// "Once per part". The strips are those of D. H. Ballard, "Strip trees: a hierarchical representation for curves"
// (1981).
// Idea: on a spiral kappa keeps its sign, so that Theta is monotone and its values at the ends bound it. A sparse table
// then answers for any arc with two look-ups: two runs of 2^j cells that overlap cover it. In the tree two neighbours'
// chords leave the chord of both most at the joint in between, so that a level is made of the one below it in linear
// time, and two blocks bound Theta(s + L) - Theta(s) without a look at what is in them.
namespace rollfix {
namespace {

// Rounding may put a joint on either side of a cell's end: cells are looked at this share of them farther.
constexpr double kBeyondCell = 1e-6;
// Of a number that is kept in single precision, relative.
constexpr double kFloatSlack = 4e-7;
constexpr Interval kAnyAngle{-1e9, 1e9};

}  // namespace

/// Walks from spiral to spiral: Theta is monotone on each, so the values at the ends of the spirals, and at both ends
/// of the arc, are all that can be extreme. Linear in the number of spirals on the arc.
Interval angles_over(const TurningFunction& turning, const Interval& arc) {
  const double lap = turning.perimeter();
  if (turning.boundary().closed && arc.width() > 2 * lap) {
    // A place's angles are a lap's turn apart: the least and the largest of them are on its first lap and its last.
    const Interval first = angles_over(turning, {arc.lo, arc.lo + lap});
    const Interval last = angles_over(turning, {arc.hi - lap, arc.hi});
    return {std::min(first.lo, last.lo), std::max(first.hi, last.hi)};
  }
  // A corner at either end of the arc counts with both its limits.
  const double first = turning.angle(arc.lo, Side::before);
  Interval angles{first, first};
  const auto include = [&](double angle) { angles = {std::min(angles.lo, angle), std::max(angles.hi, angle)}; };
  Cursor at(turning, arc.lo, Side::before);
  // Each turn: the spiral ends within the arc; both limits of the joint behind it are taken.
  while (at.hi() <= arc.hi && !at.is_last()) {
    include(at.spiral().end.angle + at.lift());
    at.advance();
    include(at.angle_after());
  }
  // The last spiral, on which the arc ends.
  const double end = std::clamp(arc.hi - at.shift(), at.spiral().lo, at.spiral().hi);
  include(turning.on_spiral(at.spiral(), end).angle + at.lift());
  return angles;
}

TurningRange::TurningRange(const TurningFunction& turning, std::size_t cells)
    : step_(turning.perimeter() / static_cast<double>(cells)),
      boundary_(turning.boundary()),
      period_turn_(turning.period_turn()) {
  // Two laps of a closed boundary, so that an arc across s = 0 is one run of cells.
  const std::size_t count = boundary_.closed ? 2 * cells : cells;
  least_.emplace_back(count);
  most_.emplace_back(count);
  for (std::size_t k = 0; k < cells; ++k) {
    const double lo = step_ * static_cast<double>(k);
    const Interval angles = angles_over(turning, {lo - kBeyondCell * step_, lo + (1 + kBeyondCell) * step_});
    for (std::size_t i = k; i < count; i += cells) {
      // Rounding to single precision must not narrow the bounds: kFloatSlack is several units in its last place.
      const double lift = i > k ? period_turn_ : 0;
      least_[0][i] = static_cast<float>(angles.lo + lift - kFloatSlack * std::abs(angles.lo + lift));
      most_[0][i] = static_cast<float>(angles.hi + lift + kFloatSlack * std::abs(angles.hi + lift));
    }
  }
  // Level j + 1 from level j: a run of 2 width cells is two runs of width cells. count log(count) entries in all.
  for (std::size_t width = 1; 2 * width <= count; width *= 2) {
    const std::vector<float>& lo = least_.back();
    const std::vector<float>& hi = most_.back();
    std::vector<float> wider_lo(lo.size() - width);
    std::vector<float> wider_hi(wider_lo.size());
    for (std::size_t k = 0; k < wider_lo.size(); ++k) {
      wider_lo[k] = std::min(lo[k], lo[k + width]);
      wider_hi[k] = std::max(hi[k], hi[k + width]);
    }
    least_.push_back(std::move(wider_lo));
    most_.push_back(std::move(wider_hi));
  }
}

/// Constant time: the least of two runs of the table, the largest of two others. An open boundary's arc is cut to it.
Interval TurningRange::over(double lo, double hi) const {
  double lift = 0;
  if (boundary_.closed) {
    if (hi - lo >= boundary_.perimeter) return kAnyAngle;
    // Moved to the first lap, where the table starts; the laps' turn is added to the result.
    const Wrapped start = boundary_.reduced(lo);
    lift = start.winding * period_turn_;
    hi = start.base + (hi - lo);
    lo = start.base;
  }
  const auto last = static_cast<double>(least_.front().size() - 1);
  const auto first = static_cast<std::size_t>(std::clamp(std::floor(lo / step_), 0.0, last));
  const auto end = static_cast<std::size_t>(std::clamp(std::floor(hi / step_), 0.0, last)) + 1;
  // The longest run that fits into the arc's cells; one from its first cell and one up to its last cover it.
  std::size_t j = 0;
  while ((std::size_t{2} << j) <= end - first) ++j;
  const std::size_t second = end - (std::size_t{1} << j);
  return {std::min(least_[j][first], least_[j][second]) + lift, std::max(most_[j][first], most_[j][second]) + lift};
}

namespace {

// A block's few sums are rounded to this share of its angles.
constexpr double kAngleRounding = 2e-15;

using Block = TurningTree::Block;

/// Curvature is monotone on a spiral: Theta is on one side of its chord, by a quarter of the change at the most.
Block block_of(const TurningFunction& turning, std::size_t k) {
  const std::vector<Spiral>& spirals = turning.spirals();
  const Spiral& spiral = spirals[k];
  const double width = spiral.hi - spiral.lo;
  const double change = spiral.end.curvature - spiral.start.curvature;
  // The largest of |Theta - chord| where kappa is monotone: kappa less its mean changes sign once, and its integral up
  // to there is at most a quarter of the change times the width. Rising kappa: Theta is convex, below its chord.
  const double sag = 0.25 * std::abs(change) * width;
  // Bounds are outwards by what the sums here are rounded to.
  const double rounding = kAngleRounding * std::max(std::abs(spiral.start.angle), std::abs(spiral.end.angle));
  Block block;
  block.lo = spiral.lo;
  block.angle = spiral.start.angle;
  block.slope = spiral.turn() / width;
  block.below = -rounding - (change > 0 ? sag : 0);
  block.above = rounding + (change < 0 ? sag : 0);
  block.steepest = std::max(std::abs(spiral.start.curvature), std::abs(spiral.end.curvature));
  // The jump at the end: to the next spiral, or across the seam of a closed boundary. At the end of an open one there
  // is none.
  if (k + 1 < spirals.size()) {
    block.jump = spirals[k + 1].start.angle - spiral.end.angle;
  } else if (turning.closed()) {
    block.jump = spirals.front().start.angle + turning.period_turn() - spiral.end.angle;
  }
  return block;
}

/// One block of two neighbours; `end`: where the second ends. Its chord goes from the first one's start to the second
/// one's end. The two chords leave it most at the joint in between, as all three are straight and meet it at the outer
/// ends; there the first is off by before - chord, and the second, behind the jump, by other.angle - chord.
Block joined(const Block& one, const Block& other, double end) {
  const double before = one.chord(other.lo);
  const double last = other.chord(end);
  Block both;
  both.lo = one.lo;
  both.angle = one.angle;
  both.slope = (last - one.angle) / (end - one.lo);
  const double chord = both.chord(other.lo);
  const double rounding = kAngleRounding * std::max(std::abs(one.angle), std::abs(last));
  // At the outer end the distance between the chords is 0, hence the 0; then what each block is off its own chord.
  both.below = std::min(std::min(0.0, before - chord) + one.below, std::min(0.0, other.angle - chord) + other.below);
  both.above = std::max(std::max(0.0, before - chord) + one.above, std::max(0.0, other.angle - chord) + other.above);
  both.below -= rounding;
  both.above += rounding;
  both.jump = other.jump;
  both.steepest = std::max({one.steepest, other.steepest, std::abs(both.slope)});
  return both;
}

}  // namespace

/// Level 1 from the spirals in pairs, each further one from the level below it; an odd block at the end is taken over
/// as it is.
TurningTree::TurningTree(const TurningFunction& turning) {
  std::size_t count = turning.spirals().size();
  if (count < kFewest) return;
  blocks_.reserve(count + 64);  // half of them, a quarter, ..., each rounded up
  add_level(count, turning.perimeter(), [&](std::size_t k) { return block_of(turning, k); });
  while ((count = (count + 1) / 2) > 1) {
    const std::size_t first = first_.back();
    add_level(count, turning.perimeter(), [&](std::size_t k) { return blocks_[first + k]; });
  }
}

/// Appends a level: joins neighbours among the `count` blocks below, which below(k) gives. A block's end is the next
/// one's start; the last one ends at P.
template <class Below>
void TurningTree::add_level(std::size_t count, double perimeter, const Below& below) {
  first_.push_back(blocks_.size());
  Block one = below(0);
  for (std::size_t k = 0; k < count; k += 2) {
    const Block next = k + 2 < count ? below(k + 2) : Block{perimeter};
    blocks_.push_back(k + 1 < count ? joined(one, below(k + 1), next.lo) : one);
    one = next;
  }
}

}  // namespace rollfix
