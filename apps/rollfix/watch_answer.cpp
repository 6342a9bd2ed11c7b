#include "rollfix/watch_answer.hpp"

#include <algorithm>
#include <cmath>

#include "rollfix/part/period.hpp"

namespace rollfix::app {
namespace {

constexpr double kOtherProbability = 0.1;  // below that nobody decides otherwise
constexpr double kTwiceAsSure = 0.5;       // the new standard deviation, as a share of the old one

double distance_on(const Part& part, double a, double b) {
  return part.closed() ? periodic_distance(a, b, part.perimeter()) : std::abs(a - b);
}

/// Of several places that were known the one that this is, or is nearest to.
const Mode& nearest_to(const Mode& mode, const std::vector<Mode>& known, const Part& part) {
  return *std::min_element(known.begin(), known.end(), [&](const Mode& a, const Mode& b) {
    return distance_on(part, a.mean, mode.mean) < distance_on(part, b.mean, mode.mean);
  });
}

bool is_news_of_a_place(const Mode& said, const Mode& now, const Part& part) {
  return distance_on(part, said.mean, now.mean) > said.sd || now.sd < kTwiceAsSure * said.sd ||
         std::abs(now.probability - said.probability) > kOtherProbability;
}

}  // namespace

bool is_news(const WatchAnswer& said, const WatchAnswer& now, const Part& part) {
  if (now.verdict != said.verdict || now.modes.empty() != said.modes.empty()) return true;
  if (now.modes.empty() || now.verdict == kInconsistent) return false;  // no place that is worth telling
  const Mode& best = now.modes.front();
  return is_news_of_a_place(nearest_to(best, said.modes, part), best, part);
}

}  // namespace rollfix::app
