// Rolls that begin or end at a sharp corner: exact but for their digits, and with noise.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace sharp_corners_test {
namespace {

using rollfix::Answer;
using rollfix::Log;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Placement;
using rollfix::Problem;

using Generator = std::mt19937_64;

double uniform(double lo, double hi, Generator& generator) {
  return std::uniform_real_distribution<double>(lo, hi)(generator);
}

/// A side from one corner to the next that bulges outwards by this angle.
rollfix::Curve side(const rollfix::Vec2& from, const rollfix::Vec2& to, double bulge) {
  if (bulge == 0) return rollfix::Line(from, to);
  const rollfix::Vec2 chord = to - from;
  const double radius = 0.5 * chord.norm() / std::sin(0.5 * bulge);
  const rollfix::Vec2 inwards = rollfix::Vec2(-chord.y(), chord.x()).normalized();
  const rollfix::Vec2 centre = 0.5 * (from + to) + radius * std::cos(0.5 * bulge) * inwards;
  return rollfix::Arc(centre, radius, std::atan2(from.y() - centre.y(), from.x() - centre.x()), bulge);
}

/// Three to five corners about an ellipse; sides are lines, or bulge each by its own angle.
Part cornered(bool bulges, Generator& generator) {
  const int count = 3 + static_cast<int>(generator() % 3);
  std::vector<rollfix::Vec2> corners;
  for (int k = 0; k < count; ++k) {
    const double at = 2 * shapes::kPi * (k + uniform(-0.2, 0.2, generator)) / count;
    corners.emplace_back(std::cos(at), 0.75 * std::sin(at));
  }
  rollfix::Outline outline{"cornered", {}, true};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const double bulge = bulges ? uniform(0.15, 0.5, generator) : 0;
    outline.curves.push_back(side(corners[k], corners[(k + 1) % corners.size()], bulge));
  }
  return Part(outline);
}

// A shorter log tells little.
constexpr std::size_t kFewestRows = 10;

struct Drawn {
  Problem problem;
  rollfix::PerFinger<double> start;
};

/// A row in the first half of the roll in which a finger pivots; the first one where none does.
std::size_t first_pivot(const rollfix::Roll& truth) {
  for (std::size_t k = 1; k < truth.s[0].size() / 2; ++k) {
    for (const std::vector<double>& s : truth.s) {
      if (s[k] == s[k + 1]) return k;
    }
  }
  return 0;
}

/// The last row in which a finger pivots; the last one where none does.
std::size_t last_pivot(const rollfix::Roll& truth) {
  const std::vector<double>& s = truth.s[0];
  for (std::size_t k = s.size() - 1; k > kFewestRows; --k) {
    if (s[k - 1] == s[k]) return k;
  }
  return s.size() - 1;
}

/// The rows from the first to before the end.
Log rows_of(Log log, std::size_t first, std::size_t end) {
  const auto drop = [&](std::vector<double>& column) {
    column = {column.begin() + static_cast<std::ptrdiff_t>(first), column.begin() + static_cast<std::ptrdiff_t>(end)};
  };
  drop(log.time);
  for (rollfix::FingerRows& rows : log.fingers) {
    for (std::vector<double>* column : {&rows.u, &rows.psi}) drop(*column);
    rows.x.clear();
    rows.y.clear();
  }
  return log;
}

/// Both fingers roll a fifth to a half of the way around, from random places; the log begins at the first pivot.
Drawn drawn(const Part& part, const Noise& noise, Generator& generator) {
  const double perimeter = part.perimeter();
  rollfix::FreePlan plan;
  plan.rows = 20 + generator() % 100;
  plan.part_rotation = uniform(-0.6, 0.6, generator);
  for (rollfix::FreeFinger& finger : plan.fingers) {
    finger.finger = rollfix::disk(uniform(0.02, 0.06, generator) * perimeter);
    finger.start = uniform(0, perimeter, generator);
    finger.distance = uniform(0.2, 0.5, generator) * perimeter * (generator() % 2 == 0 ? 1 : -1);
  }
  const rollfix::NoisyRoll roll = rollfix::noisy_roll_free(part, plan, noise, generator());
  const std::size_t first = first_pivot(roll.truth);
  Problem problem{part, rows_of(roll.log, first, roll.log.rows()), {plan.fingers[0].finger, plan.fingers[1].finger}};
  problem.may_overlap = true;
  return {problem, {roll.truth.s[0][first], roll.truth.s[1][first]}};
}

