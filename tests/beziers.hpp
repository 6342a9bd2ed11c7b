#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "rollfix/outline.hpp"

namespace beziers {

using rollfix::Vec2;

/// sum of w_k B_k(u) P_k over sum of w_k B_k(u), with binomials.
inline Vec2 bernstein(const std::vector<Vec2>& points, const std::vector<double>& weights, double u) {
  const auto degree = static_cast<int>(points.size()) - 1;
  Vec2 sum = Vec2::Zero();
  double total = 0, binomial = 1;
  for (int k = 0; k <= degree; ++k) {
    const double weight = weights.empty() ? 1 : weights[static_cast<std::size_t>(k)];
    const double factor = weight * binomial * std::pow(u, k) * std::pow(1 - u, degree - k);
    sum += factor * points[static_cast<std::size_t>(k)];
    total += factor;
    binomial *= static_cast<double>(degree - k) / (k + 1);
  }
  return sum / total;
}

/// Points that turn a little at a time, so that no curve of theirs has a cusp.
inline std::vector<Vec2> bow(int count) {
  std::vector<Vec2> points;
  for (int k = 0; k < count; ++k) points.emplace_back(3 * std::cos(0.4 * k), 2 * std::sin(0.4 * k));
  return points;
}

inline rollfix::Outline open_outline(std::vector<rollfix::Curve> curves) { return {"test", std::move(curves), false}; }

}  // namespace beziers
