#include "rolls.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix::draw {
namespace {

constexpr std::size_t kMostRuns = 3;  // more changes of direction than that are noise or a mess to look at

int lanes_for(const Run& run, const Boundary& boundary) {
  return goes_round(run, boundary) ? 1 + static_cast<int>(std::ceil(run.size() / boundary.perimeter)) : 1;
}

}  // namespace

bool goes_round(const Run& run, const Boundary& boundary) {
  return boundary.closed && run.size() > boundary.perimeter * (1 + 1e-9);
}

Roll roll_of(const std::vector<Reading>& readings, const Boundary& boundary) {
  Roll roll;
  double at = 0;
  for (const Reading& reading : readings) {
    roll.contacts.push_back(reading.length[0]);
    roll.hull.lo = std::min(roll.hull.lo, reading.length[0]);
    roll.hull.hi = std::max(roll.hull.hi, reading.length[0]);
    if (reading.length == at) continue;
    const bool goes_on =
        !roll.runs.empty() && (reading.length[0] > at) == (roll.runs.back().to > roll.runs.back().from);
    if (!goes_on) roll.runs.push_back({at, at, 0});
    roll.runs.back().to = reading.length[0];
    at = reading.length[0];
  }
  roll.tangled = roll.runs.size() > kMostRuns;
  if (roll.tangled) {
    const Interval& hull = roll.hull;
    roll.runs.assign(1, Run{hull.lo, hull.hi, 0});
  }
  roll.lanes = 0;
  for (Run& run : roll.runs) {
    run.lane = roll.lanes;
    roll.lanes += lanes_for(run, boundary);
  }
  roll.lanes = std::max(roll.lanes, 1);
  return roll;
}

namespace {

Interval with_gap(const Interval& stretch, double gap) { return {stretch.lo, stretch.hi + gap}; }

}  // namespace

Lanes assign_lanes(const std::vector<Interval>& stretches, const Boundary& boundary, double gap) {
  Lanes lanes;
  std::vector<std::vector<Interval>> taken;
  for (const Interval& stretch : stretches) {
    const auto is_free = [&](const std::vector<Interval>& lane) {
      return std::none_of(lane.begin(), lane.end(), [&](const Interval& other) {
        return boundary.intersects(with_gap(stretch, gap), with_gap(other, gap));
      });
    };
    auto lane = std::find_if(taken.begin(), taken.end(), is_free);
    if (lane == taken.end()) lane = taken.emplace(taken.end());
    lane->push_back(stretch);
    lanes.of.push_back(static_cast<int>(std::distance(taken.begin(), lane)));
  }
  lanes.count = static_cast<int>(taken.size());
  return lanes;
}

}  // namespace rollfix::draw
