#include "path_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

// Notation:
//   u               place on a stretch of the path: arc length along a spiral, the tangent's angle at a corner
//   c(u)            the finger's centre there, p + r n: `path_.at`
//   (c, rho)        the disc that holds a node's centres: `middle`, `radius`
//   theta +- w      the tangents on it: `angle`, `half_turn`
//   number          a place's number, growing along the path, by which neighbours are known
// Follows docs/touch.md, "How it works".
// Idea: a stretch's disc is about its middle place, with the way to the further end as its radius; on a spiral Theta is
// monotone, so that its ends bound it. Two nodes have the smallest disc around both.
namespace rollfix::touch {
namespace {

// Positions are rounded: this share of the perimeter.
constexpr double kDiscRounding = 4e-15;

/// The smallest disc around two.
void enclose(const PathTree::Node& one, const PathTree::Node& other, PathTree::Node& both) {
  const Vec2 between = other.middle - one.middle;
  const double apart = between.norm();
  if (apart + other.radius <= one.radius || apart + one.radius <= other.radius) {
    const PathTree::Node& larger = one.radius > other.radius ? one : other;
    both.middle = larger.middle;
    both.radius = larger.radius;
    return;
  }
  both.radius = 0.5 * (apart + one.radius + other.radius) * (1 + 1e-14);
  both.middle = one.middle + between * ((both.radius - one.radius) / apart);
}

}  // namespace

PathTree::PathTree(const CentrePath& path) : path_(path) { root_ = join(0, path.stretches().size()); }

std::int32_t PathTree::add_single(std::int32_t stretch, const Interval& u, const Interval& number) {
  const CentreStretch& whole = path_.stretches()[static_cast<std::size_t>(stretch)];
  const auto angle_at = [&](double place) {
    return whole.corner ? place
                        : path_.part().turning().on_spiral(path_.part().turning().spirals()[whole.spiral], place).angle;
  };
  Node node;
  node.stretch = stretch;
  node.u = u;
  node.number = number;
  node.middle = path_.at({static_cast<std::size_t>(stretch), u.middle()}).centre;
  node.radius = std::max(path_.length(whole, {u.lo, u.middle()}), path_.length(whole, {u.middle(), u.hi})) +
                kDiscRounding * path_.part().perimeter();
  const double at_lo = angle_at(u.lo);  // Theta is monotone on a spiral
  const double at_hi = angle_at(u.hi);
  node.angle = 0.5 * (at_lo + at_hi);
  node.half_turn = 0.5 * std::abs(at_hi - at_lo) + kTurnAccuracy;
  node.along = {std::cos(node.angle), std::sin(node.angle)};
  node.flat = node.radius * std::sin(std::min(node.half_turn, 0.5 * std::numbers::pi)) +
              kDiscRounding * path_.part().perimeter();
  nodes_.push_back(node);
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

std::int32_t PathTree::join(std::size_t from, std::size_t to) {
  if (to - from == 1) {
    const CentreStretch& stretch = path_.stretches()[from];
    return add_single(static_cast<std::int32_t>(from), stretch.u, {stretch.number, stretch.number + 1});
  }
  const std::size_t middle = from + (to - from) / 2;
  Node joined;
  joined.left = join(from, middle);
  joined.right = join(middle, to);
  const Node& left = node(joined.left);
  const Node& right = node(joined.right);
  enclose(left, right, joined);
  const double lo = std::min(left.angle - left.half_turn, right.angle - right.half_turn);
  const double hi = std::max(left.angle + left.half_turn, right.angle + right.half_turn);
  joined.angle = 0.5 * (lo + hi);
  joined.half_turn = 0.5 * (hi - lo);
  joined.flat = joined.radius;
  joined.number = {left.number.lo, right.number.hi};
  nodes_.push_back(joined);
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

std::pair<std::int32_t, std::int32_t> PathTree::halves(std::int32_t index) {
  const Node whole = node(index);
  if (whole.left >= 0) return {whole.left, whole.right};
  const double middle = whole.u.middle();
  const double number = whole.number.middle();
  const bool is_point =
      !(middle > whole.u.lo && middle < whole.u.hi) || !(number > whole.number.lo && number < whole.number.hi);
  if (is_point) return {index, index};
  const std::int32_t left = add_single(whole.stretch, {whole.u.lo, middle}, {whole.number.lo, number});
  const std::int32_t right = add_single(whole.stretch, {middle, whole.u.hi}, {number, whole.number.hi});
  nodes_[static_cast<std::size_t>(index)].left = left;
  nodes_[static_cast<std::size_t>(index)].right = right;
  return {left, right};
}

}  // namespace rollfix::touch
