#include "plane_curve.hpp"

#include <cstddef>

// Notation:
//   A_p(x)          component p: `rows` of them
//   node            an interval of x with bounds on every A_p, and on A_0 + A_1 and A_0 - A_1: `diagonals`
// Follows docs/search.md, "Two fingers", step 2.
// Idea: a binary tree that grows where boxes ask for halves. What both halves know of a component, the node and those
// above it know from then on.
namespace rollfix::locating {

void PlaneCurve::bound_diagonals(Node& node, const Component& one, const Component& two) {
  node.diagonals = {common(Combination{1, 1, one, two}.value(node.width()), one.value + two.value),
                    common(Combination{1, -1, one, two}.value(node.width()), one.value - two.value)};
}

std::int32_t PlaneCurve::make_bounded(Node node, const Range* values) {
  for (std::size_t row = 0; row < rows_; ++row) components_.emplace_back().value = values[row];
  if (rows_ > 1) node.diagonals = {values[0] + values[1], values[0] - values[1]};
  nodes_.push_back(node);
  return static_cast<std::int32_t>(nodes_.size() - 1);
}

/// An end of a node, x, as a place s on the boundary: at a pivot the corner's.
double PlaneCurve::end_of(const Node& node, double x) const {
  return node.on_one_piece() ? pivot_at(node).value_or(x) : x;
}

std::int32_t PlaneCurve::join(std::int32_t from, std::int32_t to) {
  // Two halves of about equal count, so that the tree's depth is the logarithm of the number of pieces.
  if (to - from == 1) return from;
  const std::int32_t middle = from + (to - from) / 2;
  Node node;
  node.left = join(from, middle);
  node.right = join(middle, to);
  const Node& first = this->node(node.left);  // good until the next one is made
  const Node& last = this->node(node.right);
  node.lo = end_of(first, first.lo);
  node.hi = end_of(last, last.hi);
  for (std::size_t row = 0; row < rows_; ++row) {
    Component component;
    component.value = hull(components(node.left)[row].value, components(node.right)[row].value);
    components_.push_back(component);
  }
  for (const std::size_t k : {0U, 1U}) node.diagonals[k] = hull(first.diagonals[k], last.diagonals[k]);
  nodes_.push_back(node);
  const auto index = static_cast<std::int32_t>(nodes_.size() - 1);
  for (const std::int32_t half : {node.left, node.right}) nodes_[static_cast<std::size_t>(half)].parent = index;
  return index;
}

void PlaneCurve::adopt(std::int32_t index, std::int32_t left, std::int32_t right) {
  nodes_[static_cast<std::size_t>(index)].left = left;
  nodes_[static_cast<std::size_t>(index)].right = right;
  for (const std::int32_t half : {left, right}) {
    if (half >= 0) nodes_[static_cast<std::size_t>(half)].parent = index;
  }
  // Upwards as long as the new halves tell something new.
  while (index >= 0 && tighten(index)) index = node(index).parent;
}

/// Bounds on both halves are bounds on the whole. False: they tell no more than the node knew already, or it has one
/// child only.
bool PlaneCurve::tighten(std::int32_t index) {
  Node& node = nodes_[static_cast<std::size_t>(index)];
  if (node.left < 0 || node.right < 0) return false;
  const Node& left = this->node(node.left);
  const Node& right = this->node(node.right);
  bool tighter = false;
  const auto take = [&](Range& whole, const Range& one, const Range& other) {
    const Range both = hull(one, other);
    if (!(both.least > whole.least || both.most < whole.most)) return;
    whole = common(whole, both);
    tighter = true;
  };
  Component* of = &components_[static_cast<std::size_t>(index) * rows_];
  for (std::size_t row = 0; row < rows_; ++row) {
    take(of[row].value, components(node.left)[row].value, components(node.right)[row].value);
  }
  for (const std::size_t k : {0U, 1U}) take(node.diagonals[k], left.diagonals[k], right.diagonals[k]);
  return tighter;
}

}  // namespace rollfix::locating
