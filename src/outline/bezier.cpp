#include "rollfix/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "rollfix/error.hpp"

// Notation:
//   P_k, w_k        control points and weights: `points_`, `weights_`; (w_k P_k, w_k) together: Homogeneous
//   u               parameter in [0, 1]; B(u) by de Casteljau's algorithm: `de_casteljau`
//   B', B''         by differences of control points; of a quotient by its rule, order after order: `projected`
//   rest            an end at which B' = 0, as control points next to it coincide with it, or nearly
//   v               parameter of a curve from rest, u = exp(-orders (1 - v)), or exp(-orders v): BezierFromRest
//   blossom         the polar form of a spline's span, whose values are the control points of that span
// Follows G. Farin, "Curves and Surfaces for CAGD" (5th ed., 2002); docs/files.md, "DXF" and "SVG".
// Idea: from rest u is taken by orders of magnitude, so that by v the velocity vanishes nowhere. Straight curves become
// lines, those at rest at both ends are cut in two, and a spline becomes a Bezier curve for each of its spans.
namespace rollfix {

namespace {

/// A point times its weight, and the weight.
using Homogeneous = Eigen::Vector3d;

/// (w P, w): in these coordinates a rational curve is a polynomial one.
Homogeneous lifted(const Vec2& point, double weight) { return {weight * point.x(), weight * point.y(), weight}; }

/// Throws InputError: a point that is not finite, a weight that is not above 0, or another number of weights than of
/// points.
void require_points(const std::vector<Vec2>& points, const std::vector<double>& weights) {
  if (!weights.empty() && weights.size() != points.size()) {
    throw InputError(
        fmt::format("expected one weight for each of {} control points, found {}", points.size(), weights.size()));
  }
  for (const Vec2& point : points) {
    if (!point.allFinite()) {
      throw InputError(fmt::format("expected finite control points, found ({}, {})", point.x(), point.y()));
    }
  }
  for (const double weight : weights) {
    if (!(weight > 0) || !std::isfinite(weight)) {
      throw InputError(fmt::format("expected weights above 0, found {}", weight));
    }
  }
}

/// The point at u of the Bezier curve with these control points; no control points: 0.
template <class Point>
Point de_casteljau(const Point* controls, std::size_t count, double u) {
  if (count == 0) return Point::Zero();
  std::array<Point, kMostDegree + 1> row;
  std::copy(controls, controls + count, row.begin());
  // Each turn replaces neighbours by their mean at u; the last one left is the point.
  for (std::size_t left = count; left > 1; --left) {
    for (std::size_t k = 0; k + 1 < left; ++k) row[k] = (1 - u) * row[k] + u * row[k + 1];
  }
  return row[0];
}

/// Appends the control points of a curve's first three derivatives, given its own.
/// Differences of control points keep a velocity exact where it is small; those of points do not.
template <class Point>
void append_derivatives(std::vector<Point>& rows, const std::vector<Point>& controls) {
  std::array<Point, kMostDegree + 1> row;
  std::copy(controls.begin(), controls.end(), row.begin());
  // `row` holds the control points of the order before; each turn overwrites it by differences.
  std::size_t count = controls.size();
  rows.reserve(rows.size() + 3 * count);
  // The derivative of a Bezier curve of degree n has the control points n (P_(k+1) - P_k), and the degree n - 1.
  for (int order = 1; order <= 3 && count > 1; ++order) {
    const auto degree = static_cast<double>(--count);
    for (std::size_t k = 0; k < count; ++k) row[k] = degree * (row[k + 1] - row[k]);
    rows.insert(rows.end(), row.begin(), row.begin() + static_cast<std::ptrdiff_t>(count));
  }
}

/// The control points of (w (P - origin), w), and of its derivatives after them.
std::vector<Homogeneous> weighted_rows(const std::vector<Vec2>& points, const std::vector<double>& weights,
                                       const Vec2& origin) {
  std::vector<Homogeneous> controls;
  // Seen from `origin`, so that near it positions have all their digits.
  for (std::size_t k = 0; k < points.size(); ++k) {
    controls.push_back(lifted(points[k] - origin, weights.empty() ? 1 : weights[k]));
  }
  std::vector<Homogeneous> rows = controls;
  append_derivatives(rows, controls);
  return rows;
}

/// Position (from the origin) and derivatives of numerator / w (the quotient rule, one order after the other).
/// `rows`: control points of the curve and of its first three derivatives, one after the other; `count` of the curve.
Jet projected(const std::vector<Homogeneous>& rows, std::size_t count, double u) {
  // d[k]: the k-th derivative of (w c, w). A degree below k has none: 0.
  std::array<Homogeneous, 4> d;
  const Homogeneous* row = rows.data();
  for (std::size_t order = 0; order < d.size(); ++order) {
    const std::size_t left = count > order ? count - order : 0;
    d[order] = de_casteljau(row, left, u);
    row += left;
  }
  // From w c = d: w c' = d' - w' c, w c'' = d'' - 2 w' c' - w'' c, and so on.
  const double w = d[0].z();
  const auto plane = [&d](std::size_t k) { return Vec2(d[k].head<2>()); };
  Jet jet;
  jet.position = plane(0) / w;
  jet.first = (plane(1) - d[1].z() * jet.position) / w;
  jet.second = (plane(2) - 2 * d[1].z() * jet.first - d[2].z() * jet.position) / w;
  jet.third = (plane(3) - 3 * d[1].z() * jet.second - 3 * d[2].z() * jet.first - d[3].z() * jet.position) / w;
  return jet;
}

/// Throws InputError: a degree that is not taken, or what require_points refuses.
void require_bezier(const std::vector<Vec2>& points, const std::vector<double>& weights) {
  if (points.size() < 2 || points.size() > kMostDegree + 1) {
    throw InputError(fmt::format("expected 2 to {} control points, found {}", kMostDegree + 1, points.size()));
  }
  require_points(points, weights);
}

/// To the bit: such a curve is a point.
bool all_the_same(const std::vector<Vec2>& points) {
  return std::all_of(points.begin(), points.end(), [&](const Vec2& point) { return point == points[0]; });
}

/// Equal weights cancel: without any the curve is the polynomial one, which costs less.
void clear_equal(std::vector<double>& weights) {
  if (std::all_of(weights.begin(), weights.end(), [&](double weight) { return weight == weights[0]; })) weights.clear();
}

/// The record of a curve by control points; the prefix "rational-" where there are weights.
CurveRecord recorded(std::string kind, const std::vector<Vec2>& points, const std::vector<double>& weights) {
  CurveRecord record{(weights.empty() ? "" : "rational-") + std::move(kind), {}};
  for (std::size_t k = 0; k < points.size(); ++k) {
    record.numbers.push_back(points[k].x());
    record.numbers.push_back(points[k].y());
    if (!weights.empty()) record.numbers.push_back(weights[k]);
  }
  return record;
}

/// How far rounding may have moved control points.
double rounding_of(const std::vector<Vec2>& points) {
  constexpr double kRoundings = 8;  // of a few multiplications: a transformation of the drawing
  double most = 0;
  for (const Vec2& point : points) most = std::max(most, point.cwiseAbs().maxCoeff());
  return kRoundings * std::numeric_limits<double>::epsilon() * most;
}

/// The longest distance from one control point to the next: a size of the curve.
double longest_step(const std::vector<Vec2>& points) {
  double most = 0;
  for (std::size_t k = 1; k < points.size(); ++k) most = std::max(most, (points[k] - points[k - 1]).norm());
  return most;
}

/// The control point number k, counted from an end.
const Vec2& counted_from(Rest end, const std::vector<Vec2>& points, std::size_t k) {
  return end == Rest::start ? points[k] : points[points.size() - 1 - k];
}

/// The number of control points next to an end one that coincide with it but for rounding.
std::size_t resting(const std::vector<Vec2>& points, Rest end = Rest::start) {
  // Counted from the end on, up to the first that is further away than rounding.
  const double rounding = rounding_of(points);
  const Vec2& first = counted_from(end, points, 0);
  std::size_t count = 0;
  while (count + 1 < points.size() && (counted_from(end, points, count + 1) - first).norm() <= rounding) ++count;
  return count;
}

/// A first step below this share of the longest one makes a curve start at rest, or so nearly that halving its
/// parameter's interval would not get there.
constexpr double kSlowStart = 1e-6;

/// Whether the curve's velocity at this end is 0, or so small beside the rest of it that it counts as 0.
bool is_at_rest(const std::vector<Vec2>& points, Rest end) {
  const double step = (counted_from(end, points, 1) - counted_from(end, points, 0)).norm();
  return step < kSlowStart * longest_step(points) || resting(points, end) > 0;
}

/// All control points on one line, one after the other: the curve is that line.
bool is_straight(const std::vector<Vec2>& points) {
  const Vec2 chord = points.back() - points.front();
  const double length = chord.norm();
  const double rounding = rounding_of(points);
  // Ends that coincide: no line.
  if (!(length > rounding)) return false;
  const Vec2 ahead = chord / length;
  for (std::size_t k = 1; k < points.size(); ++k) {
    // Off the line by more than rounding, or a step backwards along it: not that line.
    if (std::abs(cross(ahead, points[k] - points[0])) > rounding) return false;
    if (ahead.dot(points[k] - points[k - 1]) < -rounding) return false;
  }
  return true;
}

/// Control points with their weights; no weights: all equal.
struct Controls {
  std::vector<Vec2> points;
  std::vector<double> weights;
};

/// Of the same curve in the opposite direction.
Controls reversed(Controls controls) {
  std::reverse(controls.points.begin(), controls.points.end());
  std::reverse(controls.weights.begin(), controls.weights.end());
  return controls;
}

/// The control points of the first half, u in [0, 1/2].
Controls first_half(const Controls& whole) {
  const bool rational = !whole.weights.empty();
  // De Casteljau's scheme at u = 1/2: the first of each row is a control point of the first half.
  std::vector<Homogeneous> row;
  for (std::size_t k = 0; k < whole.points.size(); ++k) {
    row.push_back(lifted(whole.points[k], rational ? whole.weights[k] : 1));
  }
  Controls half;
  // The first one is taken as given, so that the half starts at it to the bit.
  for (std::size_t left = row.size(); left >= 1; --left) {
    half.points.emplace_back(left == row.size() ? whole.points[0] : row[0].head<2>() / row[0].z());
    if (rational) half.weights.push_back(row[0].z());
    for (std::size_t k = 0; k + 1 < left; ++k) row[k] = 0.5 * (row[k] + row[k + 1]);
  }
  return half;
}

/// One of a spline's polynomial stretches: its control points as a Bezier curve, by the spline's polar form (blossom).
Homogeneous blossom(std::vector<Homogeneous> row, const std::vector<double>& knots, int degree, std::size_t span,
                    const std::vector<double>& arguments) {
  // De Boor's scheme with another argument at each level. With lo and hi of a span as arguments, k times hi, it gives
  // control point k of that span.
  const auto p = static_cast<std::size_t>(degree);
  // After each level row[level ... p] hold the mixes by the first `level` arguments; row[p] is the value at the end.
  for (std::size_t level = 1; level <= p; ++level) {
    for (std::size_t j = p; j >= level; --j) {
      const double lo = knots[span - p + j];
      const double hi = knots[span + 1 + j - level];
      // lo < hi: the span has a length and lies between them.
      const double share = (arguments[level - 1] - lo) / (hi - lo);
      row[j] = (1 - share) * row[j - 1] + share * row[j];
    }
  }
  return row[p];
}

/// Throws InputError: what nurbs() refuses in degree and knots.
void require_knots(int degree, const std::vector<double>& knots, std::size_t points) {
  if (degree < 1 || degree > kMostDegree) {
    throw InputError(fmt::format("expected a spline of degree 1 to {}, found {}", kMostDegree, degree));
  }
  const auto p = static_cast<std::size_t>(degree);
  if (points < p + 1) {
    throw InputError(
        fmt::format("expected at least {} control points for a spline of degree {}, found {}", p + 1, degree, points));
  }
  if (knots.size() != points + p + 1) {
    throw InputError(fmt::format("expected {} knots for {} control points and degree {}, found {}", points + p + 1,
                                 points, degree, knots.size()));
  }
  for (std::size_t k = 0; k < knots.size(); ++k) {
    if (!std::isfinite(knots[k])) throw InputError(fmt::format("expected finite knots, found {}", knots[k]));
    if (k > 0 && knots[k] < knots[k - 1]) {
      throw InputError(fmt::format("expected knots in rising order, found {} after {}", knots[k], knots[k - 1]));
    }
  }
  // The interval that the curve runs over.
  if (!(knots[p] < knots[points])) throw InputError("expected knots that span an interval, found them all the same");
  // p + 1 equal inner knots: the spans on both sides share no control point, so they need not meet.
  for (std::size_t k = p + 1; k + p < points; ++k) {
    if (knots[k] == knots[k + p] && knots[k] > knots[p] && knots[k] < knots[points]) {
      throw InputError(fmt::format("the inner knot {} stands there more than {} times: the curve has a gap there",
                                   knots[k], degree));
    }
  }
}

}  // namespace

/// Derivatives' control points are computed once, for all places.
Bezier::Bezier(std::vector<Vec2> points, std::vector<double> weights)
    : points_(std::move(points)), weights_(std::move(weights)) {
  require_bezier(points_, weights_);
  if (all_the_same(points_)) throw InputError("all control points of a curve are the same; leave it out");
  clear_equal(weights_);
  if (weights_.empty()) {
    append_derivatives(slopes_, points_);
  } else {
    weighted_ = weighted_rows(points_, weights_, points_.front());
  }
}

/// Without weights the control points of the first derivative alone are enough.
Vec2 Bezier::velocity(double u) const {
  return weights_.empty() ? de_casteljau(slopes_.data(), points_.size() - 1, u) : jet(u).first;
}

Jet Bezier::jet(double u) const {
  const std::size_t count = points_.size();
  Jet jet;
  if (weights_.empty()) {
    // slopes_ holds n points of the first derivative, then n - 1 of the second, then n - 2 of the third; n is the
    // degree.
    const Vec2* const seconds = slopes_.data() + (count - 1);
    const std::size_t left = count - 2;  // second derivatives' control points
    jet.position = de_casteljau(points_.data(), count, u);
    jet.first = de_casteljau(slopes_.data(), count - 1, u);
    jet.second = de_casteljau(seconds, left, u);
    jet.third = de_casteljau(seconds + left, left > 0 ? left - 1 : 0, u);
  } else {
    jet = projected(weighted_, count, u);
    jet.position += points_.front();
  }
  // The scheme's own result may be a rounding off, and neighbouring curves must meet.
  if (u == 0) jet.position = points_.front();
  if (u == 1) jet.position = points_.back();
  return jet;
}

CurveRecord Bezier::record() const { return recorded("bezier", points_, weights_); }

BezierFromRest::BezierFromRest(std::vector<Vec2> points, std::vector<double> weights, Rest rest)
    : points_(std::move(points)), weights_(std::move(weights)), rest_(rest) {
  require_bezier(points_, weights_);
  clear_equal(weights_);
  Controls controls{points_, weights_};
  // Everything below is as seen from the resting end.
  if (rest_ == Rest::end) controls = reversed(std::move(controls));
  origin_ = controls.points.front();
  far_end_ = controls.points.back();
  // Those that rest there but for rounding are put there, so that the curve starts at rest exactly.
  const std::size_t count = resting(controls.points);
  if (count + 1 == points_.size()) throw InputError("all control points of a curve are the same; leave it out");
  for (std::size_t k = 1; k <= count; ++k) controls.points[k] = origin_;
  weighted_ = weighted_rows(controls.points, controls.weights, origin_);
  // Over u the direction changes by about u / natural. At the first u the rounding of cross(first, second), which is
  // epsilon * natural / u of it, must leave the curvature's sign and trend alone.
  constexpr double kFirst = 0x1p-37;
  // The first step away from rest, as a share of the longest step.
  const double natural = (controls.points[count + 1] - controls.points[count]).norm() / longest_step(controls.points);
  orders_ = -std::log(kFirst * natural);
}

/// The Bezier curve's parameter, as seen from the resting end: from 2^-37 times `natural` at v = 0 to 1 at v = 1, or
/// back.
double BezierFromRest::distance_from_rest(double v) const {
  return std::exp(-orders_ * (rest_ == Rest::start ? 1 - v : v));
}

Jet BezierFromRest::jet(double v) const {
  // du/dv = a u, a being `orders_` with this sign.
  const double sign = rest_ == Rest::start ? 1 : -1;
  const double from_rest = rest_ == Rest::start ? v : 1 - v;
  const double u = distance_from_rest(v);
  const Jet by_u = projected(weighted_, points_.size(), u);
  // u' = a u with a = +-orders, so d/dv of (u p') is a (u p' + u^2 p''), and so on.
  const double a = sign * orders_;
  const Vec2 one = u * by_u.first;
  const Vec2 two = u * u * by_u.second;
  const Vec2 three = u * u * u * by_u.third;
  Jet jet{origin_ + by_u.position, a * one, a * a * (one + two), a * a * a * (one + 3 * two + three)};
  // At the resting end the curve is put on the control point, though u is not 0 there: the piece left out is below
  // rounding.
  if (from_rest == 0) jet.position = origin_;
  if (from_rest == 1) jet.position = far_end_;
  return jet;
}

CurveRecord BezierFromRest::record() const {
  return recorded(rest_ == Rest::start ? "bezier-from-rest" : "bezier-to-rest", points_, weights_);
}

/// The control points that rest are made equal, as the constructor does it.
CurveRecord BezierFromRest::formula() const {
  std::vector<Vec2> points = points_;
  const auto at_rest = static_cast<std::ptrdiff_t>(1 + resting(points_, rest_));
  std::fill_n(rest_ == Rest::start ? points.begin() : points.end() - at_rest, at_rest, origin_);
  return recorded("bezier", points, weights_);
}

/// u of the formula for v; at the resting end 0, or 1 where that is the curve's end.
double BezierFromRest::formula_parameter(double v) const {
  const double at_rest = rest_ == Rest::start ? 0 : 1;
  return v == at_rest ? at_rest : std::abs(at_rest - distance_from_rest(v));
}

/// In this order: a point (none), a line, at rest at both ends (two halves), at one end, or regular.
std::vector<Curve> bezier_curves(std::vector<Vec2> points, std::vector<double> weights) {
  require_bezier(points, weights);
  if (resting(points) + 1 == points.size()) return {};
  if (is_straight(points)) return {Line(points.front(), points.back())};
  const bool rests_at_start = is_at_rest(points, Rest::start);
  const bool rests_at_end = is_at_rest(points, Rest::end);
  // u can count orders of magnitude from one end only.
  if (rests_at_start && rests_at_end) {
    const Controls whole{std::move(points), std::move(weights)};
    // The second half is the first half seen from the other end.
    Controls start = first_half(whole);
    Controls end = reversed(first_half(reversed(whole)));
    return {BezierFromRest(std::move(start.points), std::move(start.weights), Rest::start),
            BezierFromRest(std::move(end.points), std::move(end.weights), Rest::end)};
  }
  if (rests_at_start) return {BezierFromRest(std::move(points), std::move(weights), Rest::start)};
  if (rests_at_end) return {BezierFromRest(std::move(points), std::move(weights), Rest::end)};
  return {Bezier(std::move(points), std::move(weights))};
}

/// Each span of the knots that has a length becomes the Bezier curve of its blossom's values.
std::vector<Curve> nurbs(int degree, const std::vector<double>& knots, const std::vector<Vec2>& points,
                         const std::vector<double>& weights) {
  require_points(points, weights);
  require_knots(degree, knots, points.size());
  const auto p = static_cast<std::size_t>(degree);
  std::vector<Curve> curves;
  Vec2 joint = Vec2::Zero();
  // The span [lo, hi] is shaped by the control points span - p ... span.
  for (std::size_t span = p; span < points.size(); ++span) {
    const double lo = knots[span];
    const double hi = knots[span + 1];
    // A repeated knot: no stretch between.
    if (!(lo < hi)) continue;
    std::vector<Homogeneous> row;
    for (std::size_t j = span - p; j <= span; ++j) row.push_back(lifted(points[j], weights.empty() ? 1 : weights[j]));
    std::vector<Vec2> own_points;
    std::vector<double> own_weights;
    std::vector<double> arguments(p, lo);
    // Control point k is the blossom's value with k arguments at hi and the others at lo.
    for (std::size_t k = 0; k <= p; ++k) {
      if (k > 0) arguments[k - 1] = hi;
      const Homogeneous control = blossom(row, knots, degree, span, arguments);
      // A control point that is one of the spline's is it to the last bit, whatever its weight.
      const auto same = std::find(row.begin(), row.end(), control);
      own_points.push_back(same != row.end() ? points[span - p + static_cast<std::size_t>(same - row.begin())]
                                             : Vec2(control.head<2>() / control.z()));
      if (!weights.empty()) own_weights.push_back(control.z());
    }
    if (span > p && !curves.empty()) own_points.front() = joint;  // where the one before ends, to the last bit
    joint = own_points.back();
    // Each stretch may be a line, rest at an end, or be a point and vanish.
    for (Curve& curve : bezier_curves(std::move(own_points), std::move(own_weights))) {
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

}  // namespace rollfix
