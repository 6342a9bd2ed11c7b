// A finger at rest, before it rolls and all the time: rows that do not move tell no place, however many there are.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/tracker.hpp"

namespace rollfix::rest_test {
namespace {

using Generator = std::mt19937_64;

constexpr double kRadius = 0.2;
constexpr Noise kNoise{.contact = 0.01, .angle = 0.02};

const std::array<const char*, 4> kShapes = {"limacon,a=1.5,b=1", "ellipse,a=2,b=1", "cam", "stadium"};

/// With a dent in which the finger has no room.
Part dented() { return Part(gallery("limacon,a=1.3,b=1")); }

Part shape(int k) { return Part(gallery(kShapes[static_cast<std::size_t>(k) % kShapes.size()])); }

/// So many rows like the log's first one, then the log; each row with noise of its own.
Log after_rest(const Log& exact, int rows, Generator& generator) {
  std::normal_distribution<double> normal;
  Log log;
  log.name = "rest";
  const std::size_t rolled = exact.rows() == 1 ? 0 : exact.rows();
  for (std::size_t k = 0; k < static_cast<std::size_t>(rows) + rolled; ++k) {
    const std::size_t of = k < static_cast<std::size_t>(rows) ? 0 : k - static_cast<std::size_t>(rows);
    log.fingers[0].u.push_back(exact.fingers[0].u[of] + kNoise.contact / kRadius * normal(generator));
    log.fingers[0].psi.push_back(exact.fingers[0].psi[of] + kNoise.angle * normal(generator));
  }
  return log;
}

/// Rows that stay where they are.
Log at_rest(int rows, Generator& generator) {
  Log first;
  first.fingers[0].u = {-1.5};
  first.fingers[0].psi = {5.1};
  return after_rest(first, rows, generator);
}

/// How much of the boundary the listed intervals hold, at most 1.
double share_listed(const Answer& answer) {
  double length = 0;
  for (const Placement& placement : answer.placements) {
    for (const Interval& interval : placement.interval) length += interval.width();
  }
  return std::min(1.0, length / answer.part.perimeter());
}

bool holds(const Answer& answer, double start) {
  const double P = answer.part.perimeter();
  for (const Placement& placement : answer.placements) {
    for (const Interval& interval : placement.interval) {
      const double ahead = start - interval.lo;
      if (ahead - P * std::floor(ahead / P) <= interval.width()) return true;
    }
  }
  return false;
}

TEST(Rest, tells_no_place_however_long_it_lasts) {
  constexpr std::array<int, 5> kRows = {20, 60, 200, 1000, 5000};
  for (int k = 0; k < test_count(40); ++k) {
    Generator generator = test_generator(static_cast<std::uint64_t>(k) + 1);
    const int rows = kRows[static_cast<std::size_t>(k) % kRows.size()];
    Problem problem{k % 2 == 0 ? dented() : shape(k), at_rest(rows, generator), {disk(kRadius)}, kNoise};
    const Answer answer = solve(problem);
    EXPECT_TRUE(answer.verdict.name == Verdict::unobservable || share_listed(answer) > 0.8)
        << "case " << k << ", " << rows << " rows: " << answer.verdict.text();
  }
}

TEST(Rest, tells_no_place_while_it_lasts) {
  Generator generator = test_generator(3);
  const Log log = at_rest(1000, generator);
  Tracker tracker(dented(), {disk(kRadius)}, kNoise);
  for (std::size_t row = 0; row < log.rows(); ++row) {
    for (const Tracked& told :
         tracker.push(0.01 * static_cast<double>(row), log.fingers[0].u[row], log.fingers[0].psi[row])) {
      EXPECT_NE(told.verdict.name, Verdict::unique) << row;
    }
  }
}

TEST(Rest, before_a_roll_leaves_what_the_roll_tells) {
  int held = 0;
  const int count = test_count(40);
  for (int k = 0; k < count; ++k) {
    Generator generator = test_generator(static_cast<std::uint64_t>(k) + 501);
    const Part part = shape(k);
    RollPlan plan;
    plan.start = std::uniform_real_distribution<double>(0, part.perimeter())(generator);
    plan.distance = 0.3 * part.perimeter();
    plan.rows = 100;
    const Log exact = noisy_roll(part, disk(kRadius), plan, {}, 1).log;
    const Answer answer = solve({part, after_rest(exact, 500, generator), {disk(kRadius)}, kNoise});
    if (holds(answer, plan.start)) ++held;
  }
  EXPECT_GT(held, 0.85 * count);
}

}  // namespace
}  // namespace rollfix::rest_test
