#pragma once

#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix {

/// Bounds least <= value <= most, with the arithmetic of intervals. Results are not rounded outwards: they hold up to
/// rounding. least > most: no value, as `common` of ranges that do not meet.
struct Range {
  double least = 0;
  double most = 0;

  double spread() const { return most - least; }  // how much the value can vary
  double middle() const { return 0.5 * (least + most); }
  double size() const { return std::max(std::abs(least), std::abs(most)); }           // the largest absolute value
  bool comes_within(double limit) const { return least <= limit && most >= -limit; }  // of 0
  bool has_sign() const { return least > 0 || most < 0; }                             // surely not 0
  bool keeps_sign() const { return least >= 0 || most <= 0; }                         // 0 allowed
};

/// Sum and difference of two values that know nothing of each other: shared terms do not cancel here. See
/// PlaneCurve::Combination.
inline Range operator+(const Range& one, const Range& two) { return {one.least + two.least, one.most + two.most}; }
inline Range operator-(const Range& one, const Range& two) { return {one.least - two.most, one.most - two.least}; }

/// The extremes of a product are at corners of the box of both factors.
inline Range operator*(const Range& one, const Range& two) {
  const double a = one.least * two.least;
  const double b = one.least * two.most;
  const double c = one.most * two.least;
  const double d = one.most * two.most;
  return {std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d))};
}

inline Range operator*(double factor, const Range& range) {
  return factor >= 0 ? Range{factor * range.least, factor * range.most}
                     : Range{factor * range.most, factor * range.least};
}

/// REQUIRES that the divisor has a sign: has_sign().
inline Range operator/(const Range& one, const Range& two) { return one * Range{1 / two.most, 1 / two.least}; }

/// The bounds that follow from both, which are on the same value: they meet, but for rounding.
inline Range common(const Range& one, const Range& two) {
  return {std::max(one.least, two.least), std::min(one.most, two.most)};
}

/// The least range that holds both.
inline Range hull(double one, double two) { return {std::min(one, two), std::max(one, two)}; }

inline Range hull(const Range& one, const Range& two) {
  return {std::min(one.least, two.least), std::max(one.most, two.most)};
}

/// Bounds on a function over a width, from its values at the ends and bounds on its slope. With a slope of one sign it
/// is monotone. Else the lines of least and of largest slope through the two ends meet at the bounds.
inline Range value_range(double at_lo, double at_hi, const Range& slope, double width) {
  if (slope.keeps_sign()) return hull(at_lo, at_hi);
  const double scale = slope.least * slope.most * width;
  const double share = 1 / slope.spread();
  return {(slope.most * at_lo - slope.least * at_hi + scale) * share,
          (slope.most * at_hi - slope.least * at_lo - scale) * share};
}

/// The corners of a convex polygon in order; none: empty. A box that a few lines cut needs no allocation.
using Polygon = boost::container::small_vector<Vec2, 8>;

/// What is left of a convex polygon where `excess`, a linear function of a point, is not above 0.
template <class Excess>
Polygon clipped(const Polygon& polygon, const Excess& excess) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2& here = polygon[k];
    const Vec2& next = polygon[(k + 1) % polygon.size()];
    const double from = excess(here);
    const double to = excess(next);
    // A corner stays where it is on the right side; an edge that changes sides leaves the point where it crosses.
    if (from <= 0) kept.push_back(here);
    if ((from < 0 && to > 0) || (from > 0 && to < 0)) kept.push_back(here + (next - here) * (from / (from - to)));
  }
  return kept;
}

/// The part of a convex polygon in the box from `lo` to `hi`. What is cut off leaves its corners on the very edge.
inline Polygon clipped(const Polygon& polygon, const Vec2& lo, const Vec2& hi) {
  Polygon kept = polygon;
  for (const Eigen::Index axis : {0, 1}) {
    kept = clipped(kept, [&](const Vec2& x) { return lo[axis] - x[axis]; });
    kept = clipped(kept, [&](const Vec2& x) { return x[axis] - hi[axis]; });
  }
  for (Vec2& corner : kept) corner = corner.cwiseMax(lo).cwiseMin(hi);
  return kept;
}

