#include "part_distance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "nearest.hpp"
#include "outline/turn.hpp"

namespace rollfix::touch {
namespace {

// The tangents beside a place, for the side that a point is on, are taken so far from it, in shares of the perimeter.
constexpr double kBeside = 1e-8;
// There is a corner where they differ by more, radians.
constexpr double kCornerTurn = 1e-4;
// So near to the boundary, in shares of its diagonal, the direction of a smooth side is that of its normal: the nearest
// point is known no better.
constexpr double kAtBoundary = 1e-5;
// Places of a hole's box, each way, among which its middle is looked for.
constexpr int kLooks = 16;

}  // namespace

PartDistance::PartDistance(const Part& part) : part_(part), boundary_(part_, 0), tree_(boundary_) {
  const PathTree::Node& all = tree_.node(tree_.root());
  corner_ = all.middle - Vec2::Constant(all.radius);
  cell_ = Vec2::Constant(2 * all.radius / kCells);
  is_hole_ = part_.closed() && nearest(corner_).distance < 0;
}

Vec2 PartDistance::middle_of_hole() {
  Vec2 best = corner_;
  double most = -std::numeric_limits<double>::infinity();
  for (int row = 0; row < kLooks; ++row) {
    for (int column = 0; column < kLooks; ++column) {
      const Vec2 place = corner_ + cell_.x() * kCells / kLooks * Vec2(column + 0.5, row + 0.5);
      const double distance = nearest(place).distance;
      if (distance <= most) continue;
      most = distance;
      best = place;
    }
  }
  return best;
}

/// Distance changes by no more than one goes.
Interval PartDistance::between(const Vec2& point) {
  const Vec2 far = ((point - corner_).cwiseQuotient(cell_) / kCells - Vec2::Constant(0.5)).cwiseAbs();
  if (far.maxCoeff() >= 0.5) {
    const double out = (far - Vec2::Constant(0.5)).cwiseMax(0).norm() * cell_.x() * kCells;
    const Interval beyond{out, out + 2 * diagonal()};
    return is_hole_ ? Interval{-beyond.hi, -beyond.lo} : beyond;
  }
  const Vec2 number = ((point - corner_).cwiseQuotient(cell_)).array().floor();
  const int column = std::clamp(static_cast<int>(number.x()), 0, kCells - 1);
  const int row = std::clamp(static_cast<int>(number.y()), 0, kCells - 1);
  const Vec2 middle = corner_ + cell_.cwiseProduct(Vec2(column + 0.5, row + 0.5));
  of_cell_.resize(kCells * kCells, std::numeric_limits<double>::quiet_NaN());
  double& distance = of_cell_[static_cast<std::size_t>(row * kCells + column)];
  if (std::isnan(distance)) distance = nearest(middle).distance;
  const double off = (point - middle).norm();
  return {distance - off, distance + off};
}

/// The side of a corner is that of both normals together.
NearestOfPart PartDistance::nearest(const Vec2& point) {
  InPart at;
  at.at = point;
  const CentrePoint place = nearest_place(tree_, at).point;
  const Vec2 off = point - place.centre;
  NearestOfPart result;
  result.contact = place.centre;
  result.s = place.s;
  result.distance = off.norm();
  const double before = part_.tangent(place.s - kBeside * part_.perimeter());
  const double after = part_.tangent(place.s + kBeside * part_.perimeter());
  const Vec2 outward(std::sin(before) + std::sin(after), -std::cos(before) - std::cos(after));
  const bool is_corner = place.along.isZero() || std::abs(nearest_angle(after - before)) > kCornerTurn;
  result.curvature = is_corner ? std::numeric_limits<double>::infinity() : place.bend;
  const bool is_inside = part_.closed() && off.dot(outward) < 0;
  result.away = result.distance > 0 ? Vec2(off / result.distance) : outward.normalized();
  if (!is_corner && result.distance <= kAtBoundary * diagonal()) {
    result.away = outward.normalized();
    result.distance = off.dot(result.away);
    if (part_.closed() || result.distance >= 0) return result;
    result.distance = -result.distance;
    result.away = -result.away;
    return result;
  }
  if (!is_inside) return result;
  result.distance = -result.distance;
  result.away = -result.away;
  return result;
}

}  // namespace rollfix::touch
