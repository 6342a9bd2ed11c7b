// What places and arcs of a boundary are: closed forms, and laws on random ones against places counted one by one.
#include "rollfix/turning_function.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "part/cursor.hpp"
#include "part/turning_range.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace boundary_test {

using rollfix::Boundary;
using rollfix::Cursor;
using rollfix::Interval;
using rollfix::Part;
using rollfix::Side;
using rollfix::wrap;
using testing::DoubleEq;
using testing::DoubleNear;

constexpr double kPi = std::numbers::pi;
constexpr Boundary kLoop{10, true};
constexpr Boundary kOpen{10, false};

void expect_arc(const Interval& arc, double lo, double hi) {
  EXPECT_THAT(arc.lo, DoubleNear(lo, 1e-14));
  EXPECT_THAT(arc.hi, DoubleNear(hi, 1e-14));
}

TEST(Wrap, takes_whole_periods_off_and_counts_them) {
  EXPECT_EQ(wrap(3, 10).winding, 0);
  EXPECT_THAT(wrap(-1, 10).base, DoubleEq(9));
  EXPECT_EQ(wrap(-1, 10).winding, -1);
  EXPECT_THAT(wrap(27, 10).base, DoubleEq(7));
  EXPECT_EQ(wrap(27, 10).winding, 2);
  EXPECT_EQ(wrap(10, 10).base, 0);
}

TEST(Wrap, never_reaches_the_period_and_adds_up) {
  std::mt19937_64 generator = test_generator();
  std::uniform_real_distribution<double> exponent(-18, 6);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < test_count(2000); ++k) {
    const double period = std::pow(10, exponent(generator) / 6);
    const double value = unit(generator) * std::pow(10, exponent(generator));
    const auto [base, winding] = wrap(value, period);
    EXPECT_GE(base, 0);
    EXPECT_LT(base, period);
    EXPECT_EQ(winding, std::round(winding));
    EXPECT_NEAR(base + winding * period, value, 1e-15 * (std::abs(value) + period));
  }
}

TEST(Boundary, a_place_just_before_the_seam_is_named_0) {
  EXPECT_EQ(kLoop.canonical(10 - 1e-12), 0);
  EXPECT_EQ(kLoop.canonical(-1e-13), 0);
  EXPECT_THAT(kLoop.canonical(9.9), DoubleEq(9.9));
  EXPECT_EQ(kOpen.canonical(10 - 1e-12), 10 - 1e-12);
}

TEST(Boundary, of_an_open_one_places_stay_on_it) {
  EXPECT_EQ(kOpen.base(-3), 0);
  EXPECT_EQ(kOpen.base(13), 10);
  EXPECT_EQ(kOpen.on_first_lap(13), 13);
  EXPECT_EQ(kLoop.on_first_lap(13), 3);
  EXPECT_EQ(kOpen.reduced(13).winding, 0);
}

TEST(Boundary, from_before_the_seam_is_at_the_end_of_the_lap) {
  EXPECT_EQ(kLoop.reduced(20, Side::before).base, 10);
  EXPECT_EQ(kLoop.reduced(20, Side::before).winding, 1);
  EXPECT_EQ(kLoop.reduced(20).base, 0);
  EXPECT_EQ(kLoop.reduced(20).winding, 2);
  EXPECT_EQ(kOpen.reduced(0, Side::before).base, 0);
}

TEST(Boundary, distances_go_the_shorter_way_round) {
  EXPECT_THAT(kLoop.distance(1, 9), DoubleEq(2));
  EXPECT_THAT(kOpen.distance(1, 9), DoubleEq(8));
  EXPECT_THAT(kLoop.offset(1, 9), DoubleEq(-2));
  EXPECT_THAT(kLoop.offset(9, 21), DoubleEq(2));
  EXPECT_THAT(kOpen.offset(9, 1), DoubleEq(-8));
  EXPECT_THAT(kLoop.ahead(9, 1), DoubleEq(2));
  EXPECT_THAT(kOpen.ahead(9, 1), DoubleEq(-8));
}

