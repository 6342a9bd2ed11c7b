// What fingers can't do, where their lengths are noisy: a roll that they have done is never taken for one that they
// can't.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "noisy_pairs.hpp"
#include "random.hpp"
#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace reach_noise_test {
namespace {

using namespace noisy_pairs;
using rollfix::Answer;
using rollfix::Placement;

bool holds(const Answer& answer, const std::array<double, 2>& start) {
  const auto is_near = [&](const Placement& placement) {
    for (std::size_t finger = 0; finger < answer.finger_count(); ++finger) {
      const double off = answer.part.boundary().distance(placement.start[finger], start[finger]);
      if (off > 0.02 * answer.part.perimeter()) return false;
    }
    return true;
  };
  return std::any_of(answer.placements.begin(), answer.placements.end(), is_near);
}

}  // namespace

TEST(ReachNoise, a_finger_that_rolled_until_it_met_something_did_not_roll_further) {
  const Part part(shapes::polygon({{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}));
  const rollfix::DiskFinger disk{0.3};
  const Noise noise{0.01, 0.002, 0.002, 0};
  std::mt19937_64 generator = test_generator(17);
  std::uniform_real_distribution<double> start(4.3, 5.7);
  for (int round = 0; round < test_count(20); ++round) {
    // Around the corner at 6, up to where it touches the side from 8 on.
    const double s = start(generator);
    rollfix::RollPlan plan;
    plan.start = s;
    plan.distance = 7.7 - s;
    plan.rows = 400;
    const rollfix::Log log = rollfix::noisy_roll(part, disk, plan, noise, generator()).log;
    EXPECT_TRUE(holds(rollfix::solve({part, log, {disk}, noise}), {s})) << "from " << s;
  }
}

TEST(ReachNoise, a_wheel_whose_increments_add_up_to_too_much_did_not_roll_further) {
  const Part part(shapes::polygon({{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}));
  const Noise noise{0.01, 0.002};
  std::mt19937_64 generator = test_generator(19);
  for (int round = 0; round < test_count(20); ++round) {
    // A wheel of radius 1 touches the side from 8 on when it is at 7. Its 2000 rows are off by 0.45 together.
    rollfix::Problem problem{part, {rollfix::noisy_increments(part, 2.7, 4.2, 2000, noise, generator()).log}};
    problem.fingers = {rollfix::disk(1)};
    problem.noise = noise;
    problem.prior = rollfix::Prior{2.7, 0.01};
    EXPECT_TRUE(holds(rollfix::solve(problem), {2.7}));
  }
}

TEST(ReachNoise, fingers_that_passed_each_other_at_a_corner_did_not_overlap) {
  const Part part = free_rolls::part_of("polygon,n=5");
  const Noise noise{0.01, 0.003, 0.003, 0};
  const double side = part.perimeter() / 5;
  std::mt19937_64 generator = test_generator(18);
  std::uniform_real_distribution<double> unit(0, 1);
  int near = 0;
  for (int round = 0; near < test_count(20); ++round) {
    // Finger a comes around a corner, and as near as it can while b pivots, whose contact stays where it is.
    const std::array<double, 2> start{(4.6 + 0.3 * unit(generator)) * side, (0.5 + 0.4 * unit(generator)) * side};
    const double La = (0.4 + 0.8 * unit(generator)) * side;
    const double Lb = (0.5 + 1.5 * unit(generator)) * side;
    rollfix::FreePlan plan = free_rolls::by_distances(0.2, start[0], La, 0.16, start[1], Lb, 0.4);
    plan.rows = 200;
    const rollfix::Roll roll = rollfix::roll_free(part, plan);
    const auto overlap = [&](double a, double b) {
      return rollfix::overlap_of(roll, rollfix::DiskFinger{a}, rollfix::DiskFinger{b}).has_value();
    };
    if (overlap(0.2, 0.16) || !overlap(0.22, 0.18)) continue;
    near += 1;
    const Case drawn = noisy_case(part, start, La, Lb, 200, 0.2, 0.16, noise, generator);
    const Answer answer = rollfix::solve({part, drawn.log, drawn.pair(), noise});
    EXPECT_TRUE(holds(answer, start)) << "from " << start[0] << ", " << start[1] << " by " << La << ", " << Lb;
  }
}

}  // namespace reach_noise_test
