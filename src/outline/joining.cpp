#include "outline/joining.hpp"

#include <algorithm>
#include <array>
#include <boost/geometry/algorithms/intersects.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "work/union_find.hpp"

// Notation:
//   c(u)            a curve over its domain, c' its velocity
//   length, area    integrals of |c'|, and of (c - c(front)) x c' (twice the area), by Gauss and Kronrod's rule
//   gap             ends that are no further apart meet: EndClusters, the clusters of single linkage
//   square          of a grid of side 0.7 gap, whose diagonal is below the gap: Square
//   depth           of a polygon: how many others are around it, told by a point inside of it
// Follows docs/files.md, "Loops".
// Idea: the ends in one square are one cluster, and squares at most two apart are looked at point by point; so any
// number of ends takes little more time than to sort them. Around a loop is the smallest of the larger ones that hold a
// point of it.
namespace rollfix::outline {
namespace {

using Quadrature = boost::math::quadrature::gauss_kronrod<double, 15>;

constexpr double kQuadratureTolerance = 1e-12;  // relative
constexpr unsigned kMostHalvings = 12;          // of a curve's domain, at most
constexpr int kPointsPerCurve = 16;

// A place is rounded to some of its coordinates' last digits.
constexpr double kPlaceRounding = 16 * std::numeric_limits<double>::epsilon();

/// Over [-1, 1] for the quadrature, which holds its error against the domain's width as well: of a short arc, whose
/// domain is as narrow as its sweep, no number of halvings would please it.
template <class F>
double integral(const F& f, const Interval& domain, double tolerance = kQuadratureTolerance) {
  const double half = 0.5 * domain.width();
  const auto scaled = [&](double x) { return f(domain.middle() + half * x); };
  return half * Quadrature::integrate(scaled, -1.0, 1.0, kMostHalvings, tolerance);
}

/// Known by its record: a curve of that kind is straight and has constant speed.
bool is_line(const Curve& curve) {
  const auto record = curve.record();
  return record && record->kind == "line";
}

}  // namespace

/// The numbers by which curves are joined and compared (docs/files.md, "Loops"). Twice the area is the integral of
/// (c - front) x c'.
CurveMeasure measure(const Curve& curve) {
  const Interval domain = curve.domain();
  CurveMeasure result;
  result.front = curve.front();
  result.box.extend(result.front);
  result.back = curve.back();
  result.middle = curve.position(domain.middle());
  const bool straight = is_line(curve);
  for (int k = 1; k <= kPointsPerCurve; ++k) {
    const Vec2 point = k == kPointsPerCurve || straight
                           ? result.back
                           : curve.position(domain.lo + domain.width() * k / kPointsPerCurve);
    result.box.extend(point);
    if (straight) break;
  }
  // The ray from the front sweeps no area along it.
  if (straight) {
    result.length = (result.back - result.front).norm();
    return result;
  }
  // The arc length: the integral of |c'|.
  result.length = integral([&](double u) { return curve.velocity(u).norm(); }, domain);
  // The area of a nearly straight curve is close to 0, and no quadrature gets it to a share of itself: with the length
  // added, the tolerance is a share of length^2. A short curve far from (0, 0) has an area of few digits: asked for
  // more, the quadrature would halve to the end.
  const double rounding = kPlaceRounding * result.box.max().cwiseMax(-result.box.min()).maxCoeff() / result.length;
  const double with_length = integral(
      [&](double u) {
        const Jet jet = curve.jet(u);
        return cross(jet.position - result.front, jet.first) + result.length * jet.first.norm();
      },
      domain, std::max(kQuadratureTolerance, rounding));
  result.twice_area = with_length - result.length * result.length;
  return result;
}

bool Polygon::contains(const Vec2& point) const {
  if (!box.contains(point)) return false;
  // Each side that crosses the ray from the point to the right changes between inside and outside. A side holds its
  // lower end only: a corner on the ray counts once where the boundary crosses the ray, else twice or not at all.
  bool inside = false;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec2& a = points[k];
    const Vec2& b = points[(k + 1) % points.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (x > point.x()) inside = !inside;
  }
  return inside;
}

Polygon polygon_of(const Outline& outline) {
  Polygon result;
  for (const Curve& curve : outline.curves) {
    const Interval domain = curve.domain();
    const int count = is_line(curve) ? 1 : kPointsPerCurve;
    for (int k = 0; k < count; ++k) result.points.push_back(curve.position(domain.lo + domain.width() * k / count));
  }
  result.box = box_around(result.points);
  return result;
}

namespace {

/// A square of a grid, with points in it. Its diagonal is just below the gap: all of them are one cluster.
struct Square {
  std::int64_t column = 0;
  std::int64_t row = 0;
  std::size_t first = 0;  // of a list of points
  std::size_t last = 0;   // behind the last
};

/// Those that hold points, by column and row; `points` are sorted by their squares.
std::vector<Square> squares_of(const std::vector<Vec2>& places, double side, std::vector<std::size_t>& points) {
  Vec2 corner = places.empty() ? Vec2(0, 0) : places.front();
  for (const Vec2& place : places) corner = corner.cwiseMin(place);
  // Counted from the lower left corner of all points, so that no number is negative.
  const auto square_of = [&](std::size_t point) {
    const Vec2 at = (places[point] - corner) / side;
    return std::pair(static_cast<std::int64_t>(at.x()), static_cast<std::int64_t>(at.y()));
  };
  points.resize(places.size());
  std::iota(points.begin(), points.end(), std::size_t{0});
  // By columns, in a column by rows, in a square by their numbers.
  std::sort(points.begin(), points.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(square_of(a), a) < std::pair(square_of(b), b); });
  std::vector<Square> squares;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto [column, row] = square_of(points[k]);
    // Points of one square follow one another.
    const bool is_new = squares.empty() || squares.back().column != column || squares.back().row != row;
    if (is_new) squares.push_back({column, row, k, k});
    squares.back().last = k + 1;
  }
  return squares;
}

}  // namespace

