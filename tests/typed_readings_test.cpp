// Readings as people write them know their digits.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "outline/turn.hpp"
#include "refusal.hpp"
#include "rollfix/solve.hpp"

namespace typed_readings_test {
namespace {

using namespace rollfix;

const Part& spline() {
  static const Part part = load_part("gallery:spline,n=9,seed=7,wobble=0.2");
  return part;
}

TEST(TypedReadings, of_four_digits_fit_where_they_were_measured) {
  const Answer answer = solve({spline(), typed({"0.9977,56.93deg", "1.9500,131.20deg"})});
  EXPECT_EQ(answer.verdict.text(), "unique");
  EXPECT_TRUE(answer.placements.front().contains(spline().boundary(), {6.2}));
}

TEST(TypedReadings, fit_nowhere_where_their_numbers_are_taken_as_exact) {
  const Measurement exact{Reading(0.9977, 56.93 * kDegree), Reading(1.95, 131.2 * kDegree)};
  EXPECT_EQ(solve({spline(), exact}).verdict.text(), "inconsistent");
}

TEST(TypedReadings, are_off_by_half_a_unit_of_their_last_decimal_each_in_its_own_unit) {
  const Measurement measured = typed({"1.5cm,0.25"}, "mm");
  EXPECT_DOUBLE_EQ(measured.readings.front().length[0], 15);
  EXPECT_DOUBLE_EQ(measured.roundings.front().length, 0.05);
  EXPECT_DOUBLE_EQ(measured.roundings.front().turn, 0.005);
}

TEST(TypedReadings, of_two_fingers_have_both_lengths) {
  const Measurement measured = typed({"0.58,0.94,-0.725248"});
  EXPECT_EQ(measured.readings.front().fingers(), 2U);
  EXPECT_DOUBLE_EQ(measured.roundings.front().length, 2 * 5e-7);
}

TEST(TypedReadings, that_are_none_are_refused_with_what_was_expected) {
  EXPECT_EQ(
      refusal_of([] { typed({"0.5"}); }),
      "`reading` 0.5: expected LENGTH,TURN as in 0.5,73deg, or of two fingers LENGTH_A,LENGTH_B,TURN, found 1 number");
  EXPECT_THAT(refusal_of([] { typed({"0.5,73dge"}); }), testing::HasSubstr("'73dge' is not an angle"));
  EXPECT_THAT(refusal_of([] { typed({"8mm,0.3"}); }), testing::HasSubstr("8mm"));
}

}  // namespace
}  // namespace typed_readings_test
