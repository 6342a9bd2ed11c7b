#include "boundary_tree.hpp"

#include <algorithm>
#include <cmath>

// Notation:
//   s               arc length: a node holds [`lo`, `hi`]
//   chord           from `start` to `end`; of a node over many stretches a point, the middle of their box
//   deviation       no point of the boundary is further from the chord
//   Theta           tangent's angle at both ends of a single stretch: `at_lo`, `at_hi`
// Follows docs/reach.md, "How it is decided".
// Idea: a stretch that turns by little in one direction lies no further from its chord than the isosceles triangle with
// the same turn. Long runs are bounded by boxes, short stretches are halved when somebody asks for it.
namespace rollfix {
namespace {

// A stretch turns by no more than this, radians, so that it is close to its chord.
constexpr double kLeafTurn = 0.4;
// Positions are rounded: this share of the perimeter.
constexpr double kPlaceRounding = 2e-15;
// A stretch shorter than this share of the perimeter has no halves.
constexpr double kShortest = 1e-13;

}  // namespace

BoundaryTree::BoundaryTree(const Part& part) : part_(part) {
  const TurningFunction& turning = part.turning();
  const std::vector<Spiral>& spirals = turning.spirals();
  // Just before a joint the point is still on the spiral that ends there, which may be a rounded digit away.
  const double before_end = 1e-14 * part.perimeter();
  std::vector<Vec2> ends;
  for (std::size_t k = 0; k < spirals.size(); ++k) {
    const Spiral& spiral = spirals[k];
    const int count = 1 + static_cast<int>(std::abs(spiral.turn()) / kLeafTurn);
    Vec2 from = part.point(spiral.lo);
    Turning at_from = spiral.start;
    gaps_.push_back(k == 0 ? 0 : (from - ends.back()).norm());
    for (int i = 1; i <= count; ++i) {
      const double lo = i == 1 ? spiral.lo : spiral.lo + (spiral.hi - spiral.lo) * (i - 1) / count;
      const double hi = i == count ? spiral.hi : spiral.lo + (spiral.hi - spiral.lo) * i / count;
      const Vec2 to = part.point(i == count ? std::max(spiral.hi - before_end, lo) : hi);
      const Turning at_to = i == count ? spiral.end : turning.on_spiral(spiral, hi);
      leaves_.push_back(add_single(static_cast<std::int32_t>(k), lo, hi, from, to, at_from, at_to));
      from = to;
      at_from = at_to;
    }
    ends.push_back(from);
  }
  if (part.closed()) gaps_.front() = (part.point(0) - ends.back()).norm();
  Vec2 least, most;
  root_ = join(0, leaves_.size(), least, most);
  diagonal_ = (most - least).norm();
}

/// An arc lies no further from its chord than the isosceles triangle with the same turn.
std::int32_t BoundaryTree::add_single(std::int32_t spiral, double lo, double hi, const Vec2& start, const Vec2& end,
                                      const Turning& at_lo, const Turning& at_hi) {
  Node node;
  node.lo = lo;
  node.hi = hi;
  node.start = start;
  node.end = end;
  const double turn = std::abs(at_hi.angle - at_lo.angle);
  node.deviation = 0.5 * (end - start).norm() * std::tan(0.5 * turn) * (1 + 1e-9) + kPlaceRounding * part_.perimeter();
  node.at_lo = at_lo;
  node.at_hi = at_hi;
  node.spiral = spiral;
  node.on_curve = start;
  node.on_curve_s = lo;
  nodes_.push_back(node);
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

std::int32_t BoundaryTree::join(std::size_t from, std::size_t to, Vec2& least, Vec2& most) {
  if (to - from == 1) {
    const Node& leaf = node(leaves_[from]);
    const Vec2 margin = Vec2::Constant(leaf.deviation);
    least = leaf.start.cwiseMin(leaf.end) - margin;
    most = leaf.start.cwiseMax(leaf.end) + margin;
    return leaves_[from];
  }
  const std::size_t middle = from + (to - from) / 2;
  Node joined;
  Vec2 other_least, other_most;
  joined.left = join(from, middle, least, most);
  joined.right = join(middle, to, other_least, other_most);
  least = least.cwiseMin(other_least);
  most = most.cwiseMax(other_most);
  joined.lo = node(joined.left).lo;
  joined.hi = node(joined.right).hi;
  joined.start = joined.end = 0.5 * (least + most);
  joined.deviation = 0.5 * (most - least).norm();
  joined.on_curve = node(joined.right).on_curve;
  joined.on_curve_s = node(joined.right).on_curve_s;
  nodes_.push_back(joined);
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

std::pair<std::int32_t, std::int32_t> BoundaryTree::halves(std::int32_t index) {
  const Node whole = node(index);
  if (whole.left >= 0) return {whole.left, whole.right};
  const double middle = 0.5 * (whole.lo + whole.hi);
  if (whole.length() <= kShortest * part_.perimeter() || !(middle > whole.lo && middle < whole.hi)) {
    return {index, index};
  }
  const Vec2 point = part_.point(middle);
  const Turning at = part_.turning().on_spiral(spiral_of(whole), middle);
  const std::int32_t left = add_single(whole.spiral, whole.lo, middle, whole.start, point, whole.at_lo, at);
  const std::int32_t right = add_single(whole.spiral, middle, whole.hi, point, whole.end, at, whole.at_hi);
  nodes_[static_cast<std::size_t>(index)].left = left;
  nodes_[static_cast<std::size_t>(index)].right = right;
  return {left, right};
}

}  // namespace rollfix
