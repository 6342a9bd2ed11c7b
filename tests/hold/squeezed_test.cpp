// A jaw and a wheel that squeeze a part, with noise: how far the direction of the force is off may last.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "random.hpp"
#include "rollfix/files.hpp"
#include "witness/squeezed_cases.hpp"

namespace squeezed_test {
namespace {

using namespace squeezed_cases;

constexpr double kStated = 0.05;  // radians

void expect_truth(const std::string& name, const SqueezeErrors& errors) {
  const Part part = rollfix::load_part(name);
  const double P = part.perimeter();
  std::mt19937_64 generator = test_generator(7);
  Squeeze squeeze;
  squeeze.radius = 0.05 * P;
  squeeze.errors = errors;
  squeeze.stated = kStated;
  squeeze.rows = 12;
  const RigCase truth = noisy(random_squeezed(part, squeeze, generator), {0.001 * P, 0.005, 0.001 * P, 0}, generator);
  const HoldAnswer answer = rollfix::solve(truth.problem);
  EXPECT_FALSE(answer.verdict.fits_badly);
  EXPECT_TRUE(std::any_of(answer.placements.begin(), answer.placements.end(), [&](const HoldPlacement& one) {
    return part.distance(one.contacts[0].mean, truth.start) < 5 * one.contacts[0].sd;
  })) << name;
}

}  // namespace

TEST(Squeezed, AForceThatIsOffAlikeInAllRowsLeavesTheTruth) {
  expect_truth("gallery:ellipse,a=2,b=1", {.alike = kStated});
  expect_truth("gallery:cam", {.alike = kStated});
}

TEST(Squeezed, AForceThatIsOffAnewInEachRowLeavesTheTruth) { expect_truth("gallery:cam", {.each_row = kStated}); }

TEST(Squeezed, AForceThatTiltsToTheOtherSideHalfwayLeavesTheTruth) {
  expect_truth("gallery:cam", {.turning = kStated});
}

}  // namespace squeezed_test
