#include "log/mirrored.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace rollfix {
namespace {

struct Upended {
  Interval domain() const { return curve.domain(); }
  Jet jet(double u) const {
    Jet jet = curve.jet(u);
    for (Vec2* vector : {&jet.position, &jet.first, &jet.second, &jet.third}) vector->y() = -vector->y();
    return jet;
  }
  Curve curve;
};

void negate(std::vector<double>& values) {
  for (double& value : values) value = 0.0 - value;  // no -0
}

/// Of places that may be wrapped to [0, period], which stay there.
void mirror_places(std::vector<double>& places, const Finger* finger) {
  const bool is_round = finger == nullptr || std::isfinite(finger->period());
  const bool is_above = std::all_of(places.begin(), places.end(), [](double u) { return u >= 0; });
  const double period = finger == nullptr ? 2 * std::numbers::pi : finger->period();
  for (double& u : places) {
    u = finger == nullptr ? 0.0 - u : mirrored_u(*finger, u);
    if (is_round && is_above) u += period;
  }
}

}  // namespace

Finger mirrored(const Finger& finger) {
  if (finger.outline() == nullptr) return finger;
  // As it is stored; reversed, its body is on the left again. A closed one keeps its first point.
  Outline outline = finger.outline()->outline();
  for (Curve& curve : outline.curves) curve = Upended{curve};
  outline.gallery.clear();
  return Finger::outlined(reversed(outline));
}

double mirrored_u(const Finger& finger, double u) {
  const Part* outline = finger.outline();
  return (outline != nullptr && !outline->closed() ? outline->perimeter() : 0.0) - u;
}

double mirrored_psi(const Finger* finger, double psi) {
  return (finger != nullptr && finger->is_jaw() ? 0.0 : std::numbers::pi) - psi;
}

void mirror(FingerRows& rows, const Finger* finger) {
  mirror_places(rows.u, finger);
  for (double& psi : rows.psi) psi = mirrored_psi(finger, psi);
  negate(rows.length);
  negate(rows.turn);
  negate(rows.distance);
  negate(rows.dturn);
  negate(rows.x);
}

}  // namespace rollfix
