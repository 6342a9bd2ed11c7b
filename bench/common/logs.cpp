#include "logs.hpp"

#include <algorithm>
#include <random>

#include "rollfix/error.hpp"
#include "rollfix/inspect.hpp"
#include "rollfix/rolling.hpp"

namespace bench {
namespace {

constexpr double kRadiusShare = 0.03;  // of the finger, by the perimeter; less where it has to fit into a concavity

}  // namespace

rollfix::Noise log_noise(const rollfix::Part& part) {
  return {kLogContactShare * part.perimeter(), kLogAngle, kLogSlip, 0};
}

double log_radius(const rollfix::Part& part) {
  // A concave corner takes no disk at all: there it is a small one that stays out of it.
  const double fits = rollfix::largest_disk(part);
  return std::min(kRadiusShare * part.perimeter(), fits > 0 ? 0.5 * fits : 0.2 * kRadiusShare * part.perimeter());
}

std::vector<NoisyLog> noisy_logs(const rollfix::Part& part, std::size_t count) {
  const double P = part.perimeter();
  const rollfix::DiskFinger finger{log_radius(part)};
  std::mt19937_64 random(20010529);
  std::uniform_real_distribution<double> unit;
  std::vector<NoisyLog> logs;
  while (logs.size() < count) {
    rollfix::RollPlan plan;
    plan.start = unit(random) * P;
    plan.distance = (unit(random) < 0.5 ? -1 : 1) * (0.1 + 0.3 * unit(random)) * P;
    plan.rows = kLogRows;
    NoisyLog drawn{{}, plan.start, random()};
    if (!part.closed() && !(plan.start + *plan.distance > 0 && plan.start + *plan.distance < P)) continue;
    try {
      const rollfix::NoisyRoll roll = rollfix::noisy_roll(part, finger, plan, log_noise(part), drawn.seed);
      for (const rollfix::Reading& reading : rollfix::readings_as_given(roll.log, {finger})) {
        drawn.samples.emplace_back();
        drawn.samples.back().reading = reading;
        drawn.samples.back().finger_curvature = 1 / finger.radius;
      }
    } catch (const rollfix::InputError&) {
      continue;  // the finger does not get along there
    }
    logs.push_back(std::move(drawn));
  }
  return logs;
}

}  // namespace bench
