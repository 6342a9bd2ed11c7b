// Two fingers that pivot at sharp corners: a finger's centre goes around the corner, and how far is not known.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <string>

#include "corner_fingers.hpp"
#include "random.hpp"
#include "rollfix/files.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace pair_corner_centres_test {
namespace {

using rollfix::Part;
using rollfix::Problem;

constexpr rollfix::Noise kNoise{.contact = 0.003, .angle = 0.004, .position = 0.003};

struct Drawn {
  Problem problem;
  rollfix::PerFinger<double> start;
};

/// Both fingers roll a fifth to a third of the way around, from opposite places.
Drawn drawn_on(const Part& part, std::uint64_t seed, std::size_t rows, const rollfix::Noise& noise = kNoise,
               const std::optional<rollfix::Finger>& tip = {}) {
  std::mt19937_64 generator = test_generator(seed);
  const auto uniform = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(generator); };
  const double perimeter = part.perimeter();
  rollfix::FreePlan plan;
  plan.rows = rows;
  plan.part_rotation = 0.5;
  for (rollfix::FreeFinger& finger : plan.fingers) {
    finger.finger = rollfix::disk(uniform(0.02, 0.06) * perimeter);
    finger.start = uniform(0, perimeter);
    finger.distance = uniform(0.2, 0.35) * perimeter;
  }
  plan.fingers[1].start = plan.fingers[0].start + 0.45 * perimeter;
  if (tip) {
    plan.fingers[1].finger = *tip;
    plan.fingers[1].u = 0;
  }
  const rollfix::NoisyRoll roll = rollfix::noisy_roll_free(part, plan, noise, seed);
  return {{part, roll.log, {plan.fingers[0].finger, plan.fingers[1].finger}, noise},
          {roll.truth.s[0].front(), roll.truth.s[1].front()}};
}

/// Of the answer to honest rows: that it has the true pair, and does not say that the rows contradict the noise.
testing::AssertionResult is_honest(const Drawn& drawn) {
  const rollfix::Answer answer = rollfix::solve(drawn.problem);
  const Part& part = drawn.problem.part;
  const double near = 0.02 * part.perimeter();
  const bool is_listed =
      std::any_of(answer.placements.begin(), answer.placements.end(), [&](const rollfix::Placement& found) {
        return part.distance(found.start[0], drawn.start[0]) < near &&
               part.distance(found.start[1], drawn.start[1]) < near;
      });
  if (is_listed && !answer.verdict.fits_badly) return testing::AssertionSuccess();
  return testing::AssertionFailure() << answer.verdict.text();
}

}  // namespace

TEST(PairCornerCentres, of_honest_rows_contradict_nothing) {
  for (const std::string name : {"gallery:polygon,n=5", "gallery:reuleaux", "gallery:polygon,n=3"}) {
    const Part part = rollfix::load_part(name);
    for (int k = 0; k < test_count(2); ++k) {
      const Drawn drawn = drawn_on(part, static_cast<std::uint64_t>(k) + 1, k % 2 == 0 ? 24 : 150);
      EXPECT_TRUE(is_honest(drawn)) << name << ", seed " << k + 1;
    }
  }
}

/// Where a contact is felt on the disk turns its normal: more than orientations are off.
TEST(PairCornerCentres, of_a_disk_and_a_square_fingertip_contradict_nothing) {
  const Part part = rollfix::load_part("gallery:ellipse");
  const double P = part.perimeter();
  const rollfix::Noise noise{.contact = 0.001 * P, .angle = 0.001, .position = 0.0005 * P};
  for (int k = 0; k < test_count(30); ++k) {
    const auto seed = static_cast<std::uint64_t>(k) + 1;
    EXPECT_TRUE(is_honest(drawn_on(part, seed, 60, noise, corner_fingers::square(0.04 * P).finger()))) << seed;
  }
}

TEST(PairCornerCentres, with_a_wrong_radius_still_make_an_answer) {
  for (const double times : {2.0, 10.0}) {
    Drawn drawn = drawn_on(rollfix::load_part("gallery:reuleaux"), 3, 24);
    drawn.problem.fingers[0] = rollfix::disk(times / drawn.problem.fingers[0].curvature(0));
    const rollfix::Answer answer = rollfix::solve(drawn.problem);
    EXPECT_TRUE(answer.placements.empty() || answer.verdict.fits_badly) << times;
  }
}

}  // namespace pair_corner_centres_test
