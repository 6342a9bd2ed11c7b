#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "rollfix/locate.hpp"

// Which of several places, poses or parts remain, by their probabilities.
namespace rollfix {

/// What has less than this is not listed ...
inline constexpr double kLeastListed = 1e-4;

/// ... unless the likeliest itself has so little that this share of it, kLeastProbability, is less.
inline bool is_listed(double probability, double likeliest) {
  return probability > 0 && probability >= std::min(kLeastListed, kLeastProbability * likeliest);
}

/// What has less than this does not count: kLeastProbability. Where those that have more are not sure together, half of
/// what the last one has that makes them sure: a hundred and twenty places that are all alike remain, though each of
/// them is improbable. `all`: the likeliest first.
template <class All, class ProbabilityOf = std::identity>
double least_that_counts(const All& all, const ProbabilityOf& probability_of = {}) {
  // The shortest run of the likeliest that is sure together: if its last member is improbable, that sets the limit.
  double sum = 0;
  for (const auto& each : all) sum += std::invoke(probability_of, each);
  double together = 0;
  for (const auto& each : all) {
    const double probability = std::invoke(probability_of, each);
    together += probability;
    if (together < kSureProbability * sum) continue;
    return probability >= kLeastProbability ? kLeastProbability : 0.5 * probability;
  }
  return kLeastProbability;
}

/// How many remain of them, the likeliest first: that one where it is sure, else those that count. Without noise, where
/// probabilities are NaN, all.
template <class All, class ProbabilityOf = std::identity>
std::size_t how_many_remain(const All& all, const ProbabilityOf& probability_of = {}) {
  if (std::size(all) <= 1) return std::size(all);
  const double likeliest = std::invoke(probability_of, *std::begin(all));
  if (std::isnan(likeliest)) return std::size(all);
  if (likeliest >= kSureProbability) return 1;
  const double least = least_that_counts(all, probability_of);
  return static_cast<std::size_t>(std::count_if(
      std::begin(all), std::end(all), [&](const auto& each) { return std::invoke(probability_of, each) >= least; }));
}

}  // namespace rollfix
