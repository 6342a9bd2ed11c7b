// The bounds by which parts are passed over lose none: the answer is the same without them.
#include <gtest/gtest.h>

#include "touch/identify_rolls.hpp"

namespace identify_rolls_witness_test {
namespace {

using namespace identify_rolls;

class IdentifyRollsWitness : public Identified {};

TEST_F(IdentifyRollsWitness, LoseNothingByBounds) {
  expect_no_loss(rolled(kSpline, 2, 0, 30).problem);
  expect_no_loss(rolled(kSpline + 1, 1, 2, 31, 4).problem);
  expect_no_loss(face_down(rolled(kCam, 2, 1, 32).problem));
}

TEST_F(IdentifyRollsWitness, LoseNothingWithinATolerance) {
  TouchProblem problem = rolled(kSpline, 2, 0, 33).problem;
  problem.noise.reset();
  problem.tolerance = {0.02, 0.05};
  expect_no_loss(problem);
}

}  // namespace
}  // namespace identify_rolls_witness_test