/// The part of a convex polygon where a function that is straight, with this value and slope at `at`, is at most `most`
/// in size.
inline Polygon within(const Polygon& polygon, const Vec2& at, double value, const Vec2& slope, double most) {
  const auto f = [&](const Vec2& x) { return value + slope.dot(x - at); };
  const Polygon below = clipped(polygon, [&](const Vec2& x) { return f(x) - most; });
  return clipped(below, [&](const Vec2& x) { return -f(x) - most; });
}

}  // namespace rollfix

namespace rollfix::locating {

/// A place on such a curve: of each component its value and its slope by x, and the rates by x of the terms that
/// components are sums of. By their sizes what is 0 but for rounding is known.
class CurvePoint {
 public:
  CurvePoint() = default;
  /// At x; the numbers are still to be filled in.
  CurvePoint(double at, std::size_t rows, std::size_t rates) : x(at), rows_(rows) {
    numbers_.resize(2 * rows + rates, boost::container::default_init);
  }

  double x = 0;  // coordinate on the piece: s, or the angle of a pivot

  /// Of component `row`: its value and its slope by x.
  double value(std::size_t row) const { return numbers_[row]; }
  double slope(std::size_t row) const { return numbers_[rows_ + row]; }
  std::span<const double> rates() const { return {numbers_.data() + 2 * rows_, numbers_.size() - 2 * rows_}; }

  /// To be filled in.
  std::span<double> values() { return {numbers_.data(), rows_}; }
  std::span<double> slopes() { return {numbers_.data() + rows_, rows_}; }
  std::span<double> rates() { return {numbers_.data() + 2 * rows_, numbers_.size() - 2 * rows_}; }

  /// A step along the tangents.
  void step(double by) {
    x += by;
    for (std::size_t row = 0; row < rows_; ++row) numbers_[row] += by * slope(row);
  }

 private:
  // Of two readings and the facing equation: three of each.
  static constexpr std::size_t kUsualNumbers = 9;

  std::size_t rows_ = 0;
  boost::container::small_vector<double, kUsualNumbers> numbers_;
};

/// One side of equations that are each a function of s less a function of t: a curve with a component for each
/// equation, cut into pieces with a coordinate x each, and a tree of intervals over it with bounds on every component.
/// x is s, or at a corner an angle, s being a constant. Two of them are what PairBoxSearch looks for common points of.
///
/// Who derives from it makes the tree (`make_on_piece`, `make_bounded`, `join`, `set_root`) and says how a node is
/// halved, what the components are at x, and what bounds slopes have between two places. REQUIRES pieces in order of s;
/// components of about the size of angles in radians, for one tolerance and kTurnAccuracy are of all of them; and where
/// two such curves run along each other, that what vanishes at 20 places of a piece vanishes in between.
class PlaneCurve {
 public:
  static constexpr std::uint32_t kManyPieces = UINT32_MAX;

  /// An interval of the tree: of x on one piece, or of s over many.
  struct Node {
    double lo = 0;  // of x, on one piece; else of s
    double hi = 0;
    std::uint32_t piece = kManyPieces;  // which piece, or kManyPieces
    std::int32_t left = -1;             // children; none yet
    std::int32_t right = -1;
    std::int32_t parent = -1;  // -1: of the root, or not joined yet
    std::uint32_t first = 0;   // both for who derives
    std::uint32_t last = 0;
    std::array<Range, 2> diagonals;  // of the first two components the sum and the difference

    bool on_one_piece() const { return piece != kManyPieces; }
    double width() const { return hi - lo; }
  };

  /// What is known of one component on a node, which is +-g(x) + h(x) with a term g that all have, of monotone slope.
  /// On a node with many pieces its value alone.
  struct Component {
    Range value;
    Range slope;
    double first = 0;  // its values at the ends
    double last = 0;
    double first_slope = 0;  // and its slopes
    double last_slope = 0;
    double shared = 0;  // half of what the slope of +-g changes by
    Range own;          // half of what the slope of h changes by, at least and at most; of a monotone one hull(0, half)
  };

  /// So many times one component and so many times another one.
  struct Combination {
    double by_one;
    double by_two;
    const Component& one;
    const Component& two;

