// Two fingers of different shapes on a part that is free to move: what is simulated is found again.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::mixed_fingers_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A jaw, a disk, two ellipses: of sizes that go with the part's.
std::vector<Finger> fingers_for(const Part& part) {
  const double size = part.perimeter() / 20;
  const auto ellipse = [&](double a, double b) {
    return Finger::outlined(gallery(fmt::format("ellipse,a={},b={}", a * size, b * size)));
  };
  return {jaw(), disk(size), ellipse(1.0, 0.6), ellipse(1.4, 1.1)};
}

struct Case {
  Part part;
  std::vector<Finger> fingers;
  FreePlan plan;
};

/// Random starts and lengths of one of the pairs of fingers.
Case random_case(const std::string& shape, int pair, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> share(0, 1);
  Case one{Part(gallery(shape)), {}, {}};
  const std::vector<Finger> all = fingers_for(one.part);
  const std::vector<std::pair<int, int>> pairs{{0, 1}, {0, 0}, {2, 1}, {2, 3}, {0, 2}, {1, 0}};
  const auto [a, b] = pairs[static_cast<std::size_t>(pair) % pairs.size()];
  one.fingers = {all[static_cast<std::size_t>(a)], all[static_cast<std::size_t>(b)]};
  for (const std::size_t k : {0U, 1U}) {
    FreeFinger& finger = one.plan.fingers[k];
    finger.finger = one.fingers[k];
    finger.start = one.part.perimeter() * share(generator);
    finger.distance = one.part.perimeter() * (0.1 + 0.2 * share(generator)) * (share(generator) < 0.5 ? -1 : 1);
    finger.psi = 6 * share(generator);
    if (!finger.finger.is_disk()) finger.u = one.part.perimeter() * 0.1 * share(generator);
  }
  one.plan.part_rotation = 2 * share(generator) - 1;
  one.plan.rows = 41;
  return one;
}

bool holds_truth(const Case& one, const Answer& answer, double near) {
  const Boundary boundary = one.part.boundary();
  const auto is_true = [&](const Placement& placement) {
    return boundary.contains(placement.extent[0], one.plan.fingers[0].start, near) &&
           boundary.contains(placement.extent[1], one.plan.fingers[1].start, near);
  };
  return std::any_of(answer.placements.begin(), answer.placements.end(), is_true);
}

Answer answer_of(const Case& one, const Log& log, const std::optional<Noise>& noise) {
  Problem problem{one.part, log, one.fingers, noise};
  problem.may_overlap = true;
  return solve(problem);
}

}  // namespace

TEST(MixedFingers, on_a_part_that_moves_are_found_where_they_started) {
  std::mt19937_64 generator = test_generator(821);
  int rolled = 0;
  for (const char* shape : {"ellipse", "cam", "superellipse", "reuleaux"}) {
    for (int pair = 0; pair < test_count(6); ++pair) {
      const Case one = random_case(shape, pair, generator);
      const double near = 1e-6 * one.part.perimeter();
      Roll roll;
      try {
        roll = roll_free(one.part, one.plan);
      } catch (const InputError&) {
        continue;  // a jaw over a concavity
      }
      ++rolled;
      EXPECT_TRUE(holds_truth(one, answer_of(one, roll.log, {}), near))
          << shape << " " << one.fingers[0].name() << " " << one.fingers[1].name() << ", seed " << test_seed();
    }
  }
  EXPECT_GT(rolled, 12);
}

TEST(MixedFingers, with_noise_are_found_near_where_they_started) {
  std::mt19937_64 generator = test_generator(822);
  for (int pair = 0; pair < test_count(6); ++pair) {
    const Case one = random_case("cam", pair, generator);
    const double size = one.part.perimeter();
    const Noise noise{.contact = 2e-4 * size, .angle = 0.002, .slip = 0.002};
    const NoisyRoll roll = noisy_roll_free(one.part, one.plan, noise, 7 + static_cast<std::uint64_t>(pair));
    EXPECT_TRUE(holds_truth(one, answer_of(one, roll.log, noise), 0.02 * size))
        << one.fingers[0].name() << " " << one.fingers[1].name() << ", seed " << test_seed();
  }
}

TEST(MixedFingers, take_a_noise_of_the_radius_where_one_is_a_disk) {
  std::mt19937_64 generator = test_generator(823);
  const Noise noise{.radius = 0.01};
  const Case of_disk = random_case("cam", 0, generator);
  const NoisyRoll roll = noisy_roll_free(of_disk.part, of_disk.plan, noise, 3);
  EXPECT_EQ(roll.error[0].radius, 0);
  EXPECT_NE(roll.error[1].radius, 0);
  const Case of_jaws = random_case("cam", 1, generator);
  EXPECT_THAT(refusal_of([&] { noisy_roll_free(of_jaws.part, of_jaws.plan, noise, 3); }),
              HasSubstr("expected a disk for a noise of the radius"));
}