/// A log as a file has it that is written with so many decimals.
void round_to(int decimals, Log& log) {
  const double unit = std::pow(10, -decimals);
  for (rollfix::FingerRows& rows : log.fingers) {
    for (std::vector<double>* column : {&rows.u, &rows.psi, &rows.x, &rows.y}) {
      for (double& value : *column) value = unit * std::round(value / unit);
    }
    rows.place_rounding = rows.angle_rounding = 0.5 * unit;
  }
}

/// An exact roll, written with so many decimals.
Drawn written(const Part& part, int decimals, Generator& generator) {
  Drawn exact = drawn(part, Noise{}, generator);
  round_to(decimals, *exact.problem.measured.log);
  return exact;
}

/// One finger rolls from a random place, at least over a side, so that it pivots on the way; with its centres.
Drawn over_corners(const Part& part, const Noise& noise, Generator& generator) {
  const rollfix::Finger finger = rollfix::disk(uniform(0.02, 0.06, generator) * part.perimeter());
  rollfix::RollPlan plan;
  plan.start = uniform(0, part.perimeter(), generator);
  plan.distance = uniform(0.4, 0.6, generator) * part.perimeter() * (generator() % 2 == 0 ? 1 : -1);
  plan.rows = 30 + generator() % 100;
  return {{part, rollfix::noisy_roll(part, finger, plan, noise, generator()).log, {finger}}, plan.start};
}

Noise noise_on(const Part& part) { return {.contact = 5e-4 * part.perimeter(), .angle = 0.003}; }

Drawn noisy_pair(const Part& part, Generator& generator) {
  Drawn noisy = drawn(part, noise_on(part), generator);
  noisy.problem.noise = noise_on(part);
  return noisy;
}

/// A disk about still on one long side of a quadrilateral, another one that rolls on the opposite side; with centres.
Drawn noisy_sides(Generator& generator) {
  rollfix::Outline outline{"trapezoid", {}, true};
  const std::vector<rollfix::Vec2> corners{{0, 0}, {60, 0}, {60, 40}, {0, 38}};
  for (std::size_t k = 0; k < 4; ++k) outline.curves.push_back(rollfix::Line(corners[k], corners[(k + 1) % 4]));
  const Part part(outline);
  rollfix::FreePlan plan;
  plan.rows = 20;
  plan.part_rotation = 0.4;
  for (rollfix::FreeFinger& finger : plan.fingers) finger.finger = rollfix::disk(3);
  plan.fingers[0].start = uniform(10, 50, generator);
  plan.fingers[0].distance = uniform(-1, 1, generator);
  plan.fingers[1].start = uniform(110, 150, generator);
  plan.fingers[1].distance = uniform(-8, 8, generator);
  const Noise noise{.contact = 0.2, .angle = 0.0017, .position = 0.1};
  const rollfix::NoisyRoll roll = rollfix::noisy_roll_free(part, plan, noise, generator());
  Problem problem{part, roll.log, {rollfix::disk(3)}, noise};
  problem.may_overlap = true;
  return {problem, {roll.truth.s[0][0], roll.truth.s[1][0]}};
}

/// One finger on a part at rest rolls from a random place and stops while it pivots.
Drawn noisy_stop(const Part& part, Generator& generator) {
  const rollfix::Finger finger = rollfix::disk(uniform(0.02, 0.06, generator) * part.perimeter());
  rollfix::RollPlan plan;
  plan.start = uniform(0, part.perimeter(), generator);
  plan.distance = uniform(0.3, 0.6, generator) * part.perimeter() * (generator() % 2 == 0 ? 1 : -1);
  plan.rows = 30 + generator() % 100;
  const rollfix::NoisyRoll roll = rollfix::noisy_roll(part, finger, plan, noise_on(part), generator());
  return {{part, rows_of(roll.log, 0, last_pivot(roll.truth) + 1), {finger}, noise_on(part)}, plan.start};
}