TEST(Boundary, an_arc_has_one_name) {
  expect_arc(kLoop.arc(-1, 2), 9, 12);
  expect_arc(kLoop.arc(38, 41), 8, 11);
  expect_arc(kLoop.arc(-3, 7.5), 0, 10);
  expect_arc(kLoop.arc(10 - 1e-13, 10 - 1e-13), 0, 0);
  expect_arc(kOpen.arc(-1, 2), 0, 2);
  expect_arc(kOpen.arc(8, 11), 8, 10);
}

TEST(Boundary, the_empty_arc_holds_nothing_and_is_far_from_everything) {
  for (const Boundary& boundary : {kLoop, kOpen}) {
    const Interval empty = boundary.empty_arc();
    EXPECT_TRUE(boundary.is_empty(empty));
    EXPECT_FALSE(boundary.is_full(empty));
    EXPECT_FALSE(boundary.contains(empty, 3));
    EXPECT_EQ(boundary.distance(empty, 3), std::numeric_limits<double>::infinity());
    EXPECT_FALSE(boundary.intersects(empty, boundary.full_arc()));
    EXPECT_TRUE(boundary.covers({1, 1}, empty));
    EXPECT_FALSE(boundary.covers(empty, {1, 1}));
    EXPECT_TRUE(boundary.is_empty(boundary.arc(3, 2)));
  }
}

TEST(Boundary, the_full_arc_holds_everything) {
  for (const Boundary& boundary : {kLoop, kOpen}) {
    const Interval full = boundary.full_arc();
    EXPECT_TRUE(boundary.is_full(full));
    for (const double s : {0.0, 3.0, 10.0}) EXPECT_TRUE(boundary.contains(full, s));
    EXPECT_TRUE(boundary.covers(full, {2, 9}));
    EXPECT_TRUE(boundary.intersects(full, {5, 5}));
  }
  EXPECT_TRUE(kLoop.is_full({3, 13}));
  EXPECT_TRUE(kLoop.contains({3, 13}, 2.5));
  EXPECT_FALSE(kOpen.contains(kOpen.full_arc(), 10.5));
}

TEST(Boundary, a_wrapped_arc_goes_on_across_the_seam) {
  const Interval arc{9, 12};
  EXPECT_TRUE(kLoop.contains(arc, 0));
  EXPECT_TRUE(kLoop.contains(arc, 2));
  EXPECT_TRUE(kLoop.contains(arc, 22));
  EXPECT_FALSE(kLoop.contains(arc, 2.1));
  EXPECT_TRUE(kLoop.contains(arc, 2.1, 0.1));
  EXPECT_TRUE(kLoop.contains(arc, 8.9, 0.11));
  EXPECT_THAT(kLoop.distance(arc, 4), DoubleEq(2));
  EXPECT_THAT(kLoop.distance(arc, 8), DoubleEq(1));
  EXPECT_TRUE(kLoop.intersects(arc, {1.5, 1.6}));
  EXPECT_FALSE(kLoop.intersects(arc, {3, 8}));
  EXPECT_TRUE(kLoop.covers(arc, {0, 1}));
  EXPECT_FALSE(kLoop.covers(arc, {1, 3}));
  EXPECT_FALSE(kOpen.contains({9, 10}, 0));
  EXPECT_THAT(kOpen.distance({9, 10}, 0), DoubleEq(9));
}

/// Arcs and places whose sums are exact, so that a place counts as held or not without doubt: a grid of eighths on a
/// loop of 10, looked at one lap after the other.
class Grid {
 public:
  explicit Grid(std::mt19937_64& generator) : generator_(generator) {}

