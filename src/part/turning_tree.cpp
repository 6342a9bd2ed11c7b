#include "turning_tree.hpp"

#include <algorithm>
#include <cmath>

// Notation:
//   block           a run of 2^level neighbouring spirals: TurningTree::Block
//   chord           angle + slope (s - lo), straight from Theta just after the block's start to Theta just before its
//                   end
//   below, above    how far Theta gets from the chord; `jump` is of Theta at the joint where the block ends
//   sag             |change of kappa| times width / 4: how far Theta gets from its chord on one spiral, to one side
// Follows docs/search.md, "Once per part". The strips are those of D. H. Ballard, "Strip trees: a hierarchical
// representation for curves" (1981).
// Idea: two neighbours' chords leave the chord of both most at the joint in between, so that a level is made of the one
// below it in linear time, and two blocks bound Theta(s + L) - Theta(s) without a look at what is in them.
namespace rollfix {
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
  const double sag = 0.25 * std::abs(change) * width;
  const double rounding = kAngleRounding * std::max(std::abs(spiral.start.angle), std::abs(spiral.end.angle));
  Block block;
  block.lo = spiral.lo;
  block.angle = spiral.start.angle;
  block.slope = spiral.turn() / width;
  block.below = -rounding - (change > 0 ? sag : 0);
  block.above = rounding + (change < 0 ? sag : 0);
  block.steepest = std::max(std::abs(spiral.start.curvature), std::abs(spiral.end.curvature));
  if (k + 1 < spirals.size()) {
    block.jump = spirals[k + 1].start.angle - spiral.end.angle;
  } else if (turning.closed()) {
    block.jump = spirals.front().start.angle + turning.period_turn() - spiral.end.angle;
  }
  return block;
}

/// Two neighbours' chords leave that of both most at the joint in between.
Block joined(const Block& one, const Block& other, double end) {
  const double before = one.chord(other.lo);
  const double last = other.chord(end);
  Block both;
  both.lo = one.lo;
  both.angle = one.angle;
  both.slope = (last - one.angle) / (end - one.lo);
  const double chord = both.chord(other.lo);
  const double rounding = kAngleRounding * std::max(std::abs(one.angle), std::abs(last));
  both.below = std::min(std::min(0.0, before - chord) + one.below, std::min(0.0, other.angle - chord) + other.below);
  both.above = std::max(std::max(0.0, before - chord) + one.above, std::max(0.0, other.angle - chord) + other.above);
  both.below -= rounding;
  both.above += rounding;
  both.jump = other.jump;
  both.steepest = std::max({one.steepest, other.steepest, std::abs(both.slope)});
  return both;
}

}  // namespace

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

/// Joins neighbours among so many blocks below.
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
