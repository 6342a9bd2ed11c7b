#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "rollfix/locate.hpp"

// Which of several places, poses or parts remain, by their probabilities, and the verdict of that.
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

/// What is said of all that was found by several contacts, the likeliest first; nothing is left undecided.
/// `is_anywhere`: asked of the only one that remains, whether it leaves something open all the way round.
template <class Found, class IsAnywhere>
Verdict verdict_of(const std::vector<Found>& all, const IsAnywhere& is_anywhere, bool fits_badly) {
  if (all.empty()) return {Verdict::inconsistent, 0, 0, fits_badly};
  const std::size_t places = how_many_remain(all, &Found::probability);
  const auto stretches = static_cast<std::size_t>(std::count_if(
      all.begin(), all.begin() + static_cast<std::ptrdiff_t>(places), [](const Found& one) { return one.continuum; }));
  if (places == 1 && is_anywhere(all.front())) return {Verdict::unobservable, 0, 0, fits_badly};
  if (places == 1 && stretches == 0) return {Verdict::unique, 0, 0, fits_badly};
  return {Verdict::ambiguous, places, stretches, fits_badly};
}

/// That verdict in words. Its own text has the contradiction in words of one roll: here it is said of these, "touches".
inline std::string text_of_verdict(Verdict verdict, const std::string& contacts) {
  const bool is_said = verdict.fits_badly && verdict.name != Verdict::inconsistent;
  verdict.fits_badly = false;
  return verdict.text() + (is_said ? ", but the " + contacts + " contradict the stated noise" : "");
}

}  // namespace rollfix