/// A finger that stays where it is and turns by a quarter turn to the left, as at a sharp convex corner.
Problem pivoting_on(const Part& part, Generator& generator) {
  Log log;
  log.name = "pivot";
  const Noise noise{.contact = 0.003, .angle = 0.009};
  std::normal_distribution<double> normal;
  for (int row = 0; row < 40; ++row) {
    log.fingers[0].u.push_back((0.5 * noise.contact / 0.1) * normal(generator));
    log.fingers[0].psi.push_back(0.5 * shapes::kPi * row / 39 + 0.5 * noise.angle * normal(generator));
  }
  return {part, log, {rollfix::disk(0.1)}, noise};
}

/// A length of 0.4 along a side, then 60 degrees to the left about a corner, as a finger of which nothing is known.
Log side_and_pivot(Generator& generator) {
  std::normal_distribution<double> normal;
  std::string text = "length,turn\n";
  for (int row = 1; row <= 40; ++row) {
    const double length = std::min(0.02 * row, 0.4) + 0.01 * normal(generator);
    const double turn = std::max(0, row - 20) / 20.0 * shapes::kPi / 3 + 0.005 * normal(generator);
    text += fmt::format("{},{}\n", length, turn);
  }
  return rollfix::parse_log(text, "side and pivot");
}

/// Twelve corners that turn by some 30 degrees, and in one side a dent: three corners, the middle one concave.
Part dented() {
  rollfix::Outline outline{"dented", {}, true};
  std::vector<rollfix::Vec2> corners;
  for (int k = 0; k < 12; ++k)
    corners.emplace_back(2 * std::cos(k * shapes::kPi / 6), 2 * std::sin(k * shapes::kPi / 6));
  corners.push_back(0.47 * (corners.back() + corners.front()));
  for (std::size_t k = 0; k < corners.size(); ++k) {
    outline.curves.push_back(rollfix::Line(corners[k], corners[(k + 1) % corners.size()]));
  }
  return Part(outline);
}

