// Locate, advise, roll, locate: does the loop close?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "belief_cases.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/error.hpp"

namespace advice_loop_test {
namespace {

using namespace belief_cases;
using rollfix::Advice;
using rollfix::AdviceOptions;

class AdviceLoop : public testing::TestWithParam<const char*> {};

}  // namespace

TEST_P(AdviceLoop, a_few_short_advised_rolls_leave_one_place) {
  constexpr int kMostRolls = 6;
  constexpr double kMostTravel = 0.1;  // of the perimeter, on average
  const Part part = part_of(GetParam());
  const double P = part.perimeter();
  const double radius = 0.01 * P;
  const rollfix::Reach reach = rollfix::reach_of_disk(part, radius);
  BeliefOptions options;
  options.noise = noise_on(part, 1e-4, 2e-3, 2e-3);
  std::mt19937_64 random = test_generator();
  std::uniform_real_distribution<double> unit;
  const int count = test_count(25);
  int resolved = 0;
  double travel = 0;
  for (int k = 0; k < count; ++k) {
    const double start = part.closed() ? unit(random) * P : (0.1 + 0.8 * unit(random)) * P;
    const std::uint64_t seed = random();
    double length = (unit(random) < 0.5 ? -1 : 1) * 0.05 * P;
    Robot robot(part, radius, start, options.noise, seed);
    Belief belief(part, rollfix::LogKind::contact, options);
    for (int rolls = 0;; ++rolls) {
      robot.roll(length, belief);
      if (belief.verdict().name == rollfix::Verdict::unique) {
        const Mode& mode = belief.modes().front();
        resolved += distance(part, mode.start[0], start) < 5 * mode.sd[0] + 1e-6 * P ? 1 : 0;
        break;
      }
      if (rolls == kMostRolls) break;
      AdviceOptions how;
      how.turn_sd = std::numbers::sqrt2 * options.noise.angle;
      how.length_sd = std::numbers::sqrt2 * options.noise.contact;
      how.length_share_sd = options.noise.slip;
      how.reach = &reach;
      const Advice advice = advise(part, rollfix::hypotheses_of(part, belief.modes()), how);
      if (!advice.helps) break;
      length = advice.advised().length;
      travel += std::abs(length) / P;
    }
  }
  EXPECT_LT(travel, kMostTravel * count);
  EXPECT_GE(resolved, 0.95 * count) << "of " << count;
}

INSTANTIATE_TEST_SUITE_P(Gallery, AdviceLoop,
                         testing::Values("limacon", "spline", "cam", "naca", "log-spiral", "exponential",
                                         "spline,seed=3", "spline,n=12,seed=5"));

}  // namespace advice_loop_test
