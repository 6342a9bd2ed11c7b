#pragma once

#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix {

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

 private:
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
