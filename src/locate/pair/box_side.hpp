#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "pair_find.hpp"
#include "plane_curve.hpp"
#include "range.hpp"

namespace rollfix::locating {

/// Where a residual varies by this share of the tolerance, all is in or out as its middle is.
inline constexpr double kSmallVariation = 0.25;

/// The cubic on [0, 1] with these values and slopes at the ends (Hermite). Slopes are by x in [0, 1]: those of a side,
/// times its width.
class ResidualCubic {
 public:
  ResidualCubic(double first, double last, double slope_first, double slope_last)
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

/// A stretch of a curve on one piece: a side of a box.
class BoxSide {
 public:
  /// REQUIRES a node of one piece. The curve must not be halved while the side is used.
  BoxSide(const PlaneCurve& curve, std::int32_t node)
      : curve_(&curve),
        components_(curve.components(node)),
        node_(node),
        lo_(curve.node(node).lo),
        hi_(curve.node(node).hi),
        pivot_at_(curve.pivot_at(curve.node(node))) {}

  /// What is known of component `row` on this side.
  const PlaneCurve::Component& component(std::size_t row) const { return components_[row]; }
  /// Through its values and slopes at the ends: nearly the component itself.
  ResidualCubic cubic(std::size_t row) const {
    const PlaneCurve::Component& of = component(row);
    return {of.first, of.last, width() * of.first_slope, width() * of.last_slope};
  }
  /// The ends of x: s, or an angle where the finger pivots.
  double lo() const { return lo_; }
  double hi() const { return hi_; }
  double width() const { return hi_ - lo_; }
  double middle() const { return 0.5 * (lo_ + hi_); }
  /// The finger stands at a convex corner on this side, and x is the angle that it has pivoted by.
  bool pivots() const { return pivot_at_.has_value(); }
  /// The place on the boundary.
  double s(double x) const { return pivot_at_ ? *pivot_at_ : x; }
  std::size_t rows() const { return curve_->rows(); }
  /// Bounds on a component and on its slope by x.
  const Range& value(std::size_t row) const { return components_[row].value; }
  const Range& slope(std::size_t row) const { return components_[row].slope; }
  /// Slopes are constant, as of rolls on lines, on arcs and at pivots.
  bool is_straight() const {
    return std::all_of(components_, components_ + rows(),
                       [](const PlaneCurve::Component& of) { return of.slope.spread() == 0; });
  }
  /// Bounds on a component's slope between two places of the side.
  Range slope_between(const CurvePoint& one, const CurvePoint& two, std::size_t row) const {
    return curve_->slope_between(curve_->node(node_), one, two, row);
  }
  /// The curve, continued beyond this side's ends by its tangents there: slopes keep this side's bounds.
  CurvePoint point(double x) const { return curve_->point(curve_->node(node_), x); }
  /// One component alone at x.
  PlaneCurve::Place place(double x, std::size_t row) const { return curve_->place(curve_->node(node_), x, row); }
  /// Places closer together than this are one: a share of the perimeter, or of a radian where the finger pivots.
  double same_place(const PairLimits& limits) const { return pivots() ? kLengthAccuracy : limits.same_place; }

 private:
  const PlaneCurve* curve_;
  const PlaneCurve::Component* components_;  // good until a node is halved
  std::int32_t node_;
  double lo_;
  double hi_;
  std::optional<double> pivot_at_;
};

/// Two sides and the equations f = A(s) - B(t) - shift = 0 between them.
struct PairBoxSides {
  BoxSide a;
  BoxSide b;
  double lap = 0;  // the multiple of 2 pi that the facing row means here

  /// What a row's f takes off: whole turns in the facing row, else 0.
  double shift(std::size_t row, const PairLimits& limits) const {
    return limits.facing && row + 1 == a.rows() ? lap : 0;
  }
  /// Bounds on f of a row all over the box.
  Range value(std::size_t row, const PairLimits& limits) const {
    const double by = shift(row, limits);
    return a.value(row) - b.value(row) - Range{by, by};
  }
  bool pivots() const { return a.pivots() || b.pivots(); }
};

}  // namespace rollfix::locating
