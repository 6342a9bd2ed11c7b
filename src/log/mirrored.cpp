#include "log/mirrored.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

// Notation:
//   (x, y)          a point of the world; its mirror image is (-x, y); of an outlined finger's own frame (x, -y)
//   u, psi          contact on the finger and the finger's orientation; in the mirror -u (on an open finger its
//                   length less u) and pi - psi, of a jaw -psi
//   L, theta        length and turn; in the mirror -L and -theta
//   (x, y, heading) a pose of the part; in the mirror (-x, y, -heading)
// Follows src/answer/steps.hpp, View, which mirrors a problem likewise.
// Idea: a part that lies face down, felt by a finger, is the part as it was drawn, felt by the finger's mirror image.
// So the log and the finger are mirrored, and the outline stays.
namespace rollfix {
namespace {

/// A curve with y of the other sign: its position and all derivatives.
struct Upended {
  Interval domain() const { return curve.domain(); }
  Jet jet(double u) const {
    Jet jet = curve.jet(u);
    for (Vec2* vector : {&jet.position, &jet.first, &jet.second, &jet.third}) vector->y() = -vector->y();
    return jet;
  }
  Curve curve;
};

/// The other sign of each.
void negate(std::vector<double>& values) {
  for (double& value : values) value = 0.0 - value;  // no -0
}

/// u of the mirrored finger, of each row. A wrapped column in [0, period] becomes one in [-period, 0]: a period is
/// added, so that a reader still sees where it wraps. An open finger has no period, and nothing is added.
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
  // The mirror image runs clockwise: reversed, its body is on the left again. A closed one keeps its first point.
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

Pose mirrored(const Pose& pose) { return {-pose.x, pose.y, -pose.heading}; }

/// The covariance is M C M, M = diag(-1, 1, -1).
PoseSpread mirrored(const PoseSpread& spread) {
  const Eigen::Vector3d signs(-1, 1, -1);
  return {mirrored(spread.mean), Eigen::Matrix3d(signs.asDiagonal() * spread.covariance * signs.asDiagonal())};
}

}  // namespace rollfix