    double first() const { return by_one * one.first + by_two * two.first; }
    double last() const { return by_one * one.last + by_two * two.last; }
    /// How far its slope gets from the middle of its bounds, at most. The shared term is added up before its size is
    /// taken, so that it cancels where by_one and by_two make it cancel.
    double slope_radius() const {
      return std::abs(shared()) + std::abs(by_one) * one.own.size() + std::abs(by_two) * two.own.size();
    }
    /// Bounds on its value over a node of this width. A term whose slope is monotone is on one side of its chord, by a
    /// quarter of the slope's change times the width at most; `shared` and `own` hold half that change.
    Range value(double width) const {
      const double half = 0.5 * width;
      const Range bend = hull(0, shared()) + by_one * one.own + by_two * two.own;
      const Range ends = hull(first(), last());
      return {ends.least - half * bend.most, ends.most - half * bend.least};
    }

   private:
    /// Half of what the shared term's slope changes by in the combination.
    double shared() const { return by_one * one.shared + by_two * two.shared; }
  };

  PlaneCurve(const PlaneCurve&) = delete;
  PlaneCurve& operator=(const PlaneCurve&) = delete;
  virtual ~PlaneCurve() = default;

  std::size_t rows() const { return rows_; }
  std::int32_t root() const { return root_; }  // -1: no pieces
  const Node& node(std::int32_t index) const { return nodes_[static_cast<std::size_t>(index)]; }
  /// One for each row; good until a node is halved.
  const Component* components(std::int32_t node) const { return &components_[static_cast<std::size_t>(node) * rows_]; }

  /// The two halves of a node; of one with many pieces its two sides. -1 for the other of an only one. Intervals are
  /// halved when somebody asks for it, once for all the boxes that they are a side of.
  std::pair<std::int32_t, std::int32_t> halves(std::int32_t index) {
    if (node(index).left < 0) divide(index);
    return {node(index).left, node(index).right};
  }

  /// s of a node at a corner, where x is an angle; else x is s.
  virtual std::optional<double> pivot_at(const Node& node) const = 0;

  /// At x on a node of one piece, and beyond its ends along its tangents there: the slopes keep the
  /// bounds that they have inside.
  virtual CurvePoint point(const Node& node, double x) const = 0;

  /// One component's value and its slope by x.
  struct Place {
    double value = 0;
    double slope = 0;
  };
  /// One component alone at x on a node of one piece: cheaper than `point`.
  virtual Place place(const Node& node, double x, std::size_t row) const = 0;

  /// Bounds on a component's slope by x between two points of one piece.
  virtual Range slope_between(const Node& node, const CurvePoint& one, const CurvePoint& two,
                              std::size_t row) const = 0;

 protected:
  explicit PlaneCurve(std::size_t rows) : rows_(rows) {}

  /// How many nodes there are so far; the next one made has this index.
  std::size_t count() const { return nodes_.size(); }
  void reserve(std::size_t nodes) {
    nodes_.reserve(nodes);
    components_.reserve(nodes * rows_);
  }
  /// The node over all of the curve; without one the curve has no pieces.
  void set_root(std::int32_t node) { root_ = node; }
  /// A node of one piece, with `component_of(row)`.
  template <class ComponentOf>
  std::int32_t make_on_piece(Node node, const ComponentOf& component_of) {
    const std::size_t before = components_.size();
    for (std::size_t row = 0; row < rows_; ++row) components_.push_back(component_of(row));
    if (rows_ > 1) bound_diagonals(node, components_[before], components_[before + 1]);
    nodes_.push_back(node);
    return static_cast<std::int32_t>(nodes_.size() - 1);
  }
  /// A node of which only bounds on its components' values are known, one range for each row. Returns its index.
  std::int32_t make_bounded(Node node, const Range* values);
  /// A balanced tree over the nodes from .. to - 1, which are neighbours in order of s. Returns the index of its root.
  /// The new bounds are the hulls of the halves'.
  std::int32_t join(std::int32_t from, std::int32_t to);
  /// Gives a node its halves, and tightens its bounds and its ancestors' by theirs.
  void adopt(std::int32_t index, std::int32_t left, std::int32_t right);

 private:
  /// Gives a node that has none its halves.
  virtual void divide(std::int32_t index) = 0;

  /// Bounds on A_0 + A_1 and A_0 - A_1: sharper than from both values alone, for shared terms cancel.
  static void bound_diagonals(Node& node, const Component& one, const Component& two);
  double end_of(const Node& node, double x) const;
  bool tighten(std::int32_t index);

  std::size_t rows_;
  // Grow only: an index stays good, references do not.
  std::vector<Node> nodes_;
  // rows_ of each node.
  std::vector<Component> components_;
  std::int32_t root_ = -1;
};

}  // namespace rollfix::locating
