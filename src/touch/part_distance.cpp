#include "part_distance.hpp"

#include <cmath>
#include <limits>

#include "nearest.hpp"
#include "outline/turn.hpp"

namespace rollfix::touch {
namespace {

// The tangents beside a place, for the side that a point is on, are taken so far from it, in shares of the perimeter.
constexpr double kBeside = 1e-8;
// There is a corner where they differ by more, radians.
constexpr double kCornerTurn = 1e-4;

}  // namespace

PartDistance::PartDistance(const Part& part) : part_(part), boundary_(part_, 0), tree_(boundary_) {}

/// The side of a corner is that of both normals together.
NearestOfPart PartDistance::nearest(const Vec2& point) {
  InPart at;
  at.at = point;
  const CentrePoint place = boundary_.at(nearest_place(tree_, at));
  const Vec2 off = point - place.centre;
  NearestOfPart result;
  result.contact = place.centre;
  result.distance = off.norm();
  const double before = part_.tangent(place.s - kBeside * part_.perimeter());
  const double after = part_.tangent(place.s + kBeside * part_.perimeter());
  const Vec2 outward(std::sin(before) + std::sin(after), -std::cos(before) - std::cos(after));
  const bool is_corner = place.along.isZero() || std::abs(nearest_angle(after - before)) > kCornerTurn;
  result.curvature = is_corner ? std::numeric_limits<double>::infinity() : place.bend;
  const bool is_inside = part_.closed() && off.dot(outward) < 0;
  result.away = result.distance > 0 ? Vec2(off / result.distance) : outward.normalized();
  if (!is_inside) return result;
  result.distance = -result.distance;
  result.away = -result.away;
  return result;
}

}  // namespace rollfix::touch
