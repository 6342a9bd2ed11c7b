// What an answer with noise is called, by what is left of all places.
#include <gtest/gtest.h>

#include "belief/posterior.hpp"

namespace verdict_test {
namespace {

using rollfix::Verdict;

/// Of one place, where points did not suffice for this share of the probability.
Verdict::Name verdict_with(double unresolved, double excess = 1) {
  rollfix::Fit fit;
  fit.excess = excess;
  return rollfix::belief::verdict_of(fit, {1, 0.01, unresolved}, {1, true}).name;
}

}  // namespace

TEST(Verdict, is_undecided_where_more_than_one_part_in_twenty_is_not_resolved) {
  EXPECT_EQ(verdict_with(0.049), Verdict::unique);
  EXPECT_EQ(verdict_with(0.051), Verdict::undecided);
}

TEST(Verdict, is_undecided_and_not_inconsistent_where_a_better_place_may_not_have_been_seen) {
  EXPECT_EQ(verdict_with(0.049, 10), Verdict::inconsistent);
  EXPECT_EQ(verdict_with(0.051, 10), Verdict::undecided);
}

TEST(Verdict, is_inconsistent_where_no_place_is_left) {
  EXPECT_EQ(rollfix::belief::verdict_of({}, {}, {1, true}).name, Verdict::inconsistent);
}

}  // namespace verdict_test
