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

namespace rollfix {

namespace {

namespace geometry = boost::geometry;
namespace spatial = boost::geometry::index;

using BoxCorner = geometry::model::point<double, 2, geometry::cs::cartesian>;
using BoxedPolygon = std::pair<geometry::model::box<BoxCorner>, std::size_t>;

/// So many that are hardly larger are asked first: of rings in rings one of them is the answer, and all boxes are
/// around.
constexpr std::size_t kNeighbours = 16;

BoxCorner box_corner(const Vec2& point) { return {point.x(), point.y()}; }

class Nesting {
 public:
  explicit Nesting(const std::vector<Polygon>& polygons) : polygons_(polygons), tree_(boxes_of(polygons)) {}

  /// The smallest of those before k that is around its first point.
  std::optional<std::size_t> around(std::size_t k) const {
    const Vec2& point = polygons_[k].points.front();
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