  double place() { return 0.125 * std::uniform_int_distribution<int>(-400, 400)(generator_); }
  Interval arc(int longest) {
    const double lo = place();
    return {lo, lo + 0.125 * std::uniform_int_distribution<int>(0, longest)(generator_)};
  }
  static bool holds(const Boundary& boundary, const Interval& arc, double s) {
    for (int lap = boundary.closed ? -20 : 0; lap <= (boundary.closed ? 20 : 0); ++lap) {
      if (arc.contains(s + 10 * lap)) return true;
    }
    return false;
  }

 private:
  std::mt19937_64& generator_;
};

TEST(Boundary, arcs_agree_with_places_that_are_looked_at_one_by_one) {
  std::mt19937_64 generator = test_generator();
  Grid grid(generator);
  for (int k = 0; k < test_count(2000); ++k) {
    const Boundary boundary{10, k % 3 != 0};
    const Interval one = grid.arc(90);
    const Interval other = grid.arc(60);
    const double s = grid.place();
    const bool is_held = Grid::holds(boundary, one, s);
    EXPECT_EQ(boundary.contains(one, s), is_held) << one.lo << " " << one.hi << " " << s;
    EXPECT_EQ(boundary.distance(one, s) == 0, is_held);
    double least = std::numeric_limits<double>::infinity();
    bool meets = false;
    bool covers = true;
    for (double at = one.lo; at <= one.hi; at += 0.125) {
      least = std::min(least, boundary.distance(at, s));
      meets = meets || Grid::holds(boundary, other, at);
    }
    for (double at = other.lo; at <= other.hi; at += 0.0625) covers = covers && Grid::holds(boundary, one, at);
    EXPECT_EQ(boundary.distance(one, s), least);
    EXPECT_EQ(boundary.intersects(one, other), meets);
    EXPECT_EQ(boundary.intersects(other, one), meets);
    EXPECT_EQ(boundary.covers(one, other), covers) << one.lo << " " << one.hi << " " << other.lo << " " << other.hi;
    if (!boundary.closed) continue;
    const Interval named = boundary.arc(one.lo, one.hi);
    EXPECT_GE(named.lo, 0);
    EXPECT_LT(named.lo, 10);
    EXPECT_EQ(boundary.contains(named, s), is_held);
    EXPECT_EQ(boundary.offset(one.lo, s), -boundary.offset(s, one.lo));
    EXPECT_EQ(std::abs(boundary.offset(one.lo, s)), boundary.distance(one.lo, s));
  }
}

Part part_of(const char* shape) { return Part(rollfix::load_outline(std::string("gallery:") + shape)); }

TEST(Cursor, meets_every_spiral_once_a_lap_and_theta_goes_on) {
  for (const char* shape : {"cam", "reuleaux", "limacon"}) {
    const Part part = part_of(shape);
    const auto& turning = part.turning();
    const std::size_t count = turning.spirals().size();
    Cursor cursor(turning, -1.5 * part.perimeter());
    EXPECT_EQ(cursor.winding(), -2);
    for (std::size_t k = 0; k < 3 * count; ++k) {
      const double end = cursor.hi();
      const double angle = cursor.spiral().end.angle + cursor.lift();
      cursor.advance();
      EXPECT_NEAR(cursor.lo(), end, 1e-12 * part.perimeter());
      EXPECT_NEAR(cursor.angle_before(), angle, 1e-12);
      EXPECT_NEAR(cursor.angle_after(), turning.angle(cursor.lo() + 1e-13 * part.perimeter()), 1e-9);
    }
    EXPECT_EQ(cursor.winding(), 1);
    for (std::size_t k = 0; k < 3 * count; ++k) cursor.retreat();
    EXPECT_EQ(cursor.winding(), -2);
    EXPECT_FALSE(cursor.is_first());
    EXPECT_FALSE(cursor.is_last());
  }
}

