#include "contact/turn_range.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "rollfix/part/period.hpp"

namespace rollfix {

namespace {

constexpr double kCellsPerLap = 256;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Interval hull(const Interval& a, double value) { return {std::min(a.lo, value), std::max(a.hi, value)}; }
Interval hull(const Interval& a, const Interval& b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }

}  // namespace

TurnRange::TurnRange(const Part& part)
    : closed_(part.closed()), perimeter_(part.perimeter()), period_turn_(part.turning().period_turn()) {
  const TurningFunction& turning = part.turning();
  for (const Spiral& spiral : turning.spirals()) {
    const double width = spiral.hi - spiral.lo;
    const auto pieces = static_cast<int>(1 + std::floor(kCellsPerLap * width / perimeter_));
    double angle = spiral.start.angle;
    for (int k = 1; k <= pieces; ++k) {
      const double from = cells_.empty() ? 0 : cells_.back().s.hi;
      const double to = k == pieces ? spiral.hi : spiral.lo + width * k / pieces;
      const double next = k == pieces ? spiral.end.angle : turning.on_spiral(spiral, to).angle;
      cells_.push_back({{from, to}, hull({angle, angle}, next)});  // Theta is monotone on a spiral
      angle = next;
    }
    variation_ += std::abs(spiral.turn());
  }
  for (const Corner& corner : part.corners()) {
    variation_ += std::abs(corner.turn);
    const double before = turning.angle(corner.s, Side::before);
    const double after = turning.angle(corner.s, Side::after);
    for (Cell& cell : cells_) {
      const bool is_seam = closed_ && corner.s <= 0 && cell.s.hi >= perimeter_;
      if (!cell.s.contains(corner.s) && !is_seam) continue;
      const double lap = is_seam ? period_turn_ : 0;
      cell.angle = hull(hull(cell.angle, before + lap), after + lap);
    }
  }
}

/// All of Theta from one place to another; of an open part from and to places on it.
Interval TurnRange::angles(double from, double to) const {
  const Wrapped start = closed_ ? wrap(from, perimeter_) : Wrapped{std::max(from, 0.0), 0};
  auto cell = std::upper_bound(cells_.begin(), cells_.end(), start.base,
                               [](double base, const Cell& candidate) { return base < candidate.s.hi; });
  if (cell == cells_.end()) --cell;
  double lap = start.winding;
  Interval result{kInfinity, -kInfinity};
  do {
    const double shift = lap * period_turn_;
    result = hull(result, Interval{cell->angle.lo + shift, cell->angle.hi + shift});
    if (++cell == cells_.end()) {
      if (!closed_) break;
      cell = cells_.begin();
      lap += 1;
    }
  } while (cell->s.lo + lap * perimeter_ <= to);
  return result;
}

Interval TurnRange::of(const Interval& lengths) const {
  Interval result{kInfinity, -kInfinity};
  for (const Cell& cell : cells_) {
    const double from = cell.s.lo + lengths.lo;
    if (!closed_ && from > perimeter_) break;
    const Interval there = angles(from, cell.s.hi + lengths.hi);
    result = hull(result, Interval{there.lo - cell.angle.hi, there.hi - cell.angle.lo});
  }
  return result;
}

}  // namespace rollfix