/// Single linkage: the sets of points connected by steps of at most the gap. Sorting decides the time; a square is
/// compared only with those at most two columns and two rows away.
EndClusters::EndClusters(const std::vector<Vec2>& points, double gap) : cluster_(points.size()) {
  UnionFind sets(points.size());
  std::vector<std::size_t> sorted;
  const std::vector<Square> squares = squares_of(points, 0.7 * gap, sorted);
  const auto are_near = [&](const Square& one, const Square& other) {
    for (std::size_t i = one.first; i < one.last; ++i) {
      for (std::size_t j = other.first; j < other.last; ++j) {
        if ((points[sorted[i]] - points[sorted[j]]).norm() <= gap) return true;
      }
    }
    return false;
  };
  // Two squares to each side are near enough to hold a point within the gap. Of two the later one looks for the
  // earlier: in each column those are found by walking on.
  // Of each of the three columns (its own and two to the left) the first square that may still be near: it only moves
  // on, as the squares come in order.
  std::array<std::size_t, 3> next{};
  for (std::size_t k = 0; k < squares.size(); ++k) {
    const Square& own = squares[k];
    // All of one square are one cluster: its diagonal is below the gap.
    for (std::size_t i = own.first + 1; i < own.last; ++i) sets.join(sorted[own.first], sorted[i]);
    for (std::size_t back = 0; back < next.size(); ++back) {
      const std::pair from(own.column - static_cast<std::int64_t>(back), own.row - 2);
      std::size_t& begin = next[back];
      while (std::pair(squares[begin].column, squares[begin].row) < from) ++begin;
      // Squares that are already connected need no look at their points.
      for (std::size_t j = begin; j < k && squares[j].column == from.first && squares[j].row <= own.row + 2; ++j) {
        const std::size_t one = sorted[own.first];
        const std::size_t other = sorted[squares[j].first];
        if (sets.find(one) != sets.find(other) && are_near(own, squares[j])) sets.join(one, other);
      }
    }
  }
  // Clusters are numbered in the order of their first points.
  members_ = sets.sets();
  for (std::size_t cluster = 0; cluster < members_.size(); ++cluster) {
    for (const std::size_t point : members_[cluster]) cluster_[point] = cluster;
  }
}

namespace {

namespace geometry = boost::geometry;
namespace spatial = boost::geometry::index;

using BoxCorner = geometry::model::point<double, 2, geometry::cs::cartesian>;
using BoxedPolygon = std::pair<geometry::model::box<BoxCorner>, std::size_t>;

/// So many polygons, those next in size, are asked first. Among rings in rings one of them is the answer, while the
/// boxes of all would have to be looked at.
constexpr std::size_t kNeighbours = 16;

/// In the middle of the widest piece of the horizontal line halfway up.
Vec2 point_inside(const Polygon& polygon) {
  // The line crosses the boundary an even number of times, and from an odd crossing to the next it runs inside.
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

/// Finds for each polygon the next larger one around it. Polygons come by falling area, so those around k are before
/// it.
class Nesting {
 public:
  explicit Nesting(const std::vector<Polygon>& polygons) : polygons_(polygons), tree_(boxes_of(polygons)) {}

  /// The smallest of those before k that is around it: around a point inside of it, as those on it may be on both.
  std::optional<std::size_t> around(std::size_t k) const {
    const Vec2 point = point_inside(polygons_[k]);
    // First the few that are next in size, then by a tree of boxes all larger ones whose box holds the point, the
    // smallest first.
    const std::size_t last = k > kNeighbours ? k - kNeighbours : 0;
    for (std::size_t j = k; j-- > last;) {
      if (polygons_[j].contains(point)) return j;
    }
    // The larger numbers are the smaller polygons: the first that holds the point is the next one around.
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
  /// The tree's entries: each polygon's box with its number.
  static std::vector<BoxedPolygon> boxes_of(const std::vector<Polygon>& polygons) {
    std::vector<BoxedPolygon> all;
    for (const Polygon& one : polygons)
      all.push_back({{box_corner(one.box.min()), box_corner(one.box.max())}, all.size()});
    return all;
  }

  const std::vector<Polygon>& polygons_;  // by falling area
  spatial::rtree<BoxedPolygon, spatial::quadratic<16>> tree_;
};

}  // namespace

/// By induction: what is around k is before k, so its depth is known by then.
std::vector<int> nesting_depths(const std::vector<Polygon>& polygons) {
  const Nesting nesting(polygons);
  std::vector<int> depths(polygons.size(), 0);
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    if (const auto outer = nesting.around(k)) depths[k] = depths[*outer] + 1;
  }
  return depths;
}

}  // namespace rollfix::outline
