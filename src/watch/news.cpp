// What is worth telling of an answer to somebody who knows the one before.
#include <algorithm>
#include <cmath>

#include "rollfix/tracker.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix {
namespace {

constexpr double kOtherProbability = 0.1;  // below that nobody decides otherwise
constexpr double kTwiceAsSure = 0.5;       // the new standard deviation, as a share of the old one

double distance_on(const Part& part, double a, double b) {
  return part.closed() ? periodic_distance(a, b, part.perimeter()) : std::abs(a - b);
}

/// Of the finger that is farther off.
double distance_on(const Part& part, const PerFinger<double>& a, const PerFinger<double>& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, distance_on(part, a[k], b[k]));
  return most;
}

/// Of several places that were known the one that this is, or is nearest to.
const Mode& nearest_to(const Mode& mode, const std::vector<Mode>& known, const Part& part) {
  return *std::min_element(known.begin(), known.end(), [&](const Mode& a, const Mode& b) {
    return distance_on(part, a.mean, mode.mean) < distance_on(part, b.mean, mode.mean);
  });
}

bool is_news_of_a_place(const Mode& said, const Mode& now, const Part& part) {
  if (std::abs(now.probability - said.probability) > kOtherProbability) return true;
  for (std::size_t k = 0; k < now.mean.size(); ++k) {
    if (distance_on(part, said.mean[k], now.mean[k]) > said.sd[k] || now.sd[k] < kTwiceAsSure * said.sd[k]) return true;
  }
  return false;
}

}  // namespace

bool is_news(const Tracked& said, const Tracked& now, const Part& part) {
  if (now.verdict != said.verdict || now.modes.empty() != said.modes.empty()) return true;
  if (now.modes.empty() || now.verdict.name == Verdict::inconsistent) return false;  // no place that is worth telling
  const Mode& best = now.modes.front();
  return is_news_of_a_place(nearest_to(best, said.modes, part), best, part);
}

}  // namespace rollfix
