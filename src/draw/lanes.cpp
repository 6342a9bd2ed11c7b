#include "lanes.hpp"

#include <algorithm>

#include "rollfix/part/period.hpp"

namespace rollfix::draw {
namespace {

bool clash(const Interval& a, const Interval& b, double period, double gap) {
  if (period <= 0) return a.lo < b.hi + gap && b.lo < a.hi + gap;
  // Round a circle: they clash where either one's start lies in the other.
  return wrap(b.lo - a.lo, period).base < a.width() + gap || wrap(a.lo - b.lo, period).base < b.width() + gap;
}

}  // namespace

Lanes assign_lanes(const std::vector<Interval>& stretches, double period, double gap) {
  Lanes lanes;
  std::vector<std::vector<Interval>> taken;
  for (const Interval& stretch : stretches) {
    const auto is_free = [&](const std::vector<Interval>& lane) {
      return std::none_of(lane.begin(), lane.end(),
                          [&](const Interval& other) { return clash(stretch, other, period, gap); });
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
