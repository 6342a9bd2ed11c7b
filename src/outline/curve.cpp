#include "rollfix/outline/curve.hpp"

#include <cmath>

#include "outline/reversed_kind.hpp"

namespace rollfix {

double curvature(const Jet& jet) {
  const double speed_squared = jet.first.squaredNorm();
  return cross(jet.first, jet.second) / (speed_squared * std::sqrt(speed_squared));
}

double curvature_rate(const Jet& jet) {
  const double speed_squared = jet.first.squaredNorm();
  const double turning = cross(jet.first, jet.second);
  const double turning_rate = cross(jet.first, jet.third);
  const double stretching = jet.first.dot(jet.second);
  return (turning_rate - 3 * turning * stretching / speed_squared) / (speed_squared * std::sqrt(speed_squared));
}

namespace {

struct Reversed {
  Curve original;

  Interval domain() const { return original.domain(); }
  double mirror(double u) const { return domain().lo + (domain().hi - u); }
  Jet jet(double u) const {
    const Jet forward = original.jet(mirror(u));
    return {forward.position, -forward.first, forward.second, -forward.third};
  }
  Vec2 velocity(double u) const { return -original.velocity(mirror(u)); }
  std::optional<CurveRecord> record() const {
    std::optional<CurveRecord> record = original.record();
    if (record) record->kind = kReversedPrefix + record->kind;
    return record;
  }
};

}  // namespace

Curve reversed(const Curve& curve) { return Reversed{curve}; }

}  // namespace rollfix
