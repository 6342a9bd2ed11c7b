#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rollfix/advise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/solve.hpp"

namespace rollfix {
namespace {

// So many that each counts where all are as probable (kHypothesisCounts, 1 %); of two fingers pairs.
constexpr std::size_t kPlacesBefore = 90;
constexpr std::size_t kPlacesOfEach = 9;

/// A place at which the fingers may be, however they will be there.
Placement at(const Part& part, const PerFinger<double>& s) {
  Placement placement;
  placement.kind = Kind::crossing;
  placement.start = placement.end = s;
  placement.extent = PerFinger<Interval>::of(s.size());
  for (std::size_t k = 0; k < s.size(); ++k) placement.extent[k] = {s[k], s[k]};
  placement.whole_loop = PerFinger<bool>::of(s.size(), false);
  placement.tangent = PerFinger<double>::of(s.size());
  for (std::size_t k = 0; k < s.size(); ++k) placement.tangent[k] = part.tangent(s[k]);
  return placement;
}

std::vector<Placement> places_before(const Part& part, std::size_t fingers) {
  std::vector<Placement> places;
  const std::size_t of_each = fingers == 1 ? kPlacesBefore : kPlacesOfEach;
  const double step = part.perimeter() / static_cast<double>(of_each);
  for (std::size_t i = 0; i < of_each; ++i) {
    const double s = (static_cast<double>(i) + 0.5) * step;
    if (fingers == 1) {
      places.push_back(at(part, s));
      continue;
    }
    // Halfway between the first one's, so that both fingers are nowhere at one place.
    for (std::size_t j = 0; j < of_each; ++j) places.push_back(at(part, {s, static_cast<double>(j) * step}));
  }
  return places;
}

}  // namespace

Answer before_contact(const Part& part, const std::vector<Finger>& fingers, const std::optional<Noise>& noise,
                      bool may_overlap) {
  if (fingers.empty() || fingers.size() > 2) {
    throw InputError(fmt::format("before any contact: expected one finger or two, found {}", fingers.size()));
  }
  for (const Finger& finger : fingers) require_valid(finger);
  Answer answer{part, fingers};
  Reading none;
  none.length = PerFinger<double>::of(fingers.size());
  answer.readings = {none};
  answer.placements = places_before(part, fingers.size());
  if (noise) {
    answer.weighing = Weighing{};
    answer.weighing->noise = *noise;
  }
  if (std::all_of(fingers.begin(), fingers.end(), has_reach)) {
    PerFinger<Reach> reach = PerFinger<Reach>::of(fingers.size());
    for (std::size_t k = 0; k < fingers.size(); ++k) reach[k] = reach_of(part, fingers[k]);
    answer.has_reach = true;
    answer.impossible = drop_unreachable(part, reach, {}, answer.placements, {}, 0, may_overlap);
  }
  answer.verdict = verdict_of(Status::complete, answer.placements);
  return answer;
}

}  // namespace rollfix
