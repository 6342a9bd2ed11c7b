#include <2geom/bezier-curve.h>
#include <2geom/path.h>

#include "fitted_curves.hpp"

namespace bench {
namespace {

constexpr double kPrecision = 1e-9;  // rad: of places where the curves meet

Geom::Point point_of(const rollfix::Vec2& point) { return {point.x(), point.y()}; }

Geom::Path path_of(const FittedCurve& curve) {
  Geom::Path path(point_of(curve.points.front()));
  for (std::size_t k = 0; k + 3 < curve.points.size(); k += 3) {
    path.appendNew<Geom::CubicBezier>(point_of(curve.points[k + 1]), point_of(curve.points[k + 2]),
                                      point_of(curve.points[k + 3]));
  }
  return path;
}

}  // namespace

Pairs locate_by_lib2geom(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings, std::size_t pieces) {
  const auto [a, b] = fitted_curves(part, readings, pieces);
  Pairs rough;
  for (const auto& meeting : path_of(a).intersect(path_of(b), kPrecision)) {
    rough.push_back({a.at(static_cast<double>(meeting.first.curve_index) + meeting.first.t),
                     b.at(static_cast<double>(meeting.second.curve_index) + meeting.second.t)});
  }
  return polished(part, readings, rough);
}

}  // namespace bench
