// The spline through points: against a dense solve of the conditions that define it, and its rules on corners.
#include "rollfix/outline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/error.hpp"

namespace outline_spline_test {
namespace {

using rollfix::cross;
using rollfix::Curve;
using rollfix::InputError;
using rollfix::Jet;
using rollfix::spline_through;
using rollfix::Vec2;
using std::numbers::pi;
using testing::HasSubstr;

constexpr double kNoCorners = pi;
constexpr bool kClosed = true;
constexpr bool kOpen = false;

std::vector<Vec2> random_star(std::mt19937_64& generator, int n) {
  std::uniform_real_distribution<double> radius(0.7, 1.3);
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * pi * i / n;
    points.push_back(radius(generator) * Vec2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

std::vector<Vec2> on_circle(int n) {
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) points.emplace_back(std::cos(2 * pi * i / n), std::sin(2 * pi * i / n));
  return points;
}

/// The unit square, `per_side` points a side, from the corner (0, 0), counter-clockwise.
std::vector<Vec2> on_square(int per_side) {
  const std::vector<Vec2> corners = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  std::vector<Vec2> points;
  for (std::size_t side = 0; side < 4; ++side) {
    for (int k = 0; k < per_side; ++k) {
      const double part = static_cast<double>(k) / per_side;
      points.push_back((1 - part) * corners[side] + part * corners[side + 1]);
    }
  }
  return points;
}

double chord(const std::vector<Vec2>& points, std::size_t i) {
  return (points[(i + 1) % points.size()] - points[i]).norm();
}

/// A curve's derivatives by chord length.
struct Derivatives {
  Vec2 first;
  Vec2 second;
};

Derivatives by_chord_length(const Curve& curve, double u, double length) {
  const Jet jet = curve.jet(u);
  return {jet.first / length, jet.second / (length * length)};
}

/// The spline's defining conditions as one dense system: on each span an unknown cubic in local chord length, unknowns
/// 4i to 4i + 3. Shares nothing with the library's solver.
Eigen::MatrixX2d dense_spline(const std::vector<Vec2>& points, bool closed) {
  const Eigen::Index spans = static_cast<Eigen::Index>(points.size()) - (closed ? 0 : 1);
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(4 * spans, 4 * spans);
  Eigen::MatrixX2d values = Eigen::MatrixX2d::Zero(4 * spans, 2);
  Eigen::Index row = 0;
  const auto derivative_row = [&](Eigen::Index span, double h, int order, double sign) {
    for (int power = order; power < 4; ++power) {
      double factor = sign;
      for (int k = 0; k < order; ++k) factor *= power - k;
      conditions(row, 4 * span + power) += factor * std::pow(h, power - order);
    }
  };
  for (Eigen::Index i = 0; i < spans; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const double h = chord(points, index);
    derivative_row(i, 0, 0, 1);
    values.row(row++) = points[index].transpose();
    derivative_row(i, h, 0, 1);
    values.row(row++) = points[(index + 1) % points.size()].transpose();
    if (i + 1 == spans && !closed) continue;
    for (const int order : {1, 2}) {
      derivative_row(i, h, order, 1);
      derivative_row((i + 1) % spans, 0, order, -1);
      ++row;
    }
  }
  if (!closed) {
    derivative_row(0, 0, 2, 1);
    ++row;
    derivative_row(spans - 1, chord(points, static_cast<std::size_t>(spans - 1)), 2, 1);
  }
  return conditions.fullPivLu().solve(values);
}

void expect_same_as_dense(const std::vector<Vec2>& points, bool closed) {
  const std::vector<Curve> curves = spline_through(points, closed, kNoCorners);
  const Eigen::MatrixX2d expected = dense_spline(points, closed);
  ASSERT_EQ(4 * curves.size(), static_cast<std::size_t>(expected.rows()));
  for (std::size_t i = 0; i < curves.size(); ++i) {
    for (const double u : {0.0, 0.3, 0.9}) {
      const double x = u * chord(points, i);
      const Eigen::RowVector4d powers(1, x, x * x, x * x * x);
      const Vec2 point = (powers * expected.middleRows(4 * static_cast<Eigen::Index>(i), 4)).transpose();
      EXPECT_NEAR((curves[i].position(u) - point).norm(), 0, 1e-12) << "span " << i << ", u = " << u;
    }
  }
}

bool is_straight(const Curve& curve) {
  const Jet jet = curve.jet(0.4);
  return jet.second == Vec2::Zero() && jet.third == Vec2::Zero();
}

/// How far the tangent turns from the end of one curve to the start of the next.
double turn_between(const std::vector<Curve>& curves, std::size_t before, std::size_t after) {
  const Vec2 a = curves[before].velocity(curves[before].domain().hi);
  const Vec2 b = curves[after].velocity(curves[after].domain().lo);
  return std::atan2(cross(a, b), a.dot(b));
}

std::size_t corner_count(const std::vector<Curve>& curves) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (std::abs(turn_between(curves, i, (i + 1) % curves.size())) > 1e-9) ++count;
  }
  return count;
}

std::string message_of(const std::vector<Vec2>& points, bool closed, double corner_angle = rollfix::kCornerAngle) {
  try {
    spline_through(points, closed, corner_angle);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Spline, runs_through_its_points_exactly) {
  auto generator = test_generator();
  const std::vector<Vec2> points = random_star(generator, 23);
  const std::vector<Curve> curves = spline_through(points, kClosed);
  ASSERT_EQ(curves.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(curves[i].front(), points[i]);
    EXPECT_EQ(curves[i].back(), points[(i + 1) % points.size()]);
  }
}

TEST(Spline, has_continuous_second_derivative_everywhere_seam_included) {
  auto generator = test_generator();
  const std::vector<Vec2> points = random_star(generator, 12);
  const std::vector<Curve> curves = spline_through(points, kClosed, kNoCorners);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t next = (i + 1) % points.size();
    const Derivatives end = by_chord_length(curves[i], 1, chord(points, i));
    const Derivatives start = by_chord_length(curves[next], 0, chord(points, next));
    EXPECT_NEAR((end.first - start.first).norm(), 0, 1e-14) << i;
    EXPECT_NEAR((end.second - start.second).norm(), 0, 1e-13) << i;
  }
}

TEST(Spline, closed_is_the_solution_of_its_defining_conditions) {
  auto generator = test_generator();
  for (int i = 0; i < test_count(20); ++i) expect_same_as_dense(random_star(generator, 3 + i % 15), kClosed);
}

TEST(Spline, open_is_the_solution_of_its_defining_conditions) {
  auto generator = test_generator();
  for (int i = 0; i < test_count(20); ++i) expect_same_as_dense(random_star(generator, 3 + i % 15), kOpen);
}

TEST(Spline, open_ends_are_not_curved) {
  const std::vector<Curve> curves = spline_through({{0, 0}, {1, 0.3}, {2, 0.1}, {3, 1}}, kOpen);
  EXPECT_EQ(curves.front().jet(0).second, Vec2(0, 0));
  EXPECT_EQ(curves.back().jet(1).second, Vec2(0, 0));
  EXPECT_NE(curves.front().jet(1).second, Vec2(0, 0));
}

TEST(Spline, approaches_a_circle_with_the_fourth_power_of_the_spacing) {
  const auto error = [](int n) {
    double worst = 0;
    for (const Curve& curve : spline_through(on_circle(n), kClosed)) {
      worst = std::max(worst, std::abs(curve.position(0.5).norm() - 1));
    }
    return worst;
  };
  EXPECT_NEAR(error(40) / error(80), 16, 0.5);
}

TEST(Spline, three_points_make_a_closed_curve) {
  EXPECT_EQ(corner_count(spline_through(on_circle(3), kClosed, kNoCorners)), 0U);
}

TEST(Spline, takes_a_million_points) {
  const std::vector<Vec2> points = on_circle(1000000);
  const std::vector<Curve> curves = spline_through(points, kClosed);
  ASSERT_EQ(curves.size(), points.size());
  EXPECT_NEAR(curvature(curves[123456].jet(0.5)), 1, 1e-4);  // the points' own rounding, divided by the spacing squared
}

TEST(Corners, four_points_of_a_square_give_four_lines) {
  const std::vector<Curve> curves = spline_through(on_square(1), kClosed);
  ASSERT_EQ(curves.size(), 4U);
  for (const Curve& curve : curves) EXPECT_TRUE(is_straight(curve));
  EXPECT_EQ(corner_count(curves), 4U);
}

TEST(Corners, forty_points_on_a_square_give_straight_sides) {
  const std::vector<Curve> curves = spline_through(on_square(10), kClosed);
  ASSERT_EQ(curves.size(), 40U);
  for (const Curve& curve : curves) EXPECT_TRUE(is_straight(curve));
  EXPECT_EQ(corner_count(curves), 4U);
}

TEST(Corners, slanted_sides_are_straight_too) {
  const Eigen::Rotation2Dd rotation(0.3);
  std::vector<Vec2> points = on_square(10);
  for (Vec2& point : points) point = rotation * point + Vec2(3, -7);
  for (const Curve& curve : spline_through(points, kClosed)) EXPECT_TRUE(is_straight(curve));
}

TEST(Corners, hexagon_has_corners_and_octagon_is_round) {
  EXPECT_EQ(corner_count(spline_through(on_circle(6), kClosed)), 6U);
  EXPECT_EQ(corner_count(spline_through(on_circle(7), kClosed)), 0U);
  EXPECT_EQ(corner_count(spline_through(on_circle(8), kClosed)), 0U);
}

TEST(Corners, angle_says_which_turns_are_corners) {
  EXPECT_EQ(corner_count(spline_through(on_circle(8), kClosed, 46 * pi / 180)), 0U);
  EXPECT_EQ(corner_count(spline_through(on_circle(8), kClosed, 44 * pi / 180)), 8U);
  EXPECT_EQ(corner_count(spline_through(on_circle(100), kClosed, 0)), 100U);
}

/// A drop: its tip is the only corner.
const std::vector<Vec2> kDrop = {{2, 0},    {1, 0.7},      {0, 0.8},  {-0.6, 0.45},
                                 {-0.8, 0}, {-0.6, -0.45}, {0, -0.8}, {1, -0.7}};

TEST(Corners, first_point_may_be_one) {
  const std::vector<Curve> curves = spline_through(kDrop, kClosed);
  EXPECT_EQ(corner_count(curves), 1U);
  EXPECT_GT(turn_between(curves, 7, 0), 1);
  EXPECT_EQ(curves.front().jet(0).second, Vec2(0, 0));
}

TEST(Corners, curve_runs_across_a_first_point_that_is_none) {
  std::vector<Vec2> begun_elsewhere = kDrop;
  std::rotate(begun_elsewhere.begin(), begun_elsewhere.begin() + 2, begun_elsewhere.end());
  const std::vector<Curve> from_tip = spline_through(kDrop, kClosed);
  const std::vector<Curve> from_side = spline_through(begun_elsewhere, kClosed);
  EXPECT_EQ(from_side.front().front(), Vec2(0, 0.8));
  for (std::size_t i = 0; i < kDrop.size(); ++i) {
    EXPECT_EQ(from_side[i].velocity(0.5), from_tip[(i + 2) % kDrop.size()].velocity(0.5)) << i;
  }
}

TEST(Corners, pieces_between_them_are_splines_of_their_own) {
  // Two bumps that meet in corners: each is the natural spline through its own points.
  const std::vector<Vec2> loop = {{0, 0}, {1, -0.5}, {2, -0.6}, {3, -0.4}, {4, 0}, {3, 0.4}, {2, 0.9}, {1, 0.5}};
  const std::vector<Curve> curves = spline_through(loop, kClosed, pi / 3);
  const std::vector<Vec2> lower(loop.begin(), loop.begin() + 5);
  const std::vector<Curve> alone = spline_through(lower, kOpen, kNoCorners);
  ASSERT_EQ(corner_count(curves), 2U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(curves[i].velocity(0.5), alone[i].velocity(0.5));
}

TEST(Corners, sharp_trailing_edge_is_one) {
  // A wing section with 41 points, from the trailing edge over the top.
  std::vector<Vec2> section;
  for (int i = 0; i < 41; ++i) {
    const double x = 0.5 * (1 + std::cos(2 * pi * i / 41));
    section.emplace_back(x, (i <= 20 ? 0.3 : -0.2) * std::sqrt(x) * (1 - x));
  }
  const std::vector<Curve> curves = spline_through(section, kClosed);
  EXPECT_EQ(corner_count(curves), 1U);
  EXPECT_GT(turn_between(curves, 40, 0), 2.5);
}

TEST(Corners, two_points_make_an_open_line) {
  const std::vector<Curve> curves = spline_through({{0, 0}, {3, 4}}, kOpen);
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_TRUE(is_straight(curves[0]));
}

TEST(Spline, bad_input_is_refused_with_its_place) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message_of({{0, 0}, {1, 0}}, kClosed), HasSubstr("2 points: a closed curve needs at least 3"));
  EXPECT_THAT(message_of({{0, 0}}, kOpen), HasSubstr("1 points: an open curve needs at least 2"));
  EXPECT_THAT(message_of({{0, 0}, {1, nan}, {1, 1}}, kClosed), HasSubstr("point 1 of a spline is (1, nan)"));
  EXPECT_THAT(message_of({{0, 0}, {1, 0}, {1, 0}, {0, 1}}, kClosed), HasSubstr("points 1 and 2 of a spline are both"));
  EXPECT_THAT(message_of({{0, 0}, {1, 0}, {0, 1}, {0, 0}}, kClosed), HasSubstr("points 3 and 0 of a spline are both"));
  EXPECT_THAT(message_of(on_circle(8), kClosed, 59), HasSubstr("corner angle of 59 rad: expected 0 to pi"));
}

}  // namespace
}  // namespace outline_spline_test
