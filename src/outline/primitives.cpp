#include "rollfix/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "outline/turn.hpp"
#include "outline/turning_span.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

Line::Line(const Vec2& from, const Vec2& to) : from_(from), to_(to), chord_(to - from) {
  if (!(chord_.squaredNorm() > 0)) {
    throw InputError(fmt::format("a line from ({}, {}) to ({}, {}) has no length; leave it out", from.x(), from.y(),
                                 to.x(), to.y()));
  }
}

namespace {

/// d/du of cos(u) start + sin(u) side ...
Vec2 turned_velocity(const Vec2& start, const Vec2& side, double u) {
  const Turn turn = turn_by(u);
  return turn.cosine * side - turn.sine * start;
}

/// ... and all of it, from the centre.
Jet turned_jet(const Vec2& centre, const Vec2& start, const Vec2& side, double u) {
  const Turn turn = turn_by(u);
  const Vec2 spoke = turn.cosine * start + turn.sine * side;
  const Vec2 first = turn.cosine * side - turn.sine * start;
  return {centre + spoke, first, -spoke, -first};
}

void require_sweep(const char* what, double from, double sweep) {
  const double angle = std::abs(sweep);
  if (angle > 0 && angle <= kFullTurn && std::isfinite(from)) return;
  throw InputError(fmt::format(
      "{} from angle {} with a sweep of {} rad: the sweep's size must be above 0 and at most 2 pi", what, from, sweep));
}

}  // namespace

Arc::Arc(const Vec2& centre, double radius, double from, double sweep)
    : centre_(centre),
      start_(radius * Vec2(std::cos(from), std::sin(from))),
      angle_(std::abs(sweep)),
      radius_(radius),
      from_(from),
      sweep_(sweep) {
  if (!(radius > 0) || !std::isfinite(radius)) {
    throw InputError(fmt::format("an arc of radius {}: the radius must be above 0", radius));
  }
  require_sweep("an arc", from, sweep);
  const double sign = sweep > 0 ? 1 : -1;
  side_ = sign * Vec2(-start_.y(), start_.x());
}

Vec2 Arc::velocity(double u) const { return turned_velocity(start_, side_, u); }

Jet Arc::jet(double u) const { return turned_jet(centre_, start_, side_, u); }

EllipticArc::EllipticArc(const Vec2& centre, const Vec2& major, const Vec2& minor, double from, double sweep)
    : centre_(centre), angle_(std::abs(sweep)), major_(major), minor_(minor), from_(from), sweep_(sweep) {
  const double area = std::abs(cross(major, minor));
  if (!centre.allFinite() || !(area > 0) || !std::isfinite(area)) {
    throw InputError(fmt::format("an ellipse with the half axes ({}, {}) and ({}, {}): they must not be parallel",
                                 major.x(), major.y(), minor.x(), minor.y()));
  }
  require_sweep("an elliptic arc", from, sweep);
  const double sign = sweep > 0 ? 1 : -1;
  start_ = std::cos(from) * major + std::sin(from) * minor;
  side_ = sign * (std::cos(from) * minor - std::sin(from) * major);
}

Vec2 EllipticArc::velocity(double u) const { return turned_velocity(start_, side_, u); }

Jet EllipticArc::jet(double u) const { return turned_jet(centre_, start_, side_, u); }

CurveRecord EllipticArc::record() const {
  return {"elliptic-arc", {centre_.x(), centre_.y(), major_.x(), major_.y(), minor_.x(), minor_.y(), from_, sweep_}};
}

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
