#include "outline/nesting.hpp"

#include <algorithm>
#include <boost/geometry/algorithms/intersects.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace rollfix {

namespace {

namespace geometry = boost::geometry;
namespace spatial = boost::geometry::index;

using BoxCorner = geometry::model::point<double, 2, geometry::cs::cartesian>;
using BoxedPolygon = std::pair<geometry::model::box<BoxCorner>, std::size_t>;

/// So many that are hardly larger are asked first: of rings in rings one of them is the answer, and all boxes are
/// around.
constexpr std::size_t kNeighbours = 16;

/// In the middle of the widest piece of the horizontal line halfway up.
Vec2 point_inside(const Polygon& polygon) {
  const double y = 0.5 * (polygon.box.min().y() + polygon.box.max().y());
  std::vector<double> crossings;
  for (std::size_t k = 0; k < polygon.points.size(); ++k) {
    const Vec2& a = polygon.points[k];
    const Vec2& b = polygon.points[(k + 1) % polygon.points.size()];
    if ((a.y() > y) != (b.y() > y)) crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::sort(crossings.begin(), crossings.end());
  Vec2 widest = polygon.points.front();
  double width = 0;
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
    if (crossings[k + 1] - crossings[k] <= width) continue;
    width = crossings[k + 1] - crossings[k];
    widest = {crossings[k] + 0.5 * width, y};
  }
  return widest;
}

BoxCorner box_corner(const Vec2& point) { return {point.x(), point.y()}; }

class Nesting {
 public:
  explicit Nesting(const std::vector<Polygon>& polygons) : polygons_(polygons), tree_(boxes_of(polygons)) {}

  /// The smallest of those before k that is around it: around a point inside of it, as those on it may be on both.
  std::optional<std::size_t> around(std::size_t k) const {
    const Vec2 point = point_inside(polygons_[k]);
    const std::size_t last = k > kNeighbours ? k - kNeighbours : 0;
    for (std::size_t j = k; j-- > last;) {
      if (polygons_[j].contains(point)) return j;
    }
    std::vector<std::size_t> boxed;
    for (auto found = tree_.qbegin(spatial::intersects(box_corner(point))); found != tree_.qend(); ++found) {
      if (found->second < last) boxed.push_back(found->second);
    }
    std::sort(boxed.begin(), boxed.end(), std::greater<>());
    const auto holds = [&](std::size_t j) { return polygons_[j].contains(point); };
    const auto first = std::find_if(boxed.begin(), boxed.end(), holds);
    return first == boxed.end() ? std::nullopt : std::optional(*first);
  }

 private:
  static std::vector<BoxedPolygon> boxes_of(const std::vector<Polygon>& polygons) {
    std::vector<BoxedPolygon> all;
    for (const Polygon& one : polygons)
      all.push_back({{box_corner(one.box.min()), box_corner(one.box.max())}, all.size()});
    return all;
  }

  const std::vector<Polygon>& polygons_;
  spatial::rtree<BoxedPolygon, spatial::quadratic<16>> tree_;
};

}  // namespace

std::vector<int> nesting_depths(const std::vector<Polygon>& polygons) {
  const Nesting nesting(polygons);
  std::vector<int> depths(polygons.size(), 0);
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    if (const auto outer = nesting.around(k)) depths[k] = depths[*outer] + 1;
  }
  return depths;
}

}  // namespace rollfix
