// What the paper excludes for two fingers is refused with the reason, or reported as a doubt, and always in bounded
// time.

#include <gmock/gmock.h>

#include <limits>

#include "march_pairs.hpp"
#include "march_shapes.hpp"
#include "rollfix/curve.hpp"

namespace march_pairs_refusal_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_pairs::Exhaustive;
using rollfix::InputError;
using rollfix::Outline;
using rollfix::Reading;
using testing::HasSubstr;

template <class Action>
void expect_refusal(Reason reason, const Action& action) {
  try {
    action();
    ADD_FAILURE() << "no refusal";
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.reason(), reason) << refusal.what();
    EXPECT_THAT(refusal.what(), HasSubstr("expected"));
  }
}

void expect_continuum(const Reading& first, const Reading& second) {
  expect_refusal(Reason::continuum, [&] { locate_pairs(ellipse(2, 1), first, second); });
}

/// Rounds are what takes time: never more than the budget, one more limit, and few for each limit after that.
void expect_bounded(const PairResult& result) {
  const PairMarchOptions options;
  EXPECT_LE(result.iterations, options.budget + options.iterations + 500 * result.doubts.size() + 5000);
}

TEST(MarchPairsRefusal, lines_arcs_and_corners) {
  const Trigonometric half{{{1, 1, 0}}, {{1.5, 1, -kPi / 2}}, {0, kPi}};
  const Outline bow{"bow", {half, rollfix::Line({-1, 0}, {1, 0})}, true, false};
  expect_refusal(Reason::line, [&] { PairMarch{bow}; });
  expect_refusal(Reason::arc, [] { PairMarch(outline_of("circle", rollfix::Arc({0, 0}, 2, 0, 2 * kPi))); });
  const Trigonometric most{{{2, 1, 0}}, {{1, 1, -kPi / 2}}, {0.3, kPi - 0.3}};
  Trigonometric rest{{{2, 1, 0}}, {{1, 1, -kPi / 2}}, {kPi + 0.3, 2 * kPi - 0.3}};
  rest.y.push_back({2 * std::sin(0.3), 0, 0});
  expect_refusal(Reason::corner, [&] { PairMarch(Outline{"lens", {most, rest}, true, false}); });
}

TEST(MarchPairsRefusal, equal_rolls_fit_wherever_both_fingers_are_at_one_place) {
  expect_continuum({2.1, 2.1, 0}, {3.3, 3.3, 0});
}

TEST(MarchPairsRefusal, one_reading_twice_fits_along_a_curve) { expect_continuum({1, 2.1, 0.1}, {1, 2.1, 0.1}); }

TEST(MarchPairsRefusal, a_finger_that_does_not_roll_or_rolls_whole_loops) {
  const double perimeter = Exhaustive(ellipse(2, 1)).perimeter();
  expect_continuum({0, 2.1, 0.1}, {1, 3.3, 0.2});
  expect_continuum({1, 2.1, 0.1}, {1, -2 * perimeter, 0.2});
}

TEST(MarchPairsRefusal, a_roll_by_a_period_of_the_part) {
  const double perimeter = Exhaustive(ellipse(2, 1)).perimeter();
  expect_continuum({perimeter / 2, 2.1, 0.1}, {1, 3.3, 0.2});
}

TEST(MarchPairsRefusal, readings_that_are_close_to_a_continuum_end_in_doubts_soon) {
  for (const double off : {1e-10, 1e-8, 1e-6}) {
    SCOPED_TRACE(off);
    const PairResult by_turn = locate_pairs(ellipse(2, 1), {2.1, 2.1, off}, {3.3, 3.3, 0});
    EXPECT_FALSE(by_turn.complete());
    expect_bounded(by_turn);
    const PairResult twice = locate_pairs(ellipse(2, 1), {1, 2.1, 0.1}, {1, 2.1, 0.1 + off});
    EXPECT_TRUE(twice.pairs.empty());
    expect_bounded(twice);
  }
}

TEST(MarchPairsRefusal, lengths_that_are_close_to_a_period_end_in_doubts_soon) {
  const double perimeter = Exhaustive(ellipse(2, 1)).perimeter();
  for (const double off : {1e-9, 1e-6}) {
    SCOPED_TRACE(off);
    const PairResult result = locate_pairs(ellipse(2, 1), {perimeter / 2 + off, 2.1, 0.1}, {1, 3.3, 0.2});
    EXPECT_FALSE(result.complete());
    EXPECT_EQ(result.doubts.front().why, PairDoubt::Why::stationary);
    expect_bounded(result);
  }
}

TEST(MarchPairsRefusal, two_pairs_too_close_together_become_a_doubt_around_them) {
  const Exhaustive oracle(egg());
  const march_pairs::Touching touching(oracle);
  const PairResult result = march_pairs::march(PairMarch(egg()), touching.readings);
  EXPECT_TRUE(march_pairs::doubts(result, touching.at, oracle.perimeter()));
  EXPECT_FALSE(result.complete());
}

TEST(MarchPairsRefusal, open_outlines_and_numbers_that_are_out_of_range) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(PairMarch{open_wave()}, InputError);
  EXPECT_THROW(locate_pairs(egg(), {infinity, 1, 1}, {1, 2, 3}), InputError);
  EXPECT_THROW(locate_pairs(egg(), {1, 1, 1}, {1, 2, std::nan("")}), InputError);
  const auto with = [](double step, double limit, double reset, std::size_t iterations) {
    PairMarchOptions options;
    options.step = step;
    options.limit = limit;
    options.reset = reset;
    options.iterations = iterations;
    return options;
  };
  for (const PairMarchOptions& bad :
       {with(-1, 1e-11, 1e-8, 10), with(0, 0, 1e-8, 10), with(0, 1e-11, 1e-11, 10), with(0, 1e-11, 1e-8, 0)}) {
    EXPECT_THROW(PairMarch(egg(), bad), InputError);
  }
}

}  // namespace
}  // namespace march_pairs_refusal_test
