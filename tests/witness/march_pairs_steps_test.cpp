// Section 3.2: Theta((m + n) T/h) numerical steps in the worst case. The tables are those of docs/march.md.

#include "march_pairs.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_pairs_steps_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_pairs::Exhaustive;
using march_pairs::Planted;
using rollfix::Outline;

/// What docs/march.md derives: three endpoints per finger; one passage of each interval per interval of the other
/// finger, or seven where the pair is bisected.
constexpr double kMostPassages = 3 * 7;

/// Theorem 5's five loops hold for steps of equal length; the halvings of unequal ones take up to so much more.
constexpr double kUnequal = 1.5;

/// What the enumeration of all pairs of intervals took, in parts of (m + n) T/h.
double passages(const PairResult& result) {
  return static_cast<double>(result.steps.rectangles()) /
         static_cast<double>((result.m() + result.n()) * result.steps_per_loop);
}

/// The slope of the straight line that fits best.
double fitted_slope(const std::vector<Vec2>& points) {
  Vec2 mean = Vec2::Zero();
  for (const Vec2& point : points) mean += point / static_cast<double>(points.size());
  double products = 0, squares = 0;
  for (const Vec2& point : points) {
    products += (point - mean).x() * (point - mean).y();
    squares += (point - mean).x() * (point - mean).x();
  }
  return products / squares;
}

Vec2 logarithms(double x, double y) { return {std::log(x), std::log(y)}; }

PairMarch with_steps(const Outline& outline, int steps) {
  PairMarchOptions options;
  options.step = 2 * kPi / steps;
  return PairMarch(outline, options);
}

TEST(MarchPairsSteps, the_count_grows_linearly_with_the_number_of_steps_per_loop) {
  fmt::print("  shape     n   m   steps / ((m + n) T/h) at T/h = 500, 1000, 2000, 4000   exponent\n");
  auto generator = test_generator(91);
  for (const Outline& outline : {egg(), ellipse(2, 1), amoeba()}) {
    const Exhaustive oracle(outline);
    for (int i = 0; i < test_count(1); ++i) {
      const Planted planted(oracle, generator);
      std::vector<Vec2> points;
      std::string line;
      PairResult result;
      for (const int steps : {500, 1000, 2000, 4000}) {
        result = march_pairs::march(with_steps(outline, steps), planted.readings);
        points.push_back(logarithms(steps, static_cast<double>(result.steps.rectangles())));
        line += fmt::format("{:.4f}  ", passages(result));
      }
      const double exponent = fitted_slope(points);
      fmt::print("  {:8} {:2}  {:2}   {}   {:.4f}\n", outline.name, result.n(), result.m(), line, exponent);
      EXPECT_NEAR(exponent, 1, 0.03);
    }
  }
}

TEST(MarchPairsSteps, it_grows_linearly_with_the_number_of_intervals) {
  fmt::print("  points   m + n (mean)   steps / ((m + n) T/h): least, mean, most   rejected   examined\n");
  auto generator = test_generator(92);
  std::vector<Vec2> points;
  for (const int count : {6, 8, 12, 16, 24, 32}) {
    double least = 1e9, most = 0, sum = 0, intervals = 0, rejected = 0, examined = 0;
    const int cases = test_count(30);
    for (int i = 0; i < cases; ++i) {
      const Outline outline = random_spline(generator, count, 0.2);
      const Exhaustive oracle(outline);
      const PairResult result = march_pairs::march(PairMarch(outline), Planted(oracle, generator).readings);
      const double here = passages(result);
      EXPECT_LE(here, kMostPassages);
      least = std::min(least, here);
      most = std::max(most, here);
      sum += here;
      const auto ends = static_cast<double>(result.m() + result.n());
      intervals += ends;
      rejected += static_cast<double>(result.rejected);
      examined += static_cast<double>(result.examined);
    }
    points.push_back(logarithms(intervals / cases, sum / cases * intervals / cases));
    fmt::print("  {:2}       {:5.1f}          {:.3f}  {:.3f}  {:.3f}                       {:6.1f}     {:6.1f}\n",
               count, intervals / cases, least, sum / cases, most, rejected / cases, examined / cases);
  }
  const double exponent = fitted_slope(points);
  fmt::print("  exponent of m + n: {:.3f}\n", exponent);
  EXPECT_NEAR(exponent, 1, 0.2);
}

TEST(MarchPairsSteps, the_partition_costs_some_loops_per_function_and_one_round_per_finger) {
  auto generator = test_generator(93);
  for (const Outline& outline : {egg(), amoeba(), random_spline(generator, 10)}) {
    const Exhaustive oracle(outline);
    const PairResult result = march_pairs::march(PairMarch(outline), Planted(oracle, generator).readings);
    const double loop = static_cast<double>(result.steps_per_loop);
    EXPECT_EQ(result.steps.preprocessing, result.steps_per_loop);
    EXPECT_LE(static_cast<double>(result.steps.stationary), 4 * kUnequal * 5 * loop);
    // From 0 to s + L_1 and s + L_2, once around with all three, and once more up to a_0.
    EXPECT_LE(static_cast<double>(result.steps.evaluation), 2 * (2 + 3 * 2) * loop);
    EXPECT_GE(static_cast<double>(result.steps.evaluation), 2 * 3 * loop);
  }
}

}  // namespace
}  // namespace march_pairs_steps_test
