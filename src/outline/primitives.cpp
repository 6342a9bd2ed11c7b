#include "rollfix/outline/primitives.hpp"

#include <fmt/format.h>

#include <cmath>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

Line::Line(const Vec2& from, const Vec2& to) : from_(from), to_(to), chord_(to - from) {
  if (!(chord_.squaredNorm() > 0)) {
    throw InputError(fmt::format("a line from ({}, {}) to ({}, {}) has no length; leave it out", from.x(), from.y(),
                                 to.x(), to.y()));
  }
}

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
  if (!(angle_ > 0) || angle_ > kFullTurn || !std::isfinite(from)) {
    throw InputError(
        fmt::format("an arc from angle {} with a sweep of {} rad: the sweep's size must be above 0 and "
                    "at most 2 pi",
                    from, sweep));
  }
  const double sign = sweep > 0 ? 1 : -1;
  side_ = sign * Vec2(-start_.y(), start_.x());
}

Vec2 Arc::velocity(double u) const {
  const Turn turn = turn_by(u);
  return turn.cosine * side_ - turn.sine * start_;
}

Jet Arc::jet(double u) const {
  const Turn turn = turn_by(u);
  const Vec2 spoke = turn.cosine * start_ + turn.sine * side_;
  const Vec2 first = turn.cosine * side_ - turn.sine * start_;
  return {centre_ + spoke, first, -spoke, -first};
}

EllipticArc::EllipticArc(const Vec2& centre, const Vec2& major, const Vec2& minor, double from, double sweep)
    : centre_(centre), angle_(std::abs(sweep)), major_(major), minor_(minor), from_(from), sweep_(sweep) {
  const double area = std::abs(cross(major, minor));
  if (!centre.allFinite() || !(area > 0) || !std::isfinite(area)) {
    throw InputError(fmt::format("an ellipse with the half axes ({}, {}) and ({}, {}): they must not be parallel",
                                 major.x(), major.y(), minor.x(), minor.y()));
  }
  if (!(angle_ > 0) || angle_ > kFullTurn || !std::isfinite(from)) {
    throw InputError(
        fmt::format("an elliptic arc from angle {} with a sweep of {} rad: the sweep's size must be above 0 and at "
                    "most 2 pi",
                    from, sweep));
  }
  const double sign = sweep > 0 ? 1 : -1;
  start_ = std::cos(from) * major + std::sin(from) * minor;
  side_ = sign * (std::cos(from) * minor - std::sin(from) * major);
}

Vec2 EllipticArc::velocity(double u) const {
  const Turn turn = turn_by(u);
  return turn.cosine * side_ - turn.sine * start_;
}

Jet EllipticArc::jet(double u) const {
  const Turn turn = turn_by(u);
  const Vec2 spoke = turn.cosine * start_ + turn.sine * side_;
  const Vec2 first = turn.cosine * side_ - turn.sine * start_;
  return {centre_ + spoke, first, -spoke, -first};
}

CurveRecord EllipticArc::record() const {
  return {"elliptic-arc", {centre_.x(), centre_.y(), major_.x(), major_.y(), minor_.x(), minor_.y(), from_, sweep_}};
}

}  // namespace rollfix
