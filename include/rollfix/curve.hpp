#pragma once

// Points, and curves by formulas with their first three derivatives.
//
//     const Curve arc(Arc({0, 0}, 2.0, 0.0, 1.0));
//     curvature(arc.jet(0.3));  // 0.5
//
// Degenerate cases: a curve with a speed of 0 has no curvature there; a Part of it is refused.

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rollfix {

/// A point or a vector of the plane, in the outline's own unit.
using Vec2 = Eigen::Vector2d;

/// A 2 by 2 matrix that is laid out alike in every program: Eigen's own is aligned by the vector instructions that a
/// program is compiled for, and so would be all that holds it.
using Mat2 = Eigen::Matrix<double, 2, 2, Eigen::DontAlign>;

/// z component of the cross product: positive where b is to the left of a.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A closed interval of reals.
struct Interval {
  double lo = 0;
  double hi = 0;

  double width() const { return hi - lo; }
  double middle() const { return lo + 0.5 * (hi - lo); }
  bool contains(double value) const { return lo <= value && value <= hi; }
};

/// A curve's position and its exact derivatives by its own parameter, up to the third.
struct Jet {
  Vec2 position;
  Vec2 first;
  Vec2 second;
  Vec2 third;
};

/// Signed curvature (positive where the curve turns left) of a curve with these derivatives.
double curvature(const Jet& jet);

/// d(curvature)/d(parameter).
double curvature_rate(const Jet& jet);

/// What a curve was made of, so that a saved part can make it again to the bit: see curve_from.
struct CurveRecord {
  std::string kind;             // "line", "arc", ...
  std::vector<double> numbers;  // as its constructor took them
};

/// A smooth (analytic on its domain, ends included) regular curve: what a user's own type must offer
/// to become a part of an outline.
///   domain()    the parameter's interval, lo < hi
///   jet(u)      position and derivatives at u
/// A `velocity(u)` (the first derivative alone) is used where it exists, because arc length needs no more,
/// and a `record()` (a CurveRecord) so that a part made of it can be saved.
template <class C>
concept ParametricCurve = std::copy_constructible<C> && requires(const C& curve, double u) {
  { curve.domain() } -> std::convertible_to<Interval>;
  { curve.jet(u) } -> std::convertible_to<Jet>;
};

/// Any parametric curve, held by value: copies share the immutable original.
class Curve {
 public:
  // `same_as` first: whether a Curve can be copied must not be asked of this constructor.
  template <class C>
  requires(!std::same_as<C, Curve> && ParametricCurve<C>) Curve(C curve)
      : model_(std::make_shared<Model<C>>(std::move(curve))) {}  // NOLINT(google-explicit-constructor)

  Interval domain() const { return model_->domain(); }
  Jet jet(double u) const { return model_->jet(u); }
  Vec2 velocity(double u) const { return model_->velocity(u); }
  Vec2 position(double u) const { return model_->jet(u).position; }
  Vec2 front() const { return position(domain().lo); }
  Vec2 back() const { return position(domain().hi); }
  /// The size of the numbers that the parameters of this range are rounded as. The range's own, for a curve type that
  /// does not tell.
  double parameter_size(const Interval& range) const { return model_->parameter_size(range); }
  /// Nothing for a curve type that does not offer it.
  std::optional<CurveRecord> record() const { return model_->record(); }
  /// The same curve by the formula that certificates know it by, with the parameter that it has there where this one's
  /// is u: the record, for a curve type that has no other.
  std::optional<CurveRecord> formula() const { return model_->formula(); }
  double formula_parameter(double u) const { return model_->formula_parameter(u); }

 private:
  struct Interface {
    virtual ~Interface() = default;
    virtual Interval domain() const = 0;
    virtual Jet jet(double u) const = 0;
    virtual Vec2 velocity(double u) const = 0;
    virtual double parameter_size(const Interval& range) const = 0;
    virtual std::optional<CurveRecord> record() const = 0;
    virtual std::optional<CurveRecord> formula() const = 0;
    virtual double formula_parameter(double u) const = 0;
  };

  template <class C>
  struct Model final : Interface {
    explicit Model(C own) : curve(std::move(own)) {}
    Interval domain() const override { return curve.domain(); }
    Jet jet(double u) const override { return curve.jet(u); }
    Vec2 velocity(double u) const override {
      if constexpr (requires { curve.velocity(u); }) {
        return curve.velocity(u);
      } else {
        return curve.jet(u).first;
      }
    }
    double parameter_size(const Interval& range) const override {
      if constexpr (requires { curve.parameter_size(range); }) {
        return curve.parameter_size(range);
      } else {
        return std::max(std::abs(range.lo), std::abs(range.hi));
      }
    }
    std::optional<CurveRecord> record() const override {
      if constexpr (requires { curve.record(); }) {
        return curve.record();
      } else {
        return std::nullopt;
      }
    }
    std::optional<CurveRecord> formula() const override {
      if constexpr (requires { curve.formula(); }) {
        return curve.formula();
      } else {
        return record();
      }
    }
    double formula_parameter(double u) const override {
      if constexpr (requires { curve.formula_parameter(u); }) {
        return curve.formula_parameter(u);
      } else {
        return u;
      }
    }
    C curve;
  };

  std::shared_ptr<const Interface> model_;
};

/// The same points in the opposite direction; the parameter runs over the same interval.
Curve reversed(const Curve& curve);

/// The same curve with all lengths so many times as long, seen from the origin; factor above 0.
Curve scaled(const Curve& curve, double factor);

/// The curve that has this record, to the bit. Throws InputError: a kind that is not known, another number of numbers
/// than it takes, or numbers that its constructor refuses.
Curve curve_from(const CurveRecord& record);

/// A straight line, u in [0, 1]. Both ends are exact to the last bit.
class Line {
 public:
  /// Throws InputError when the two points are the same.
  Line(const Vec2& from, const Vec2& to);

  Interval domain() const { return {0, 1}; }
  Vec2 velocity(double) const { return chord_; }
  Jet jet(double u) const { return {(1 - u) * from_ + u * to_, chord_, Vec2::Zero(), Vec2::Zero()}; }
  CurveRecord record() const { return {"line", {from_.x(), from_.y(), to_.x(), to_.y()}}; }

 private:
  Vec2 from_;
  Vec2 to_;
  Vec2 chord_;
};

/// An arc of a circle, counter-clockwise for sweep > 0. The parameter is the angle turned so far, in [0, |sweep|].
/// A full circle closes to the last bit.
class Arc {
 public:
  /// `from` is the direction from the centre to the first point, radians; 0 < |sweep| <= 2 pi, 0 < radius.
  /// Throws InputError otherwise.
  Arc(const Vec2& centre, double radius, double from, double sweep);

  Interval domain() const { return {0, angle_}; }
  Vec2 velocity(double u) const;
  Jet jet(double u) const;
  CurveRecord record() const { return {"arc", {centre_.x(), centre_.y(), radius_, from_, sweep_}}; }

 private:
  Vec2 centre_;
  Vec2 start_;  // from the centre to the first point
  Vec2 side_;   // start_ turned by a right angle in the direction of travel
  double angle_;
  double radius_;  // as given
  double from_;
  double sweep_;
};

/// An arc of an ellipse: centre + cos(u) major + sin(u) minor, with u running from `from` by `sweep` (below 0:
/// backwards). The two half axes need not be perpendicular: any affine image of a circle's arc is one. The parameter is
/// the angle turned so far, in [0, |sweep|]. A full ellipse closes to the last bit.
class EllipticArc {
 public:
  /// 0 < |sweep| <= 2 pi, half axes that are not parallel. Throws InputError otherwise.
  EllipticArc(const Vec2& centre, const Vec2& major, const Vec2& minor, double from, double sweep);

  Interval domain() const { return {0, angle_}; }
  Vec2 velocity(double u) const;
  Jet jet(double u) const;
  CurveRecord record() const;

 private:
  Vec2 centre_;
  Vec2 start_;  // from the centre to the first point
  Vec2 side_;   // d(position)/du there
  double angle_;
  Vec2 major_;  // as given
  Vec2 minor_;
  double from_;
  double sweep_;
};

/// A cubic between two points, u in [0, 1]:
///   from + (to - from - square - cube) u + square u^2 + cube u^3.
/// Both ends are exact to the last bit. Not checked for cusps: a span of a spline or a Bezier curve may have one.
class CubicSpan {
 public:
  CubicSpan(const Vec2& from, const Vec2& to, const Vec2& square, const Vec2& cube)
      : from_(from), to_(to), square_(square), cube_(cube) {}

  /// The cubic with these second derivatives (by u) at its ends.
  static CubicSpan with_second_derivatives(const Vec2& from, const Vec2& to, const Vec2& second_from,
                                           const Vec2& second_to) {
    return {from, to, 0.5 * second_from, (second_to - second_from) / 6};
  }

  Interval domain() const { return {0, 1}; }
  Vec2 velocity(double u) const {
    const Vec2 slope = to_ - from_ - square_ - cube_;
    return slope + u * (2 * square_ + (3 * u) * cube_);
  }
  Jet jet(double u) const {
    const double rest = 1 - u;
    const Vec2 chord_point = rest * from_ + u * to_;
    const Vec2 bulge = (rest * u) * (square_ + (1 + u) * cube_);
    return {chord_point - bulge, velocity(u), 2 * square_ + (6 * u) * cube_, 6 * cube_};
  }
  CurveRecord record() const {
    return {"cubic", {from_.x(), from_.y(), to_.x(), to_.y(), square_.x(), square_.y(), cube_.x(), cube_.y()}};
  }

 private:
  using Stored = Eigen::Matrix<double, 2, 1, Eigen::DontAlign>;  // with no room between: a scan has millions
  Stored from_;
  Stored to_;
  Stored square_;
  Stored cube_;
};

/// The highest degree of a Bezier curve or a spline that is taken: far above what drawing programs write.
inline constexpr int kMostDegree = 25;

/// A Bezier curve of any degree, rational where weights are given: u in [0, 1], by de Casteljau's algorithm.
/// Both ends are exact to the last bit. Not checked for cusps.
class Bezier {
 public:
  /// One weight above 0 for each control point, or none: all equal.
  /// Throws InputError: fewer than 2 points or more than kMostDegree + 1, a number that is not finite, a weight of 0 or
  /// below, or all points the same.
  explicit Bezier(std::vector<Vec2> points, std::vector<double> weights = {});

  Interval domain() const { return {0, 1}; }
  Vec2 velocity(double u) const;
  Jet jet(double u) const;
  CurveRecord record() const;

 private:
  std::vector<Vec2> points_;
  std::vector<double> weights_;            // empty: all equal
  std::vector<Vec2> slopes_;               // no weights: the control points of the derivatives, one after the other
  std::vector<Eigen::Vector3d> weighted_;  // weights: those of (w (P - first point), w) and of its derivatives
};

/// Which end of a curve its first or last control points crowd together at.
enum class Rest { start, end };

/// A Bezier curve that starts (or ends) at rest: its first two control points coincide, or nearly, as drawing programs
/// write it where a handle is pulled in. There its velocity is 0, and its curvature grows like 1 / sqrt(arc length),
/// though it has a tangent. The parameter v in [0, 1] counts the orders of magnitude of the usual one, so that each
/// is resolved alike: u = first^(1 - v). What lies before u = first is shorter than 1e-20 of the curve and turns by
/// less than 1e-11 rad. Both ends are exact to the last bit.
class BezierFromRest {
 public:
  /// Throws InputError as Bezier does.
  explicit BezierFromRest(std::vector<Vec2> points, std::vector<double> weights = {}, Rest rest = Rest::start);

  Interval domain() const { return {0, 1}; }
  Jet jet(double v) const;
  CurveRecord record() const;
  /// The Bezier curve itself, with one place for the control points that rest there.
  CurveRecord formula() const;
  double formula_parameter(double v) const;

 private:
  double distance_from_rest(double v) const;  // by the Bezier curve's parameter

  std::vector<Vec2> points_;  // as given
  std::vector<double> weights_;
  Rest rest_;
  Vec2 origin_;  // where it rests
  Vec2 far_end_;
  std::vector<Eigen::Vector3d> weighted_;  // from the resting end on: as in Bezier
  double orders_;                          // ln(1 / first)
};

/// A Bezier curve as pieces that are regular, ends included, in order: a Line where it runs straight ahead, a
/// BezierFromRest (or two) where an end is at rest, else the Bezier curve itself. None where it is a point.
/// Throws InputError as Bezier does.
std::vector<Curve> bezier_curves(std::vector<Vec2> points, std::vector<double> weights = {});

/// A non-uniform rational B-spline curve cut at its knots, because between them it is analytic: the Bezier curve of
/// each stretch that has a length, in order, see bezier_curves. The knots are control points + degree + 1 in number;
/// those outside [knots[degree], knots[points]] shape the curve, which runs over that interval. No weights: all equal.
/// Throws InputError: a degree outside [1, kMostDegree], too few points, another number of knots or weights, knots that
/// fall, an inner knot more often than its degree (the curve would have a gap), a number that is not finite, a weight
/// of 0 or below.
std::vector<Curve> nurbs(int degree, const std::vector<double>& knots, const std::vector<Vec2>& points,
                         const std::vector<double>& weights = {});

}  // namespace rollfix
