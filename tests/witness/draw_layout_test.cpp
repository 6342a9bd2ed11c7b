// What keeps arcs and labels apart: lanes, paths beside the boundary, label placement, round numbers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "draw/labels.hpp"
#include "draw/plot.hpp"
#include "draw/rolls.hpp"
#include "random.hpp"

namespace draw_layout_test {
namespace {

using namespace rollfix::draw;
using rollfix::Interval;
using rollfix::Vec2;
using testing::ElementsAre;

constexpr double kPi = std::numbers::pi;

/// Whether a point of a circle with this period lies in a stretch.
bool covers(const Interval& stretch, double point, double period) {
  for (double turn = -3; turn <= 3; ++turn) {
    if (stretch.contains(point + turn * period)) return true;
  }
  return false;
}

TEST(Lanes, never_hold_two_stretches_at_one_point_of_a_closed_boundary) {
  std::mt19937_64 generator = test_generator();
  std::uniform_real_distribution<double> start(0, 1), size(0, 1.4);
  for (int test = 0; test < test_count(50); ++test) {
    std::vector<Interval> stretches;
    for (int i = 0; i < 12; ++i) {
      const double lo = start(generator);
      stretches.push_back({lo, lo + size(generator)});
    }
    const Lanes lanes = assign_lanes(stretches, {1, true}, 0.01);
    for (double point = 0; point < 1; point += 0.003) {
      std::vector<int> here(stretches.size(), 0);
      for (std::size_t i = 0; i < stretches.size(); ++i) {
        if (covers(stretches[i], point, 1)) ++here[static_cast<std::size_t>(lanes.of[i])];
      }
      EXPECT_LE(*std::max_element(here.begin(), here.end()), 1);
    }
  }
}

TEST(Lanes, are_as_few_as_can_be_on_an_open_boundary) {
  // Sorted by start, first fit needs no more lanes than stretches meet at one point.
  const Lanes lanes = assign_lanes({{0, 2}, {1, 3}, {2.5, 4}, {3.5, 5}}, {5, false}, 0.1);
  EXPECT_THAT(lanes.of, ElementsAre(0, 1, 0, 1));
  EXPECT_EQ(lanes.count, 2);
}

TEST(Rolls, one_way_is_one_run_however_many_readings) {
  const Roll roll = roll_of({{1, 0}, {2, 0}, {3.5, 0}}, {10, true});
  ASSERT_EQ(roll.runs.size(), 1U);
  EXPECT_EQ(roll.runs[0].to, 3.5);
  EXPECT_EQ(roll.lanes, 1);
}

TEST(Rolls, back_and_forth_takes_a_lane_each_way) {
  const Roll roll = roll_of({{2, 0}, {-1, 0}}, {10, true});
  ASSERT_EQ(roll.runs.size(), 2U);
  EXPECT_EQ(roll.runs[1].from, 2);
  EXPECT_EQ(roll.runs[1].to, -1);
  EXPECT_EQ(roll.runs[1].lane, 1);
  EXPECT_EQ(roll.hull.lo, -1);
  EXPECT_EQ(roll.hull.hi, 2);
}

TEST(Rolls, more_than_once_round_takes_more_lanes) {
  EXPECT_EQ(roll_of({{10, 0}}, {10, true}).lanes, 1);
  EXPECT_EQ(roll_of({{-23, 0}}, {10, true}).lanes, 4);
  EXPECT_EQ(roll_of({{23, 0}}, {10, false}).lanes, 1);  // an open boundary has no round
}

/// A closed polyline on the page, run so that the inside is on the left of someone who looks at y pointing up.
Trace page_trace(const std::vector<Vec2>& corners) {
  Trace out;
  double s = 0;
  for (std::size_t i = 0; i <= corners.size(); ++i) {
    const Vec2& point = corners[i % corners.size()];
    if (i > 0) s += (point - corners[i - 1]).norm();
    out.s.push_back(s);
    out.points.push_back(point);
  }
  out.length = s;
  return out;
}

Trace page_circle(double radius) {
  std::vector<Vec2> points;
  for (int i = 0; i < 720; ++i) {
    const double angle = 2 * kPi * i / 720;
    points.emplace_back(200 + radius * std::cos(angle), 200 - radius * std::sin(angle));
  }
  return page_trace(points);
}

TEST(PathBeside, a_circle_is_a_larger_circle) {
  const Trace circle = page_circle(100);
  const std::vector<Vec2> path = path_beside(slice(circle, 50, 300), Clearance(circle), [](double) { return 12.0; });
  ASSERT_GT(path.size(), 50U);
  for (const Vec2& point : path) EXPECT_NEAR((point - Vec2(200, 200)).norm(), 112, 0.1);
}

TEST(PathBeside, never_comes_nearer_to_any_side_of_a_notch) {
  // A block with a slot from above that is narrower than twice the distance.
  const Trace block =
      page_trace({{0, 200}, {200, 200}, {200, 100}, {110, 100}, {110, 150}, {95, 150}, {95, 100}, {0, 100}});
  const double distance = 10;
  const std::vector<Vec2> path =
      path_beside(slice(block, 0, block.length), Clearance(block), [&](double) { return distance; });
  const Trace fine = densify(block, 0.5);
  double nearest = 1e9, farthest = 0;
  for (const Vec2& point : path) {
    double here = 1e9;
    for (const Vec2& other : fine.points) here = std::min(here, (point - other).norm());
    nearest = std::min(nearest, here);
    farthest = std::max(farthest, here);
  }
  EXPECT_GT(nearest, distance - 0.2);
  EXPECT_LT(farthest, distance + 0.2);
}

TEST(PathBeside, comes_nearer_where_there_is_no_room_at_all) {
  std::vector<Vec2> points;  // the inside of a hole: run the other way round
  for (int i = 0; i < 360; ++i) {
    const double angle = 2 * kPi * i / 360;
    points.emplace_back(100 + 20 * std::cos(angle), 100 + 20 * std::sin(angle));
  }
  const Trace hole = page_trace(points);
  const std::vector<Vec2> path = path_beside(slice(hole, 0, 60), Clearance(hole), [](double) { return 30.0; });
  ASSERT_GE(path.size(), 2U);
  for (const Vec2& point : path) EXPECT_LT((point - Vec2(100, 100)).norm(), 20.1);
}

TEST(Labels, stand_clear_of_lines_and_of_one_another) {
  Obstacles obstacles(300, 300);
  const std::vector<Vec2> line = {Vec2(20, 150), Vec2(280, 150)};
  obstacles.add(line);
  obstacles.finish();
  std::vector<LabelRequest> requests;
  for (int i = 0; i < 10; ++i) requests.push_back({{Vec2(140 + 3 * i, 150)}, Vec2(0, -1), Vec2(20, 12)});
  const std::vector<LabelPlace> places = place_labels(requests, obstacles);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_GE(std::abs(places[i].centre.y() - 150), 6);
    for (std::size_t k = 0; k < i; ++k) {
      const Vec2 apart = (places[i].centre - places[k].centre).cwiseAbs();
      EXPECT_TRUE(apart.x() >= 20 || apart.y() >= 12) << i << " and " << k;
    }
  }
}

TEST(Labels, stay_on_the_page) {
  Obstacles obstacles(100, 100);
  obstacles.finish();
  const std::vector<LabelPlace> places = place_labels({{{Vec2(99, 50)}, Vec2(1, 0), Vec2(20, 12)}}, obstacles);
  EXPECT_LE(places[0].centre.x(), 91);
}

TEST(Ticks, are_round_and_cover_the_range) {
  EXPECT_THAT(round_ticks({0, 1}, 5).at, ElementsAre(0, 0.2, testing::DoubleEq(0.4), testing::DoubleEq(0.6), 0.8, 1));
  EXPECT_THAT(round_ticks({-3, 8}, 5).at, ElementsAre(-2, 0, 2, 4, 6, 8));
  EXPECT_THAT(degree_ticks({80, 460}, 5).at, ElementsAre(90, 180, 270, 360, 450));
}

TEST(Ticks, of_any_range_are_neither_too_few_nor_too_many) {
  for (double size = 1e-9; size < 1e9; size *= 1.7) {
    for (const Ticks& ticks : {round_ticks({3, 3 + size}, 6), degree_ticks({0, size}, 6)}) {
      EXPECT_GE(ticks.at.size(), 2U) << size;
      EXPECT_LE(ticks.at.size(), 17U) << size;
    }
  }
}

TEST(Numerals, have_a_true_minus_sign_and_no_negative_zero) {
  EXPECT_EQ(pretty(-1.25), "\u22121.25");
  EXPECT_EQ(pretty(-0.0), "0");
  EXPECT_EQ(pretty_degrees(-kPi / 2), "\u221290\u00b0");
  EXPECT_EQ(tick_text(-0.001, 1), "0.0");
  EXPECT_EQ(tick_text(-0.5, 1), "\u22120.5");
}

}  // namespace
}  // namespace draw_layout_test