TEST(MixedFingers, say_which_of_them_can_not_roll_so) {
  Case one{Part(gallery("stadium")), {jaw(), disk(0.2)}, {}};
  one.plan.fingers = {FreeFinger{jaw(), 0.2, 0, 0.5}, FreeFinger{disk(0.2), 4, 0, 0.5}};
  EXPECT_THAT(refusal_of([&] { roll_free(one.part, one.plan); }),
              AllOf(HasSubstr("finger a: "), HasSubstr("a flat jaw can't roll")));
}

TEST(MixedFingers, leave_out_a_disk_that_is_beyond_the_jaws_line_and_keep_one_that_is_not) {
  const Part part(gallery("cam"));
  std::mt19937_64 generator = test_generator(824);
  std::uniform_real_distribution<double> share(0, 1);
  int beyond = 0;
  int apart = 0;
  for (int round = 0; round < test_count(12); ++round) {
    Case one{part, {jaw(), disk(0.1 + 0.8 * share(generator))}, {}};
    if (round % 2 == 1) std::swap(one.fingers[0], one.fingers[1]);
    for (const std::size_t k : {0U, 1U}) {
      one.plan.fingers[k] = {one.fingers[k], part.perimeter() * share(generator), 0, k == 0 ? 0.7 : -0.4};
    }
    const Roll roll = roll_free(part, one.plan);
    const auto overlap = overlap_of(roll, one.fingers[0], one.fingers[1]);
    if (overlap && overlap->depth < 1e-3) continue;
    (overlap ? beyond : apart) += 1;
    EXPECT_EQ(holds_truth(one, solve(Problem{part, roll.log, one.fingers}), 1e-6), !overlap) << "seed " << test_seed();
    EXPECT_TRUE(holds_truth(one, answer_of(one, roll.log, {}), 1e-6));
  }
  EXPECT_GT(beyond, 2);
  EXPECT_GT(apart, 2);
}

TEST(MixedFingers, leave_out_outlines_that_are_in_one_another_and_keep_those_that_are_not) {
  std::mt19937_64 generator = test_generator(825);
  std::uniform_real_distribution<double> share(0, 1);
  const Part part(gallery("cam"));
  const Finger flat = Finger::outlined(gallery("ellipse,a=0.7,b=0.3"));
  const Finger round = Finger::outlined(gallery("ellipse,a=0.6,b=0.5"));
  const std::vector<std::pair<Finger, Finger>> pairs{
      {flat, round}, {flat, disk(0.4)}, {disk(0.4), flat}, {jaw(), flat}};
  int inside = 0;
  int apart = 0;
  for (int round_number = 0; round_number < test_count(24); ++round_number) {
    const auto& [a, b] = pairs[static_cast<std::size_t>(round_number) % pairs.size()];
    Case one{part, {a, b}, {}};
    for (const std::size_t k : {0U, 1U}) {
      const double start = part.perimeter() * share(generator);
      one.plan.fingers[k] = {one.fingers[k], start, 0, k == 0 ? 0.5 : -0.3};
      if (!one.fingers[k].is_disk()) one.plan.fingers[k].u = 1 + share(generator);
    }
    one.plan.rows = 41;
    const Roll roll = roll_free(part, one.plan);
    const auto overlap = overlap_of(roll, a, b);
    if (overlap && overlap->depth < 1e-3) continue;
    (overlap ? inside : apart) += 1;
    EXPECT_EQ(holds_truth(one, solve(Problem{part, roll.log, one.fingers}), 1e-6), !overlap)
        << a.name() << " " << b.name() << ", seed " << test_seed() << " round " << round_number;
    EXPECT_TRUE(holds_truth(one, answer_of(one, roll.log, {}), 1e-6));
  }
  EXPECT_GT(inside, 5);
  EXPECT_GT(apart, 5);
}

// On arcs whose centres are corners both fingers roll alike from a line of pairs.
TEST(MixedFingers, a_continuum_of_pairs_is_not_contradicted_by_the_pair_that_is_listed) {
  Case one{Part(gallery("reuleaux")), {jaw(), disk(0.12)}, {}};
  const double P = one.part.perimeter();
  one.plan.fingers[0] = {one.fingers[0], 0.1 * P, 0, 0.2 * P};
  one.plan.fingers[1] = {one.fingers[1], 0.6 * P, 0, -0.15 * P};
  const Answer answer = answer_of(one, roll_free(one.part, one.plan).log, std::nullopt);
  EXPECT_EQ(answer.placements.front().kind, Kind::stretch);
  EXPECT_TRUE(holds_truth(one, answer, 1e-9));
  EXPECT_FALSE(answer.verdict.fits_badly);
}

}  // namespace rollfix::mixed_fingers_test
