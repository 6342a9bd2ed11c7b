#include "outline/joining.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace rollfix {

namespace {

using Quadrature = boost::math::quadrature::gauss_kronrod<double, 15>;

constexpr double kQuadratureTolerance = 1e-12;  // relative
constexpr unsigned kMostHalvings = 12;
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

bool is_line(const Curve& curve) {
  const auto record = curve.record();
  return record && record->kind == "line";
}

}  // namespace

CurveMeasure measure(const Curve& curve) {
  const Interval domain = curve.domain();
  CurveMeasure result;
  result.front = result.origin = curve.front();
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
  if (straight) {
    result.length = (result.back - result.front).norm();
    return result;
  }
  result.length = integral([&](double u) { return curve.velocity(u).norm(); }, domain);
  // The area of a nearly straight curve is next to nothing, and no quadrature gets it to a share of itself: with the
  // length added, the tolerance is a share of length^2. A short curve far from (0, 0) has an area of few digits: asked
  // for more, the quadrature would halve to the end.
  const double rounding = kPlaceRounding * result.box.max().cwiseMax(-result.box.min()).maxCoeff() / result.length;
  const double with_length = integral(
      [&](double u) {
        const Jet jet = curve.jet(u);
        return cross(jet.position - result.origin, jet.first) + result.length * jet.first.norm();
      },
      domain, std::max(kQuadratureTolerance, rounding));
  result.twice_area = with_length - result.length * result.length;
  return result;
}

bool Polygon::contains(const Vec2& point) const {
  if (!box.contains(point)) return false;
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

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// Disjoint sets with path halving.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }

  std::size_t root(std::size_t one) {
    while (parent_[one] != one) one = parent_[one] = parent_[parent_[one]];
    return one;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t first = std::min(root(a), root(b));
    parent_[std::max(root(a), root(b))] = first;
  }

 private:
  std::vector<std::size_t> parent_;
};

/// A square of the grid. Its diagonal is just below the gap: all points in one square are one cluster.
struct Square {
  std::int64_t column = 0;
  std::int64_t row = 0;
  bool operator==(const Square& other) const { return column == other.column && row == other.row; }
};

struct SquareHash {
  std::size_t operator()(const Square& square) const {
    const std::uint64_t mixed =
        static_cast<std::uint64_t>(square.column) * 0x9E3779B97F4A7C15U ^ static_cast<std::uint64_t>(square.row);
    return std::hash<std::uint64_t>()(mixed);
  }
};

}  // namespace

EndClusters::EndClusters(const std::vector<Vec2>& points, double gap) : cluster_(points.size(), kNone) {
  Sets sets(points.size());
  std::unordered_map<Square, std::vector<std::size_t>, SquareHash> grid;
  const double side = 0.7 * gap;
  Vec2 corner = points.empty() ? Vec2(0, 0) : points.front();
  for (const Vec2& point : points) corner = corner.cwiseMin(point);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Square own{static_cast<std::int64_t>((points[k].x() - corner.x()) / side),
                     static_cast<std::int64_t>((points[k].y() - corner.y()) / side)};
    // Two squares to each side are near enough to hold a point within the gap.
    for (std::int64_t column = own.column - 2; column <= own.column + 2; ++column) {
      for (std::int64_t row = own.row - 2; row <= own.row + 2; ++row) {
        const auto found = grid.find({column, row});
        if (found == grid.end() || sets.root(found->second.front()) == sets.root(k)) continue;
        const auto near = [&](std::size_t other) { return (points[other] - points[k]).norm() <= gap; };
        const auto link = std::find_if(found->second.begin(), found->second.end(), near);
        if (link != found->second.end()) sets.join(*link, k);
      }
    }
    grid[own].push_back(k);
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t root = sets.root(k);  // never above k: it has its number by now
    if (root == k) {
      cluster_[k] = members_.size();
      members_.emplace_back();
    } else {
      cluster_[k] = cluster_[root];
    }
    members_[cluster_[k]].push_back(k);
  }
}

}  // namespace rollfix