TEST(Cursor, passes_corners) {
  const Part part = part_of("reuleaux");
  for (const rollfix::Corner& corner : part.corners()) {
    const Cursor cursor(part.turning(), corner.s);
    EXPECT_NEAR(cursor.lo(), corner.s, 1e-12);
    EXPECT_NEAR(cursor.angle_after() - cursor.angle_before(), corner.turn, 1e-12);
    EXPECT_NEAR(Cursor(part.turning(), corner.s, Side::before).hi(), corner.s, 1e-12);
  }
}

TEST(Cursor, ends_where_an_open_part_does) {
  const Part part = part_of("log-spiral");
  const Cursor first(part.turning(), -1);
  const Cursor last(part.turning(), part.perimeter() + 1);
  EXPECT_TRUE(first.is_first());
  EXPECT_TRUE(last.is_last());
  EXPECT_EQ(first.lo(), 0);
  EXPECT_EQ(last.hi(), part.perimeter());
  EXPECT_EQ(first.angle_before(), first.angle_after());
}

TEST(AnglesOver, hold_theta_everywhere_on_an_arc_and_reach_it) {
  std::mt19937_64 generator = test_generator();
  std::uniform_real_distribution<double> unit(0, 1);
  for (const char* shape : {"cam", "reuleaux", "limacon", "log-spiral"}) {
    const Part part = part_of(shape);
    const double P = part.perimeter();
    const rollfix::TurningRange table(part.turning(), 1024);
    for (int k = 0; k < test_count(50); ++k) {
      const double lo = part.closed() ? (3 * unit(generator) - 1) * P : 0.5 * P * unit(generator);
      const Interval arc{lo, lo + 0.5 * P * unit(generator)};
      const Interval angles = rollfix::angles_over(part.turning(), arc);
      Interval seen{1e9, -1e9};
      for (int i = 0; i <= 4000; ++i) {
        const double angle = part.turning().angle(arc.lo + arc.width() * i / 4000);
        seen = {std::min(seen.lo, angle), std::max(seen.hi, angle)};
      }
      EXPECT_LE(angles.lo, seen.lo + 1e-12);
      EXPECT_GE(angles.hi, seen.hi - 1e-12);
      EXPECT_GE(angles.lo, seen.lo - 0.01);
      EXPECT_LE(angles.hi, seen.hi + 0.01);
      const Interval bounds = table.over(arc.lo, arc.hi);
      EXPECT_LE(bounds.lo, angles.lo);
      EXPECT_GE(bounds.hi, angles.hi);
      EXPECT_LE(bounds.width(), angles.width() + 0.05 + (shape == std::string("reuleaux") ? 4 * kPi / 3 : 0));
    }
  }
}

TEST(AnglesOver, of_many_laps_are_those_of_the_first_and_the_last) {
  for (const char* shape : {"cam", "reuleaux", "limacon"}) {
    const Part part = part_of(shape);
    const double P = part.perimeter();
    const Interval few = rollfix::angles_over(part.turning(), {0.3 * P, 2.1 * P});  // two laps at most: one by one
    const Interval many = rollfix::angles_over(part.turning(), {0.3 * P, 7.1 * P});
    EXPECT_NEAR(many.lo, few.lo, 1e-11);
    EXPECT_NEAR(many.hi, few.hi + 5 * part.turning().period_turn(), 1e-11);
    // Walked along it takes days.
    const Interval laps = rollfix::angles_over(part.turning(), {0.3 * P, 0.3 * P + 1e9 * P});
    EXPECT_NEAR(laps.width(), 1e9 * part.turning().period_turn(), 10);
  }
}

TEST(AnglesOver, hold_all_of_a_corner_at_their_ends) {
  const Part part = part_of("reuleaux");
  for (const rollfix::Corner& corner : part.corners()) {
    EXPECT_NEAR(rollfix::angles_over(part.turning(), {corner.s, corner.s}).width(), corner.turn, 1e-12);
    EXPECT_GE(rollfix::angles_over(part.turning(), {corner.s - 0.1, corner.s}).width(), corner.turn);
  }
}

}  // namespace boundary_test
