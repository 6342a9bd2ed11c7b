#include <algorithm>
#include <cmath>

#include "part_data.hpp"

namespace rollfix {
namespace {

// A spiral that turns (for vertices: differs from an arc) by less than this is rounding noise, such as that of a
// spline through points on a straight edge. It stays a spiral, but is no event.
constexpr double kNoiseTurn = 1e-11;
// Curvatures at a joint that differ by less, relative to the larger, are one.
constexpr double kSameCurvature = 1e-7;

int sign_of(double value) { return value > 0 ? 1 : (value < 0 ? -1 : 0); }

int bend_of(const Spiral& spiral) { return std::abs(spiral.turn()) <= kNoiseTurn ? 0 : sign_of(spiral.turn()); }

int trend_of(const Spiral& spiral) {
  const double change = std::abs(spiral.end.curvature - spiral.start.curvature) * (spiral.hi - spiral.lo);
  return change <= kNoiseTurn ? 0 : spiral.trend;
}

/// Where `sign` changes, zeros passed over. `breaks(k)`: start afresh at the start of spiral k.
template <class Sign, class Breaks>
std::vector<double> changes(const TurningFunction& turning, Sign sign, Breaks breaks) {
  const std::vector<Spiral>& spirals = turning.spirals();
  std::vector<double> found;
  int last = 0;
  double last_end = 0;
  const int laps = turning.closed() ? 2 : 1;  // the first lap only finds what comes before s = 0
  for (int lap = 0; lap < laps; ++lap) {
    if (lap > 0) last_end -= turning.perimeter();
    for (std::size_t k = 0; k < spirals.size(); ++k) {
      if (breaks(k)) last = 0;
      const int now = sign(spirals[k]);
      if (now == 0) continue;
      if (last != 0 && now != last && lap + 1 == laps) {
        const double place = 0.5 * (last_end + spirals[k].lo);
        found.push_back(turning.boundary().base(place));
      }
      last = now;
      last_end = spirals[k].hi;
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::vector<double> find_inflections(const TurningFunction& turning) {
  return changes(turning, bend_of, [](std::size_t) { return false; });
}

std::vector<double> find_vertices(const TurningFunction& turning, const std::vector<Corner>& corners) {
  const std::vector<Spiral>& spirals = turning.spirals();
  const auto jumps = [&](std::size_t k) {
    const double s = spirals[k].lo;
    if (std::any_of(corners.begin(), corners.end(), [&](const Corner& corner) { return corner.s == s; })) return true;
    const double before = spirals[k > 0 ? k - 1 : spirals.size() - 1].end.curvature;
    const double after = spirals[k].start.curvature;
    return std::abs(before - after) > kSameCurvature * std::max(std::abs(before), std::abs(after)) &&
           std::abs(before - after) > kSameCurvature / turning.perimeter();
  };
  std::vector<char> starts_afresh(spirals.size());
  for (std::size_t k = 0; k < spirals.size(); ++k) starts_afresh[k] = jumps(k) ? 1 : 0;
  return changes(turning, trend_of, [&](std::size_t k) { return starts_afresh[k] != 0; });
}

}  // namespace rollfix
