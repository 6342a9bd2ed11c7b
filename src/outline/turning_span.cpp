#include "outline/turning_span.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "rollfix/error.hpp"

namespace rollfix {

namespace {

// For turns of at most one radian the error of 12 points is far below rounding.
using SpanQuadrature = boost::math::quadrature::gauss<double, 12>;

/// A span on which the sum of its terms' turns is a rounding error above the limit is taken.
constexpr double kSlack = 1e-9;

}  // namespace

double span_turn(const TurningSpan::Cubic& turning, double length) {
  return length * (std::abs(turning[1]) + length * (std::abs(turning[2]) + length * std::abs(turning[3])));
}

TurningSpan::TurningSpan(const Vec2& start, const Cubic& turning, double length)
    : start_(start), turning_(turning), length_(length) {
  const bool is_finite =
      start.allFinite() && std::all_of(turning.begin(), turning.end(), [](double c) { return std::isfinite(c); });
  if (!is_finite || !std::isfinite(length) || !(length > 0)) {
    throw InputError(
        fmt::format("a span by its turning from ({}, {}), of length {}: expected finite numbers and a length above 0",
                    start.x(), start.y(), length));
  }
  if (!(span_turn(turning, length) <= kMostSpanTurn + kSlack)) {
    throw InputError(
        fmt::format("a span by its turning that may turn by {}: expected at most {} rad, cut it into several",
                    span_turn(turning, length), kMostSpanTurn));
  }
}

Vec2 TurningSpan::velocity(double s) const {
  const double theta = angle(s);
  return {std::cos(theta), std::sin(theta)};
}

Vec2 TurningSpan::position(double s) const {
  const double half = 0.5 * s;
  const auto& nodes = SpanQuadrature::abscissa();
  const auto& weights = SpanQuadrature::weights();
  Vec2 sum = Vec2::Zero();
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double reach = half * nodes[k];
    sum += weights[k] * (velocity(half + reach) + velocity(half - reach));
  }
  return start_ + half * sum;
}

Jet TurningSpan::jet(double s) const {
  const Vec2 tangent = velocity(s);
  const Vec2 normal(-tangent.y(), tangent.x());
  const double curvature = turning_[1] + s * (2 * turning_[2] + s * 3 * turning_[3]);
  const double rate = 2 * turning_[2] + s * 6 * turning_[3];
  return {position(s), tangent, curvature * normal, rate * normal - (curvature * curvature) * tangent};
}

CurveRecord TurningSpan::record() const {
  return {"turning", {start_.x(), start_.y(), turning_[0], turning_[1], turning_[2], turning_[3], length_}};
}

}  // namespace rollfix
