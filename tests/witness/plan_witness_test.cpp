// The witness is a physics engine: a plan holds in it, and a roll that was refused for its friction slips.
#include <gtest/gtest.h>

#include "plan_trial.hpp"
#include "random.hpp"

namespace rollfix::plan_witness_test {
namespace {

using namespace plan_trial;  // NOLINT(google-build-using-namespace): the words of this test

TEST(PlanWitness, what_is_planned_holds_and_what_is_refused_slips) {
  std::mt19937_64 generator = test_generator(91);
  for (int k = 0; k < test_count(4); ++k) {
    const Case done = feasible_case(generator, static_cast<std::size_t>(k));
    const Played played = play(done);
    EXPECT_TRUE(holds(played)) << k << ": slip " << slip_of(played) << ", apart " << played.apart;
    EXPECT_LT(played.place, 2e-3) << k;
    if (const auto refused = refused_case(done)) {
      EXPECT_FALSE(holds(play(*refused))) << k;
    }
  }
}

}  // namespace
}  // namespace rollfix::plan_witness_test
