// The tree over the boundary leads the search past what can't fit. It loses nothing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "locate/searches.hpp"
#include "part/part_data.hpp"
#include "random.hpp"
#include "rollfix/locate.hpp"
#include "shapes.hpp"

namespace locate_tree_test {
namespace {

using namespace rollfix;
using namespace rollfix::locating;
using shapes::kPi;

double uniform(std::mt19937_64& generator, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(generator);
}

/// Points around a wavy outline, the same `fold` times over.
std::vector<Vec2> wavy_points(std::mt19937_64& generator, int count, int fold) {
  const double first = uniform(generator, 0, 0.2);
  const double second = uniform(generator, 0, 0.1);
  const double phase = uniform(generator, 0, 6);
  std::vector<Vec2> points;
  for (int k = 0; k < count; ++k) {
    const double t = 2 * kPi * k / count;
    const double radius = 1 + first * std::cos(fold * t) + second * std::cos(2 * fold * t + phase);
    points.emplace_back(radius * std::cos(t), radius * std::sin(t));
  }
  return points;
}

Part random_part(std::mt19937_64& generator, int kind) {
  const int count = std::uniform_int_distribution<int>(60, 400)(generator);
  const bool closed = kind % 2 == 0;
  const std::vector<Vec2> points = wavy_points(generator, count, kind < 4 ? 1 : 3);
  if (kind == 0 || kind == 1) return Part(shapes::polygon(points, closed));
  return Part({"spline", spline_through(points, closed), closed});
}

std::vector<Reading> random_readings(std::mt19937_64& generator, const Part& part) {
  const double period = part.perimeter();
  const double start = uniform(generator, 0, period);
  std::vector<Reading> readings;
  for (int k = std::uniform_int_distribution<int>(1, 3)(generator); k > 0; --k) {
    const double length =
        part.closed() ? uniform(generator, -2, 2) * period : uniform(generator, -start, period - start);
    readings.push_back(shapes::reading_from(part, start, length));
  }
  return readings;
}

/// Every joint, everything that ends at one, and places in between.
std::vector<double> places_to_try(std::mt19937_64& generator, const Part& part, const Reading& reading) {
  std::vector<double> places;
  for (const Spiral& spiral : part.turning().spirals()) {
    places.push_back(spiral.lo);
    places.push_back(part.boundary().on_first_lap(spiral.lo - reading.length[0]));
    places.push_back(uniform(generator, spiral.lo, spiral.hi));
  }
  return places;
}

TEST(TurningTree, holds_the_turning_function_in_strips_along_chords) {
  auto generator = test_generator();
  for (int k = 0; k < test_count(60); ++k) {
    const Part part = random_part(generator, k % 6);
    const TurningFunction& turning = part.turning();
    const TurningTree& tree = PartAccess::data(part).tree;
    for (std::size_t level = 1; level <= tree.top(); ++level) {
      for (std::size_t i = 0; i < tree.count(level); ++i) {
        const TurningTree::Block& block = tree.block(level, i);
        const double end = i + 1 < tree.count(level) ? tree.block(level, i + 1).lo : part.perimeter();
        const double s = uniform(generator, block.lo, end);
        for (const Side side : {Side::before, Side::after}) {
          const double off = turning.angle(s, side) - block.chord(s);
          ASSERT_GE(off, block.below - kTurnAccuracy) << "seed " << test_seed() << ", case " << k;
          ASSERT_LE(off, block.above + kTurnAccuracy) << "seed " << test_seed() << ", case " << k;
        }
      }
    }
  }
}

TEST(SearchTree, passes_over_no_place_that_fits) {
  auto generator = test_generator(1);
  std::size_t fitting = 0;
  double left = 0;
  const int count = test_count(200);
  for (int k = 0; k < count; ++k) {
    const Part part = random_part(generator, k % 6);
    const std::vector<Reading> readings = random_readings(generator, part);
    const ContactEquations question{part, readings};
    const double tolerance = std::pow(10, uniform(generator, -9, -1.3));
    Interval range{0, part.perimeter()};
    for (const Reading& reading : readings) {
      if (part.closed()) break;
      range = {std::max(range.lo, -reading.length[0]), std::min(range.hi, part.perimeter() - reading.length[0])};
    }
    const Stretches stretches = find_candidates(question, range, tolerance).stretches;
    for (const Interval& stretch : stretches) left += stretch.width() / part.perimeter() / count;
    for (const double s : places_to_try(generator, part, readings.back())) {
      if (!range.contains(s) || residual_at(question, s) > tolerance) continue;
      const bool is_kept = std::any_of(stretches.begin(), stretches.end(), [&](const Interval& stretch) {
        return part.boundary().contains(stretch, s, 1e-11);
      });
      EXPECT_TRUE(is_kept) << "seed " << test_seed() << ", case " << k << ", s = " << s;
      ++fitting;
    }
  }
  EXPECT_GT(fitting, static_cast<std::size_t>(count));
  EXPECT_LT(left, 0.4);  // and yet it passes over most
}

TEST(SearchTree, finds_every_roll_again_on_outlines_of_many_spirals) {
  auto generator = test_generator(2);
  for (int k = 0; k < test_count(600); ++k) {
    const Part part = random_part(generator, k % 6);
    const double s = uniform(generator, 0, part.perimeter());
    const double length =
        part.closed() ? uniform(generator, -3, 3) * part.perimeter() : uniform(generator, -s, part.perimeter() - s);
    const Search search = locate(part, shapes::reading_from(part, s, length));
    EXPECT_EQ(search.status, Status::complete);
    EXPECT_TRUE(shapes::holds(part, search, s, 1e-9 * part.perimeter())) << "seed " << test_seed() << ", case " << k;
  }
}

TEST(SearchTree, costs_what_the_answers_cost_however_many_points_there_are) {
  std::size_t most = 0;
  for (const int count : {200, 2000, 20000}) {
    auto generator = test_generator(3);
    const Part part({"spline", spline_through(wavy_points(generator, count, 2), true), true});
    const Search search = locate(part, shapes::reading_from(part, 0.3, 1.7));
    most = std::max(most, search.counts.intervals);
  }
  EXPECT_LT(most, 500U);
}

// ---- what is not in general position ----

TEST(SearchTree, takes_a_circle_of_many_arcs_for_one) {
  Outline outline{"circle", {}, true};
  for (int k = 0; k < 90; ++k) outline.curves.emplace_back(Arc({0, 0}, 1, 2 * kPi * k / 90, 2 * kPi / 90));
  const Part part(outline);
  EXPECT_EQ(locate(part, {1.0, 1.0}).verdict().name, Verdict::unobservable);
  EXPECT_TRUE(locate(part, {1.0, 1.1}).placements.empty());
}

TEST(SearchTree, takes_a_line_of_many_pieces_for_one) {
  std::vector<Vec2> points;
  for (int k = 0; k <= 80; ++k) points.emplace_back(k, 0);
  const Search search = locate(Part(shapes::polygon(points, false)), {10, 0});
  EXPECT_THAT(shapes::kinds(search), testing::ElementsAre(Kind::stretch));
  EXPECT_NEAR(search.placements.front().extent[0].lo, 0, 1e-10);
  EXPECT_NEAR(search.placements.front().extent[0].hi, 70, 1e-10);
}

TEST(SearchTree, keeps_a_double_root) {
  std::vector<Vec2> points;
  for (int k = 0; k < 200; ++k) points.emplace_back(2 * std::cos(2 * kPi * k / 200), std::sin(2 * kPi * k / 200));
  const Part part({"ellipse", spline_through(points, true), true});
  const double length = 0.2 * part.perimeter();  // from as far before the nose as it ends after it: f is extreme
  const double s = part.perimeter() - 0.5 * length;
  EXPECT_TRUE(shapes::holds(part, locate(part, shapes::reading_from(part, s, length)), s, 1e-9));
}

TEST(SearchTree, keeps_the_pivot_at_each_corner_of_a_polygon) {
  std::vector<Vec2> corners;
  for (int k = 0; k < 60; ++k) corners.emplace_back(std::cos(2 * kPi * k / 60), std::sin(2 * kPi * k / 60));
  const Part part(shapes::polygon(corners));
  const double side = part.perimeter() / 60;
  const Search search = locate(part, {3.3 * side, 3.5 * 2 * kPi / 60});
  EXPECT_EQ(search.placements.size(), 120U);  // a start or an end at each
  EXPECT_THAT(shapes::kinds(search), testing::Each(Kind::corner));
}

/// A drop: a round outline of many corners that comes to a point, which is its k-th one.
Part drop(int k) {
  std::vector<Vec2> corners{{2, 0}};
  for (int i = 0; i <= 80; ++i) {
    const double t = kPi / 3 + 4 * kPi / 3 * i / 80;
    corners.emplace_back(std::cos(t), std::sin(t));
  }
  std::rotate(corners.begin(), corners.end() - k, corners.end());
  return Part(shapes::polygon(corners));
}

TEST(SearchTree, keeps_each_pivot_at_a_sharp_corner_wherever_that_is_among_others) {
  for (const int k : {0, 1, 2, 3}) {
    const Part part = drop(k);
    const TurningFunction& turning = part.turning();
    const double tip = turning.spirals()[static_cast<std::size_t>(k)].lo;
    const double before = turning.angle(tip, Side::before);
    for (const double length : {0.37 * part.perimeter(), 1.0, -1.0}) {
      for (const double share : {0.05, 0.3, 0.7, 0.95}) {
        const double pivoted = before + share * (turning.angle(tip) - before);
        const Search started = locate(part, {length, turning.angle(tip + length) - pivoted});
        EXPECT_TRUE(shapes::holds(part, started, tip, 1e-9)) << "tip " << k << ", length " << length;
        const Search ended = locate(part, {length, pivoted - turning.angle(tip - length)});
        EXPECT_TRUE(shapes::holds(part, ended, tip - length, 1e-9)) << "tip " << k << ", length " << length;
      }
    }
  }
}

TEST(SearchTree, keeps_all_of_a_symmetric_part) {
  auto generator = test_generator(4);
  const Part part({"star", spline_through(wavy_points(generator, 240, 8), true), true});
  const double length = part.perimeter() / 8;
  EXPECT_EQ(locate(part, {length, 2 * kPi / 8}).verdict().name, Verdict::unobservable);
  EXPECT_EQ(locate(part, shapes::reading_from(part, 0.1, 0.3 * length)).placements.size() % 8, 0U);
}

TEST(SearchTree, knows_rolls_of_no_length_and_of_more_than_a_lap) {
  auto generator = test_generator(5);
  const Part part = random_part(generator, 2);
  EXPECT_EQ(locate(part, {0, 0}).verdict().name, Verdict::unobservable);
  EXPECT_TRUE(locate(part, {0, 0.1}).placements.empty());
  const Reading short_one = shapes::reading_from(part, 0.7, 1.1);
  const Reading long_one{short_one.length[0] + 3 * part.perimeter(), short_one.turn + 3 * 2 * kPi};
  const std::vector<double> starts = shapes::starts(locate(part, short_one));
  EXPECT_THAT(shapes::starts(locate(part, long_one)), testing::Pointwise(testing::DoubleNear(1e-9), starts));
}

TEST(SearchTree, reaches_both_ends_of_an_open_curve) {
  const Part part = shapes::open_waves();
  const double length = 0.31 * part.perimeter();
  for (const double s : {0.0, part.perimeter() - length}) {
    EXPECT_TRUE(shapes::holds(part, locate(part, shapes::reading_from(part, s, length)), s, 1e-9)) << s;
  }
}

}  // namespace
}  // namespace locate_tree_test
