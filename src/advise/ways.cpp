#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "advise/comparison.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::belief {
namespace {

// Of two fingers: one alone, which is the least to do, both, or one half as far as the other.
constexpr std::array<std::array<double, 2>, 8> kWaysOfTwo = {
    {{1, 0}, {0, 1}, {1, 1}, {1, -1}, {1, 0.5}, {1, -0.5}, {0.5, 1}, {-0.5, 1}}};
// Places along a way, to either side, at which it is looked whether two disks overlap.
constexpr std::size_t kLooks = 64;

/// The lengths over which this finger can roll in every hypothesis that counts.
Interval common_travel(const std::vector<PartHypothesis>& hypotheses, const std::optional<Interval>& wanted,
                       std::size_t finger) {
  const double shortest = shortest_perimeter(hypotheses);
  Interval travel = wanted.value_or(Interval{-shortest, shortest});
  for (const PartHypothesis& one : hypotheses) {
    if (!counts(one, hypotheses.size())) continue;
    const double place = one.hypothesis.place[finger];
    if (!one.part->closed()) {
      travel.lo = std::max(travel.lo, -place);
      travel.hi = std::min(travel.hi, one.part->perimeter() - place);
    }
    const Reach* const reach = one.reach[finger];
    if (reach == nullptr || reach->whole_loop) continue;
    const std::optional<Interval> arc = reach->arc_at(place);
    if (!arc) continue;
    travel.lo = std::max(travel.lo, std::min(0.0, arc->lo - place));
    travel.hi = std::min(travel.hi, std::max(0.0, arc->hi - place));
  }
  return travel;
}

/// A disk's centre in the part's frame.
Vec2 disk_at(const Part& part, double s, double radius) {
  const double tangent = part.turning().angle(s);
  return part.point(s) + radius * Vec2(std::sin(tangent), -std::cos(tangent));
}

bool overlap(const PartHypothesis& one, const PerFinger<double>& disks, const Way& way, double x) {
  const auto centre = [&](std::size_t finger) {
    return disk_at(*one.part, one.hypothesis.place[finger] + x * way.direction[finger], disks[finger]);
  };
  return (centre(0) - centre(1)).norm() < disks[0] + disks[1];
}

/// As far as no hypothesis that counts has one disk in the other. Where they overlap from the start it is not known
/// better.
void stop_at_overlap(const std::vector<PartHypothesis>& hypotheses, const PerFinger<double>& disks, Way& way) {
  for (const PartHypothesis& one : hypotheses) {
    if (!counts(one, hypotheses.size()) || overlap(one, disks, way, 0)) continue;
    for (double* const end : {&way.travel.lo, &way.travel.hi}) {
      const double whole = *end;
      for (std::size_t k = 1; k <= kLooks; ++k) {
        const double x = whole * static_cast<double>(k) / kLooks;
        if (!overlap(one, disks, way, x)) continue;
        *end = whole * static_cast<double>(k - 1) / kLooks;
        break;
      }
    }
  }
}

/// Over which both fingers have travel left.
Interval travel_on(const PerFinger<double>& direction, const std::array<Interval, 2>& each) {
  Interval travel{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const std::size_t finger : {0U, 1U}) {
    if (direction[finger] == 0) continue;
    const double a = each[finger].lo / direction[finger];
    const double b = each[finger].hi / direction[finger];
    travel = {std::max(travel.lo, std::min(a, b)), std::min(travel.hi, std::max(a, b))};
  }
  return travel;
}

}  // namespace

bool counts(const PartHypothesis& one, std::size_t hypotheses) {
  return one.hypothesis.probability >= kHypothesisCounts || hypotheses == 1;
}

std::vector<Way> ways_of(const std::vector<PartHypothesis>& hypotheses, const AdviceOptions& options) {
  if (options.foresees) {
    std::vector<Way> given;
    for (const auto& [direction, travel] : options.ways) given.push_back({direction, travel});
    return given;
  }
  const Interval of_a = common_travel(hypotheses, options.travel, 0);
  if (hypotheses.front().hypothesis.place.size() == 1) return {Way{1.0, of_a}};
  const std::array<Interval, 2> each = {of_a, common_travel(hypotheses, options.travel, 1)};
  std::vector<Way> ways;
  for (const std::array<double, 2>& direction : kWaysOfTwo) {
    Way way{direction, travel_on(direction, each)};
    if (options.disks) stop_at_overlap(hypotheses, *options.disks, way);
    ways.push_back(way);
  }
  return ways;
}

}  // namespace rollfix::belief