/// Of an answer to an honest log: that the true start is within `near` of a place that fits, and nothing
/// is contradicted.
testing::AssertionResult is_honest(const Drawn& drawn, double near) {
  Problem problem = drawn.problem;
  problem.diagnose = false;
  const Answer answer = rollfix::solve(problem);
  const rollfix::Boundary boundary = problem.part.boundary();
  const auto holds = [&](const Placement& placement) {
    const auto is_in = [&](std::size_t k) {
      const rollfix::Interval& arc = problem.noise ? placement.interval[k] : placement.extent[k];
      return boundary.contains(arc, drawn.start[k], near * boundary.perimeter);
    };
    return !placement.is_contradicted && is_in(0) && is_in(drawn.start.size() - 1);
  };
  const bool is_listed = std::any_of(answer.placements.begin(), answer.placements.end(), holds);
  // Of honest noise a few in a thousand rows fit badly.
  if (is_listed && (problem.noise || !answer.verdict.fits_badly)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << answer.verdict.text() << ", true start " << drawn.start[0]
                                     << (is_listed ? "" : " not listed");
}

// Digits move places by no more than a few of their units, corners by none.
constexpr double kByDigits = 1e-6;
constexpr double kByNoise = 0.02;

TEST(SharpCorners, digits_of_two_exact_logs_contradict_nothing) {
  for (int k = 0; k < test_count(20); ++k) {
    Generator generator = test_generator(static_cast<std::uint64_t>(k) + 1);
    EXPECT_TRUE(is_honest(written(cornered(k % 2 == 0, generator), 9, generator), kByDigits)) << "case " << k;
  }
}

TEST(SharpCorners, that_a_finger_with_centres_passes_are_not_contradicted_by_digits) {
  for (int k = 0; k < test_count(40); ++k) {
    Generator generator = test_generator(static_cast<std::uint64_t>(k) + 4001);
    Drawn rounded = over_corners(cornered(k % 2 == 0, generator), Noise{}, generator);
    const int decimals = 2 + k % 7;
    round_to(decimals, *rounded.problem.measured.log);
    EXPECT_TRUE(is_honest(rounded, 10 * std::pow(10, -decimals))) << "case " << k << ", decimals " << decimals;
  }
}

TEST(SharpCorners, do_not_hide_that_rows_are_noisier_than_their_digits) {
  for (int k = 0; k < test_count(20); ++k) {
    Generator generator = test_generator(static_cast<std::uint64_t>(k) + 5001);
    const Part part = cornered(k % 2 == 0, generator);
    Drawn unsaid = over_corners(part, noise_on(part), generator);
    for (rollfix::FingerRows& rows : unsaid.problem.measured.log->fingers) rows.x = rows.y = {};
    unsaid.problem.diagnose = false;
    EXPECT_TRUE(rollfix::solve(unsaid.problem).verdict.fits_badly) << "case " << k;
  }
}

TEST(SharpCorners, that_are_concave_and_open_ends_are_no_places_to_pivot_at) {
  rollfix::Outline bow{"bow", {rollfix::Arc({0, 0}, 3, 0, 0.4)}, false};
  for (const Part& part : {dented(), Part(bow)}) {
    Generator generator = test_generator(1);
    Problem problem = pivoting_on(part, generator);
    problem.diagnose = false;
    const Answer answer = rollfix::solve(problem);
    EXPECT_TRUE(answer.placements.empty() || answer.verdict.fits_badly) << part.name() << ": " << answer.verdict.text();
  }
}

TEST(SharpCorners, that_are_concave_get_no_probability_beside_convex_ones) {
  const std::vector<rollfix::Vec2> corners = {{0, 0}, {4, 0}, {4, 1.5}, {1.5, 1.5}, {1.5, 3}, {0, 3}};
  const Part angle(rollfix::outline_through(corners, "angle", {.corner_angle = 0}));
  constexpr double kConcave = 8;  // s at (1.5, 1.5)
  for (const bool robust : {false, true}) {
    Generator generator = test_generator(2);
    Problem problem{angle, side_and_pivot(generator), {}, Noise{.contact = 0.01, .angle = 0.005}};
    problem.robust = robust;
    const Answer answer = rollfix::solve(problem);
    EXPECT_EQ(answer.placements.size(), 5U);
    for (const rollfix::Placement& place : answer.placements) {
      EXPECT_GT(std::abs(place.start[0] + 0.4 - kConcave), 0.1) << (robust ? "robust" : "plain");
    }
  }
}

TEST(SharpCorners, of_two_noisy_fingers_that_start_there_are_found) {
  for (int k = 0; k < test_count(10); ++k) {
    Generator generator = test_generator(static_cast<std::uint64_t>(k) + 1001);
    EXPECT_TRUE(is_honest(noisy_pair(cornered(k % 2 == 0, generator), generator), kByNoise)) << "case " << k;
  }
}

TEST(SlowSharpCorners, far_from_two_noisy_fingers_on_sides_explain_nothing_alone) {
  for (int k = 0; k < test_count(4); ++k) {
    Generator generator = test_generator(static_cast<std::uint64_t>(k) + 3034);
    EXPECT_TRUE(is_honest(noisy_sides(generator), kByNoise)) << "case " << k;
  }
}

TEST(SharpCorners, of_a_noisy_finger_that_stops_there_are_within_its_reach) {
  for (int k = 0; k < test_count(20); ++k) {
    Generator generator = test_generator(static_cast<std::uint64_t>(k) + 2001);
    EXPECT_TRUE(is_honest(noisy_stop(cornered(true, generator), generator), kByNoise)) << "case " << k;
  }
}

}  // namespace
}  // namespace sharp_corners_test
