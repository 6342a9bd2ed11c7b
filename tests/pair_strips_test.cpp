// Two fingers on outlines of many points: curves are cut where boxes ask for it. Nothing is lost.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "locate/pair/roll_curve.hpp"
#include "pair_cases.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"

namespace pair_strips_test {
namespace {

using namespace rollfix;
using namespace rollfix::locating;

double uniform(std::mt19937_64& generator, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(generator);
}

/// A spline through points of a wavy outline, or of most of it.
Part wavy_part(std::mt19937_64& generator, int count, bool closed) {
  const double wave = uniform(generator, 0.02, 0.15);
  const double phase = uniform(generator, 0, 6);
  std::vector<Vec2> points;
  for (int k = 0; k < count; ++k) {
    const double t = (closed ? 2 : 1.6) * std::numbers::pi * k / count;
    const double radius = 1 + wave * std::cos(3 * t + phase) + 0.03 * std::cos(7 * t);
    points.emplace_back(radius * std::cos(t), radius * std::sin(t));
  }
  return Part({"wavy", spline_through(points, closed), closed});
}

RollEquations equations_of(const pair_cases::Case& drawn) {
  RollEquations equations;
  for (const Reading& reading : drawn.readings) {
    equations.lengths.push_back(reading.length[0]);
    equations.shifts.push_back(reading.turn);
  }
  equations.facing = drawn.facing;
  return equations;
}

std::vector<double> components(const Part& part, const RollEquations& equations, double s) {
  const double start = part.turning().angle(s);
  std::vector<double> values;
  for (std::size_t k = 0; k < equations.lengths.size(); ++k) {
    values.push_back(part.turning().angle(s + equations.lengths[k]) - start + equations.shifts[k]);
  }
  values.push_back(start + *equations.facing);
  return values;
}

TEST(RollStrips, hold_every_component_however_often_they_are_halved) {
  auto generator = test_generator();
  for (int k = 0; k < test_count(200); ++k) {
    const Part part = wavy_part(generator, 100 + 10 * (k % 40), k % 3 > 0);
    const RollEquations equations = equations_of(pair_cases::random_case(part, 2, generator));
    Interval s{0, part.perimeter()};
    if (!part.closed()) {
      for (const double length : equations.lengths) {
        s = {std::max(s.lo, -length), std::min(s.hi, part.perimeter() - length)};
      }
    }
    const RollStrips strips(part, equations, s);
    ASSERT_FALSE(strips.is_empty());
    std::vector<RollStrips::Span> spans = strips.whole();
    while (strips.cuts(spans.data()) > 6) {
      std::vector<Range> bounds(equations.rows());
      strips.bound(s, spans.data(), bounds.data());
      for (const double share : {0.0, uniform(generator, 0, 1), uniform(generator, 0, 1), 1.0}) {
        const std::vector<double> values = components(part, equations, s.lo + share * s.width());
        for (std::size_t row = 0; row < bounds.size(); ++row) {
          ASSERT_GE(values[row], bounds[row].least - 1e-10) << "seed " << test_seed() << ", case " << k;
          ASSERT_LE(values[row], bounds[row].most + 1e-10) << "seed " << test_seed() << ", case " << k;
        }
      }
      std::vector<RollStrips::Span> below(spans.size()), above(spans.size());
      const double middle = strips.halve(spans.data(), below.data(), above.data());
      const bool is_below = uniform(generator, 0, 1) < 0.5;
      spans = is_below ? below : above;
      (is_below ? s.hi : s.lo) = middle;
    }
  }
}

TEST(RollStrips, lead_to_every_pair_that_was_rolled_from) {
  auto generator = test_generator(1);
  for (int k = 0; k < test_count(200); ++k) {
    const Part part = wavy_part(generator, 80 + 20 * (k % 40), k % 4 > 0);
    const pair_cases::Case drawn = pair_cases::random_case(part, 2, generator);
    const Search search = locate(part, drawn.readings);
    EXPECT_EQ(search.status, Status::complete);
    EXPECT_TRUE(pair_cases::holds(part, search, drawn.start, 1e-8 * part.perimeter()))
        << "seed " << test_seed() << ", case " << k;
    LocateOptions options;
    options.facing = drawn.facing;
    EXPECT_TRUE(
        pair_cases::holds(part, locate(part, {drawn.readings.front()}, options), drawn.start, 1e-8 * part.perimeter()))
        << "seed " << test_seed() << ", case " << k;
  }
}

TEST(RollStrips, have_outlines_of_many_points_cost_what_their_answers_cost) {
  std::size_t evaluations = 0;
  for (const int count : {500, 5000, 50000}) {
    auto generator = test_generator(2);
    const Part part = wavy_part(generator, count, true);
    const std::vector<Reading> readings{pair_cases::reading_from(part, {0.3, 2.1}, 1.7, 0.9),
                                        pair_cases::reading_from(part, {0.3, 2.1}, 3.1, -2.2)};
    evaluations = std::max(evaluations, locate(part, readings).counts.evaluations);
  }
  EXPECT_LT(evaluations, 50000U);
}

/// Boxes for each pair of teeth, of a roll that fits on all of them.
double boxes_each(int teeth) {
  const Part part(gallery("gear,teeth=" + std::to_string(teeth)));
  const double pitch = part.perimeter() / teeth;
  const PerFinger<double> start(0.288 * pitch, 0.410 * pitch);
  const Search search = locate(part, {pair_cases::reading_from(part, start, 0.718 * pitch, 0.648 * pitch),
                                      pair_cases::reading_from(part, start, 0.591 * pitch, 0.094 * pitch)});
  EXPECT_EQ(search.placements.size(), static_cast<std::size_t>(4 * teeth * teeth));
  return static_cast<double>(search.counts.intervals) / (teeth * teeth);
}

TEST(RollStrips, take_hardly_more_boxes_a_pair_of_teeth_where_there_are_more_of_them) {
  EXPECT_LT(boxes_each(24), 1.25 * boxes_each(12));  // the strips' own bounds, which no halves tighten, take 1.39
}

}  // namespace
}  // namespace pair_strips_test
