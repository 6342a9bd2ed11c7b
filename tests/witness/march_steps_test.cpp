// Theorems 4 and 5: how many numerical increments the march takes. The tables are those of docs/march.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include "march_agreement.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_steps_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_oracle::Exhaustive;
using march_oracle::RandomReading;

/// The largest counts over some readings, in steps per loop.
struct Worst {
  double start = 0;
  double marching = 0;
  double bisection = 0;
  double total = 0;

  void take(const Result& result) {
    const double loop = static_cast<double>(result.steps_per_loop);
    start = std::max(start, static_cast<double>(result.steps.start) / loop);
    marching = std::max(marching, static_cast<double>(result.steps.marching) / loop);
    bisection = std::max(bisection, static_cast<double>(result.steps.bisection) / loop);
    total = std::max(total, static_cast<double>(result.steps.total()) / loop);
  }
};

Options with_steps(int steps) {
  Options options;
  options.step = 2 * kPi / steps;
  options.iterations = 2000;  // what is slower than that takes no steps either
  return options;
}

/// Readings that have the same answers at every h.
std::vector<RandomReading> readings_on(const Exhaustive& oracle, int count, std::uint64_t stream) {
  std::mt19937_64 generator = test_generator(stream);
  std::vector<RandomReading> readings;
  for (int i = 0; i < count; ++i) readings.emplace_back(oracle, true, generator);
  return readings;
}

TEST(MarchSteps, theorem_4_two_loops_and_m_on_a_convex_boundary) {
  fmt::print("  shape      T/h    m / (T/h)   marching / (T/h), largest of the readings\n");
  for (const rollfix::Outline& outline : {ellipse(2, 1), limacon(2.5, 1), egg()}) {
    const std::vector<RandomReading> readings = readings_on(Exhaustive(outline), test_count(12), 1);
    for (const int steps : {64, 256, 1024, 4096}) {
      const March march(outline, curvature_density(), with_steps(steps));
      Worst worst;
      for (const RandomReading& reading : readings) {
        const Result result = march.segments(reading.length, reading.integral);
        worst.take(result);
        EXPECT_LE(result.steps.start, result.steps_per_loop);         // m <= T/h
        EXPECT_LE(result.steps.marching, 2 * result.steps_per_loop);  // 2T/h
        EXPECT_EQ(result.steps.bisection, 0U);
      }
      fmt::print("  {:9}  {:5}  {:.4f}      {:.4f}\n", outline.name, steps, worst.start, worst.marching);
    }
  }
}

TEST(MarchSteps, theorem_5_five_loops_in_all_on_any_boundary) {
  fmt::print("  shape         T/h    m      marching  bisection  total, each / (T/h), largest of the readings\n");
  for (const rollfix::Outline& outline : {limacon(1.5, 1), amoeba(), amoeba(0.2, 7), amoeba(0.05, 15)}) {
    const std::vector<RandomReading> readings = readings_on(Exhaustive(outline), test_count(12), 2);
    for (const int steps : {512, 2048, 8192}) {
      const March march(outline, curvature_density(), with_steps(steps));
      Worst worst;
      for (const RandomReading& reading : readings) {
        const Result result = march.segments(reading.length, reading.integral);
        worst.take(result);
        EXPECT_LE(result.steps.total(), 5 * result.steps_per_loop);
      }
      fmt::print("  {:2} inflections  {:5}  {:.3f}  {:.3f}     {:.3f}      {:.3f}\n", march.breakpoints().size(), steps,
                 worst.start, worst.marching, worst.bisection, worst.total);
    }
  }
}

TEST(MarchSteps, the_count_grows_linearly_with_the_number_of_steps_per_loop) {
  const Exhaustive oracle(amoeba());
  for (const RandomReading& reading : readings_on(oracle, test_count(10), 3)) {
    std::vector<double> x, y;
    for (const int steps : {500, 1000, 2000, 4000, 8000}) {
      const Result result =
          March(amoeba(), curvature_density(), with_steps(steps)).segments(reading.length, reading.integral);
      x.push_back(std::log(static_cast<double>(result.steps_per_loop)));
      y.push_back(std::log(static_cast<double>(result.steps.total())));
    }
    const double exponent = (y.back() - y.front()) / (x.back() - x.front());
    EXPECT_NEAR(exponent, 1, 0.02);
  }
}

TEST(MarchSteps, rounds_and_landings_do_not_depend_on_the_step) {
  const Exhaustive oracle(egg());
  const double length = 0.3 * oracle.perimeter();
  const double turn = oracle.phi(0.4 * oracle.perimeter(), length);
  const Result coarse = locate(egg(), {length, turn}, with_steps(64));
  const Result fine = locate(egg(), {length, turn}, with_steps(4096));
  fmt::print("  T/h    rounds  landings  quadratures over a part of a step\n");
  for (const Result& result : {coarse, fine}) {
    fmt::print("  {:4}   {}     {}       {}\n", result.steps_per_loop, result.iterations, result.steps.landings,
               result.steps.refinements);
  }
  EXPECT_NEAR(static_cast<double>(fine.iterations), static_cast<double>(coarse.iterations), 4);
  EXPECT_LE(fine.steps.landings, 2 * fine.iterations + 20);
}

TEST(MarchSteps, preprocessing_is_one_loop_and_is_done_once) {
  const March march(amoeba(), curvature_density(), with_steps(1000));
  const Result first = march.segments(2, 1);
  EXPECT_EQ(first.steps.preprocessing, first.steps_per_loop);
  EXPECT_EQ(first.steps_per_loop, 1000U);
  EXPECT_DOUBLE_EQ(first.step, 2 * kPi / 1000);
  EXPECT_DOUBLE_EQ(first.parameter_range, 2 * kPi);
}

TEST(MarchSteps, answers_do_not_depend_on_the_step_once_it_is_fine_enough) {
  const Exhaustive oracle(amoeba());
  fmt::print("  T/h    largest error of s / P\n");
  const auto readings = readings_on(oracle, 10, 4);
  for (const int steps : {16, 32, 64, 128, 256, 1024}) {
    const March march(amoeba(), curvature_density(), with_steps(steps));
    double worst = 0;
    for (const RandomReading& reading : readings) {
      const auto roots = oracle.scan(reading.length, reading.integral).roots;
      for (const Segment& segment : march.segments(reading.length, reading.integral).segments) {
        double nearest = oracle.perimeter();
        for (const double root : roots) {
          nearest = std::min(nearest, march_oracle::distance(root, segment.start, oracle.perimeter(), true));
        }
        worst = std::max(worst, nearest / oracle.perimeter());
      }
    }
    fmt::print("  {:4}   {:.1e}\n", steps, worst);
    if (steps >= 64) {
      EXPECT_LT(worst, 1e-8);
    }
    if (steps >= 128) {
      EXPECT_LT(worst, 1e-10);
    }
  }
}

}  // namespace
}  // namespace march_steps_test
