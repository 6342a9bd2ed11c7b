#include "contact_look.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "part/turning_range.hpp"

// Notation:
//   J, c            a corner's turn and its place
//   d = (s - c)/sd  how far s is past it, in standard deviations; Phi, phi the normal distribution and its density
// Idea: over s + n, n ~ N(0, sd), Theta is on average what it is without the corner and J Phi(d) more; the variance is
// J^2 Phi(d) (1 - Phi(d)). Elsewhere Theta is straight over so short a way.
namespace rollfix::hold {
namespace {

constexpr double kBlurReach = 5;  // standard deviations: beyond, a corner is not seen

BlurredPlace plain(const Part& part, double s) {
  BlurredPlace place;
  const Boundary boundary = part.boundary();
  const double at = boundary.closed ? s : std::clamp(s, 0.0, boundary.perimeter);
  place.point = part.point(at);
  place.angle = part.turning().angle(at);
  place.curvature = place.bend = part.turning().curvature(at);
  place.tangent = {std::cos(place.angle), std::sin(place.angle)};
  // Beyond an open boundary's end it goes straight on, so that a fit finds back.
  place.point += (s - at) * place.tangent;
  return place;
}

}  // namespace

BlurredPlace blurred(const Part& part, double s, double sd) {
  BlurredPlace place = plain(part, s);
  const Boundary boundary = part.boundary();
  for (const Corner& corner : part.corners()) {
    const double past = boundary.offset(corner.s, s);
    if (std::abs(past) > kBlurReach * sd) continue;
    const double d = past / sd;
    const double share = 0.5 * std::erfc(-d / std::numbers::sqrt2);
    place.angle += corner.turn * (share - (past >= 0 ? 1 : 0));
    place.bend += corner.turn * std::exp(-0.5 * d * d) / (std::sqrt(2 * std::numbers::pi) * sd);
    place.variance += corner.turn * corner.turn * share * (1 - share);
  }
  return place;
}

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
