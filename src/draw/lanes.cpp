#include "lanes.hpp"

#include <algorithm>

namespace rollfix::draw {
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
