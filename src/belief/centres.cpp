#include "belief/centres.hpp"

#include <algorithm>
#include <cmath>

#include "outline/turn.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::belief {

namespace {

// A cell of the path is no longer than this share of the perimeter, and turns by no more than this, radians: a cubic is
// then within 2e-8 of the radius of curvature.
constexpr double kLongestCell = 1.0 / 1024;
constexpr double kMostTurnOfCell = 0.05;

}  // namespace

BoundaryPath::BoundaryPath(const Part& part) : closed_(part.closed()), perimeter_(part.perimeter()) {
  const TurningFunction& turning = part.turning();
  std::vector<double> starts;
  for (const Spiral& spiral : turning.spirals()) {
    const double length = spiral.hi - spiral.lo;
    const double pieces = std::max({1.0, std::ceil(length / (kLongestCell * perimeter_)),
                                    std::ceil(std::abs(spiral.end.angle - spiral.start.angle) / kMostTurnOfCell)});
    const auto direction = [&](double s) {
      const double angle = turning.on_spiral(spiral, s).angle;
      return Vec2(std::cos(angle), std::sin(angle));
    };
    for (double k = 0; k < pieces; ++k) {
      const double lo = spiral.lo + length * k / pieces;
      const double hi = k + 1 < pieces ? spiral.lo + length * (k + 1) / pieces : spiral.hi;
      if (!(hi > lo)) continue;
      const Vec2 from = cells_.empty() ? part.point(lo) : cells_.back().to;
      cells_.push_back({lo, hi - lo, from, part.point(hi), (hi - lo) * direction(lo), (hi - lo) * direction(hi)});
      starts.push_back(lo);
    }
  }
  buckets_ = Buckets(starts, perimeter_);
}

Vec2 BoundaryPath::at(double s) const {
  const double place = closed_ ? wrap(s, perimeter_).base : std::clamp(s, 0.0, perimeter_);
  std::size_t k = buckets_.before(place);
  while (k + 1 < cells_.size() && cells_[k + 1].s <= place) ++k;
  const Cell& cell = cells_[k];
  const double x = (place - cell.s) / cell.length;
  // Hermite's.
  const Vec2 rise = cell.to - cell.from;
  const Vec2 b = 3 * rise - 2 * cell.by_from - cell.by_to;
  const Vec2 c = cell.by_from + cell.by_to - 2 * rise;
  Vec2 on_path = cell.from + x * (cell.by_from + x * (b + x * c));
  if (closed_ || place == s) return on_path;
  const Vec2& along = s < 0 ? cell.by_from : cell.by_to;
  return on_path + (s - place) / cell.length * along;
}

}  // namespace rollfix::belief
