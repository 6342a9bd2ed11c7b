#include "pieces.hpp"

#include <algorithm>
#include <cmath>

#include "corner_sets.hpp"
#include "part/turning_range.hpp"

namespace rollfix {
namespace {

// Or by as little as this many pieces allow.
constexpr int kMostPieces = 400;

double family_step(const Placement& placement, std::size_t k) {
  const PerFinger<double>& from = placement.family[k - 1];
  const PerFinger<double>& to = placement.family[k];
  return std::max(std::abs(to[0] - from[0]), std::abs(to[1] - from[1]));
}

PerFinger<Interval> piece(const Placement& placement, std::size_t k, int i, int count) {
  PerFinger<Interval> box = placement.extent;
  for (std::size_t f = 0; f < 2; ++f) {
    const double from = placement.family[k - 1][f];
    const double step = (placement.family[k][f] - from) / count;
    const double one = from + i * step;
    const double two = one + step;
    box[f] = {std::min(one, two) - placement.family_error, std::max(one, two) + placement.family_error};
  }
  return box;
}

}  // namespace

Interval tangents_over(const Part& part, const Interval& contacts) {
  Interval angles = angles_over(part.turning(), contacts);
  for (const double end : {contacts.lo, contacts.hi}) {
    const Interval there = angle_set(part, end).angles;
    angles = {std::min(angles.lo, there.lo), std::max(angles.hi, there.hi)};
  }
  return angles;
}

std::vector<PerFinger<Interval>> pieces_of(const Placement& placement, double step) {
  if (placement.kind != Kind::stretch || placement.family.size() < 2) return {placement.extent};
  std::vector<PerFinger<Interval>> boxes;
  double length = 0;
  for (std::size_t k = 1; k < placement.family.size(); ++k) length += family_step(placement, k);
  step = std::max(step, length / kMostPieces);
  for (std::size_t k = 1; k < placement.family.size(); ++k) {
    const int count = 1 + static_cast<int>(family_step(placement, k) / step);
    for (int i = 0; i < count; ++i) boxes.push_back(piece(placement, k, i, count));
  }
  return boxes;
}

}  // namespace rollfix
