#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "pair_find.hpp"
#include "roll_curve.hpp"

namespace rollfix {

/// Where a residual varies by this share of the tolerance, all is in or out as its middle is.
inline constexpr double kSmallVariation = 0.25;

/// The cubic on [0, 1] with these values and slopes at the ends (Hermite).
class Cubic {
 public:
  Cubic(double first, double last, double slope_first, double slope_last)
      : first_(first),
        slope_(slope_first),
        square_(3 * (last - first) - 2 * slope_first - slope_last),
        cube_(slope_first + slope_last - 2 * (last - first)) {}

  double value(double x) const { return first_ + x * (slope_ + x * (square_ + x * cube_)); }
  double slope(double x) const { return slope_ + x * (2 * square_ + x * (3 * cube_)); }

 private:
  double first_;
  double slope_;
  double square_;
  double cube_;
};

/// A stretch of one finger's curve on one piece: a side of a box.
class BoxSide {
 public:
  BoxSide(const RollCurve& curve, std::int32_t node)
      : curve_(&curve),
        components_(curve.components(node)),
        node_(node),
        lo_(curve.node(node).lo),
        hi_(curve.node(node).hi) {}

  const RollPiece& piece() const { return curve_->piece(curve_->node(node_)); }
  RollPoint first() const { return curve_->first(curve_->node(node_)); }
  RollPoint last() const { return curve_->last(curve_->node(node_)); }
  const RollCurve::Component& component(std::size_t row) const { return components_[row]; }
  /// Through its values and slopes at the ends: nearly the component itself.
  Cubic cubic(std::size_t row) const {
    const auto [first, last] = curve_->end_slopes(curve_->node(node_), row);
    return {component(row).first, component(row).last, width() * first, width() * last};
  }
  double lo() const { return lo_; }
  double hi() const { return hi_; }
  double width() const { return hi_ - lo_; }
  double middle() const { return 0.5 * (lo_ + hi_); }
  bool pivots() const { return piece().pivot_at.has_value(); }
  double s(double x) const { return piece().s(x); }
  std::size_t rows() const { return curve_->rows(); }
  const Range& value(std::size_t row) const { return components_[row].value; }
  const Range& slope(std::size_t row) const { return components_[row].slope; }
  /// Lines, arcs and pivots: no rate changes.
  bool is_straight() const {
    return std::all_of(components_, components_ + rows(),
                       [](const RollCurve::Component& of) { return of.slope.spread() == 0; });
  }
  Range slope_between(const RollPoint& one, const RollPoint& two, std::size_t row) const {
    return curve_->slope_between(piece(), one, two, row);
  }
  /// The curve, continued beyond this side's ends by its tangents there: slopes keep this side's bounds.
  RollPoint point(double x) const {
    RollPoint point;
    move(point, x);
    return point;
  }
  RollCurve::Place place(double x, std::size_t row) const { return curve_->place(curve_->node(node_), x, row); }
  void move(RollPoint& point, double x) const { curve_->move(point, curve_->node(node_), x); }
  /// Places closer together than this are one: a share of the perimeter, or of a radian where the finger pivots.
  double same_place(const PairLimits& limits) const { return pivots() ? kLengthAccuracy : limits.same_place; }

 private:
  const RollCurve* curve_;
  const RollCurve::Component* components_;  // good until a node is halved
  std::int32_t node_;
  double lo_;
  double hi_;
};

/// Two sides and the equations f = A(s) - B(t) - shift = 0 between them.
struct PairBoxSides {
  BoxSide a;
  BoxSide b;
  double lap = 0;  // the multiple of 2 pi that the facing row means here

  double shift(std::size_t row, const PairLimits& limits) const {
    return limits.facing && row + 1 == a.rows() ? lap : 0;
  }
  Range value(std::size_t row, const PairLimits& limits) const {
    const double by = shift(row, limits);
    return a.value(row) - b.value(row) - Range{by, by};
  }
  bool pivots() const { return a.pivots() || b.pivots(); }
};

}  // namespace rollfix
