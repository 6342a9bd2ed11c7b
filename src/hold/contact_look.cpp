#include "contact_look.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "part/turning_range.hpp"

// Notation:
//   J, c            a corner's turn and its place; r: `pivot`
//   d = (s - c)/sd  how far s is past it, in standard deviations: `d`; Phi(d): `behind`, its density phi(d): `bell`
//   Phi(-d), Phi(d), (r J / sd) phi(d)   how likely a contact that was felt at s is before, behind and at the corner:
//                   a finger whose centre goes evenly stays at it for r J; `at` is the last
// Idea: before it Theta is lower by J than behind, and at it anything between alike. Elsewhere Theta is straight over
// so short a way. docs/two_fingers.md, "The errors".
namespace rollfix::hold {
namespace {

constexpr double kBlurReach = 5;  // standard deviations: beyond, a corner is not seen

double on_boundary(const Boundary& boundary, double s) {
  return boundary.closed ? s : std::clamp(s, 0.0, boundary.perimeter);
}

BlurredPlace plain(const Part& part, double s) {
  const Turning turning = part.turning().at(on_boundary(part.boundary(), s));
  BlurredPlace place;
  place.side = place.angle = turning.angle;
  place.curvature = place.bend = turning.curvature;
  return place;
}

}  // namespace

Vec2 point_about(const Part& part, double s) {
  const double at = on_boundary(part.boundary(), s);
  if (at == s) return part.point(s);
  const double angle = part.turning().angle(at);
  return part.point(at) + (s - at) * Vec2(std::cos(angle), std::sin(angle));
}

BlurredPlace blurred(const Part& part, double s, double sd, double pivot) {
  BlurredPlace place = plain(part, s);
  const Boundary boundary = part.boundary();
  const double base = boundary.on_first_lap(s);
  for (const Corner& corner : part.corners()) {
    double past = base - corner.s;
    if (boundary.closed && std::abs(past) > 0.5 * boundary.perimeter) {
      past -= std::copysign(boundary.perimeter, past);
    }
    if (std::abs(past) > kBlurReach * sd) continue;
    place.has_corner = true;
    const double d = past / sd;
    const double bell = std::exp(-0.5 * d * d) / std::sqrt(2 * std::numbers::pi);
    const double behind = 0.5 * std::erfc(-d / std::numbers::sqrt2);
    const double at = std::max(0.0, corner.turn) * pivot / sd * bell;
    const double all = 1 + at;
    const double mean = (behind + 0.5 * at) / all;
    place.angle += corner.turn * (mean - (past >= 0 ? 1 : 0));
    place.bend += corner.turn * (bell - 0.5 * d * at + mean * d * at) / (all * sd);
    place.variance += corner.turn * corner.turn * ((behind + at / 3) / all - mean * mean);
    if (corner.turn > 0) place.pivoting += at / all * (1 - std::sin(corner.turn) / corner.turn);
  }
  return place;
}

double turn_from(const Part& part, double s, double m) {
  const Boundary boundary = part.boundary();
  return part.turning().angle(on_boundary(boundary, s + m)) - part.turning().angle(on_boundary(boundary, s));
}

double curvature_at(const Part& part, double s) { return part.turning().curvature(on_boundary(part.boundary(), s)); }

BlurredPlace ranged(const Part& part, double s, double reach) {
  BlurredPlace place = plain(part, s);
  const Boundary boundary = part.boundary();
  Interval arc{s - reach, s + reach};
  if (!boundary.closed)
    arc = {std::clamp(arc.lo, 0.0, boundary.perimeter), std::clamp(arc.hi, 0.0, boundary.perimeter)};
  const Interval angles = angles_over(part.turning(), arc);
  place.angle = angles.middle();
  place.half_turn = 0.5 * angles.width();
  return place;
}

}  // namespace rollfix::hold
