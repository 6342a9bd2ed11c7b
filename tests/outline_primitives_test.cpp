// Lines, arcs, cubic spans, and outlines run backwards.
#include "rollfix/curve.hpp"
#include "shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

namespace outline_primitives_test {
namespace {

using rollfix::Arc;
using rollfix::CubicSpan;
using rollfix::Curve;
using rollfix::InputError;
using rollfix::Jet;
using rollfix::Line;
using rollfix::Outline;
using rollfix::Vec2;
using shapes::random_point;
using std::numbers::pi;

TEST(Line, ends_are_exact_to_the_last_bit) {
  auto generator = test_generator();
  for (int i = 0; i < test_count(200); ++i) {
    const Vec2 from = random_point(generator);
    const Vec2 to = random_point(generator);
    const Curve line = Line(from, to);
    EXPECT_EQ(line.front(), from);
    EXPECT_EQ(line.back(), to);
  }
}

TEST(Line, without_length_is_refused) { EXPECT_THROW(Line({1, 2}, {1, 2}), InputError); }

TEST(Arc, full_circle_closes_to_the_last_bit) {
  auto generator = test_generator();
  std::uniform_real_distribution<double> angle(-7, 7);
  for (int i = 0; i < test_count(200); ++i) {
    const Curve circle = Arc(random_point(generator), 3, angle(generator), i % 2 == 0 ? 2 * pi : -2 * pi);
    EXPECT_EQ(circle.front(), circle.back());
    EXPECT_EQ(circle.velocity(0), circle.velocity(2 * pi));
  }
}

TEST(Arc, counter_clockwise_arc_turns_left) {
  const Curve arc = Arc({1, 2}, 4, 0, pi / 2);
  EXPECT_EQ(arc.front(), Vec2(5, 2));
  EXPECT_NEAR((arc.back() - Vec2(1, 6)).norm(), 0, 1e-15);
  EXPECT_EQ(arc.velocity(0), Vec2(0, 4));
  EXPECT_NEAR(curvature(arc.jet(0.3)), 0.25, 1e-16);
  EXPECT_NEAR(curvature_rate(arc.jet(0.3)), 0, 1e-16);
}

TEST(Arc, clockwise_arc_turns_right) {
  const Curve arc = Arc({0, 0}, 2, pi, -pi);
  EXPECT_NEAR((arc.front() - Vec2(-2, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((arc.position(pi / 2) - Vec2(0, 2)).norm(), 0, 1e-15);
  EXPECT_NEAR((arc.back() - Vec2(2, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR(curvature(arc.jet(1)), -0.5, 1e-16);
}

TEST(Arc, impossible_arc_is_refused) {
  EXPECT_THROW(Arc({0, 0}, 0, 0, 1), InputError);
  EXPECT_THROW(Arc({0, 0}, -1, 0, 1), InputError);
  EXPECT_THROW(Arc({0, 0}, 1, 0, 0), InputError);
  EXPECT_THROW(Arc({0, 0}, 1, 0, 7), InputError);
  EXPECT_THROW(Arc({0, 0}, 1, std::nan(""), 1), InputError);
}

TEST(CubicSpan, ends_are_exact_to_the_last_bit) {
  auto generator = test_generator();
  for (int i = 0; i < test_count(200); ++i) {
    const Vec2 from = random_point(generator);
    const Vec2 to = random_point(generator);
    const Curve span = CubicSpan(from, to, random_point(generator), random_point(generator));
    EXPECT_EQ(span.front(), from);
    EXPECT_EQ(span.back(), to);
  }
}

TEST(CubicSpan, is_the_polynomial_it_documents) {
  const Vec2 from(1, 2), to(4, 0), square(-1, 3), cube(2, 0.5);
  const CubicSpan span(from, to, square, cube);
  const Vec2 slope = to - from - square - cube;
  for (const double u : {0.0, 0.25, 0.6, 1.0}) {
    const Jet jet = span.jet(u);
    EXPECT_NEAR((jet.position - (from + u * slope + u * u * square + u * u * u * cube)).norm(), 0, 1e-15);
    EXPECT_NEAR((jet.first - (slope + 2 * u * square + 3 * u * u * cube)).norm(), 0, 1e-15);
    EXPECT_NEAR((jet.second - (2 * square + 6 * u * cube)).norm(), 0, 1e-15);
    EXPECT_NEAR((jet.third - 6 * cube).norm(), 0, 1e-15);
    EXPECT_EQ(span.velocity(u), jet.first);
  }
}

TEST(CubicSpan, has_the_second_derivatives_asked_for) {
  const Curve span = CubicSpan::with_second_derivatives({0, 0}, {1, 0}, {0, -6}, {0, 12});
  EXPECT_EQ(span.jet(0).second, Vec2(0, -6));
  EXPECT_EQ(span.jet(1).second, Vec2(0, 12));
}

TEST(ReversedOutline, keeps_the_first_point_and_runs_the_other_way) {
  const Outline outline = rollfix::gallery("reuleaux");
  const Outline backwards = reversed(outline);
  ASSERT_EQ(backwards.curves.size(), 3U);
  EXPECT_NEAR((backwards.curves.front().front() - outline.curves.front().front()).norm(), 0, 1e-15);
  EXPECT_EQ(backwards.curves.front().back(), outline.curves.back().front());
  EXPECT_NEAR(curvature(backwards.curves[1].jet(0.5)), -1, 1e-15);
  EXPECT_TRUE(backwards.closed);
}

TEST(ReversedOutline, of_an_open_one_starts_at_its_end) {
  const Outline outline = rollfix::gallery("exponential");
  const Outline backwards = reversed(outline);
  EXPECT_EQ(backwards.curves.front().front(), outline.curves.back().back());
  EXPECT_FALSE(backwards.closed);
}

TEST(ReversedOutline, twice_is_the_original) {
  const Outline outline = rollfix::gallery("naca");
  const Outline same = reversed(reversed(outline));
  EXPECT_FALSE(same.reversed);
  for (std::size_t i = 0; i < outline.curves.size(); ++i) {
    const double u = outline.curves[i].domain().middle();
    EXPECT_NEAR((same.curves[i].velocity(u) - outline.curves[i].velocity(u)).norm(), 0, 1e-14);
  }
}

}  // namespace
}  // namespace outline_primitives_test
