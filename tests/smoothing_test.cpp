// Points from scans: noise and pixel stairs go, the shape stays.
#include "rollfix/outline.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <random>

#include "pixels.hpp"
#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/part.hpp"
#include "scans.hpp"
#include "shapes.hpp"

namespace smoothing_test {
namespace {

using rollfix::Part;
using rollfix::smooth_spline;
using rollfix::Smoothing;
using rollfix::Vec2;
using scans::ellipse;
using scans::length_of;
using scans::limacon;
using scans::part_of;
using scans::scan;
using scans::square;
using shapes::kPi;
using testing::HasSubstr;

std::string message_of(const std::vector<Vec2>& points, double tolerance) {
  try {
    smooth_spline(points, true, tolerance);
  } catch (const rollfix::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Smoothing, inflections_are_those_of_the_shape_and_not_of_the_noise) {
  EXPECT_EQ(part_of(smooth_spline(scan(ellipse, 800, 0.01), true, 0.02)).inflections().size(), 0U);
  EXPECT_EQ(part_of(smooth_spline(scan(limacon, 800, 0.02), true, 0.05)).inflections().size(), 2U);
}

TEST(Smoothing, exact_points_are_met_the_better_the_finer_the_tolerance) {
  const std::vector<Vec2> points = scan(limacon, 400, 0);
  double last = 1;
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const Smoothing smooth = smooth_spline(points, true, tolerance);
    EXPECT_LE(smooth.deviation, tolerance);
    EXPECT_LT(std::abs(part_of(smooth).perimeter() - length_of(limacon)), last);
    last = tolerance;
  }
}

TEST(Smoothing, sparse_points_without_noise_keep_the_spline_through_them) {
  const std::vector<Vec2> points = scan(ellipse, 12, 0);
  const Smoothing smooth = smooth_spline(points, true, 1e-5);
  EXPECT_EQ(smooth.curves.size(), 12U);
  EXPECT_EQ(smooth.deviation, 0);
}

// ---- Pixel stairs.

TEST(Pixels, boundary_of_a_single_pixel_has_its_four_corners) {
  const auto inside = [](const Vec2& point) { return point.cwiseAbs().maxCoeff() < 1 && point.minCoeff() > 0; };
  EXPECT_EQ(pixels::boundary(inside, 3), (std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
}

TEST(Smoothing, disk_of_pixels_has_the_circles_perimeter_and_not_that_of_its_stairs) {
  for (const double radius : {10.3, 50.3, 300.2}) {
    const auto inside = [&](const Vec2& point) { return point.norm() < radius; };
    const std::vector<Vec2> points = pixels::boundary(inside, 302);
    const Part part = part_of(smooth_spline(points, true, 1));
    EXPECT_GT(static_cast<double>(points.size()), 1.2 * 2 * kPi * radius);  // the stairs
    EXPECT_NEAR(part.perimeter(), 2 * kPi * radius, 0.003 * 2 * kPi * radius);
    EXPECT_EQ(part.inflections().size(), 0U);
    EXPECT_EQ(part.corners().size(), 0U);
  }
}

TEST(Smoothing, ellipse_and_limacon_of_pixels_keep_perimeter_and_inflections) {
  const auto in_ellipse = [](const Vec2& point) { return Vec2(point.x() / 100, point.y() / 50).norm() < 1; };
  const Part ellipse_part = part_of(smooth_spline(pixels::boundary(in_ellipse, 110), true, 1));
  EXPECT_NEAR(ellipse_part.perimeter(), 50 * length_of(ellipse), 0.01 * 50 * length_of(ellipse));
  EXPECT_EQ(ellipse_part.inflections().size(), 0U);

  const auto in_limacon = [](const Vec2& point) { return point.norm() < 60 + 36 * point.x() / point.norm(); };
  const Part limacon_part = part_of(smooth_spline(pixels::boundary(in_limacon, 110), true, 1));
  EXPECT_NEAR(limacon_part.perimeter(), 20 * length_of(limacon), 0.01 * 20 * length_of(limacon));
  EXPECT_EQ(limacon_part.inflections().size(), 2U);
}

TEST(Smoothing, tilted_square_of_pixels_has_four_corners_and_straight_sides) {
  const Vec2 axis(std::cos(0.3), std::sin(0.3));
  const auto inside = [&](const Vec2& point) {
    return std::max(std::abs(axis.dot(point)), std::abs(rollfix::cross(axis, point))) < 40;
  };
  const Part part = part_of(smooth_spline(pixels::boundary(inside, 80), true, 1));
  EXPECT_NEAR(part.perimeter(), 320, 3.2);
  ASSERT_EQ(part.corners().size(), 4U);
  for (const rollfix::Corner& corner : part.corners()) EXPECT_NEAR(corner.turn, kPi / 2, 0.03);
}

// ---- Corners.

TEST(Smoothing, square_with_noise_keeps_its_corners_and_no_more) {
  for (const int count : {40, 400, 4000}) {
    const Smoothing smooth = smooth_spline(scan(square, count, 0.005), true, 0.012);
    const Part part = part_of(smooth);
    EXPECT_EQ(smooth.corners.size(), 4U);
    ASSERT_EQ(part.corners().size(), 4U) << count;
    for (const rollfix::Corner& corner : part.corners()) EXPECT_NEAR(corner.turn, kPi / 2, 0.1);
    EXPECT_NEAR(part.perimeter(), 4, 0.02);
  }
}

TEST(Smoothing, scan_that_starts_near_a_corner_or_within_a_side_has_the_same_corners) {
  std::vector<Vec2> points = scan(square, 400, 0.005);
  for (const int shift : {1, 3, 20, 397}) {
    std::vector<Vec2> shifted = points;
    std::rotate(shifted.begin(), shifted.begin() + shift, shifted.end());
    const Part part = part_of(smooth_spline(shifted, true, 0.012));
    EXPECT_EQ(part.corners().size(), 4U) << shift;
    EXPECT_LT((part.point(0) - shifted.front()).norm(), 0.1) << shift;
  }
}

TEST(Smoothing, corner_angle_of_pi_makes_everything_round) {
  const Smoothing smooth = smooth_spline(scan(square, 400, 0.005), true, 0.02, kPi);
  EXPECT_TRUE(smooth.corners.empty());
  EXPECT_TRUE(part_of(smooth).corners().empty());
}

// ---- Open curves and odd input.

TEST(Smoothing, open_scan_keeps_its_ends) {
  auto generator = test_generator();
  std::uniform_real_distribution<double> error(-0.005, 0.005);
  std::vector<Vec2> points;
  for (int k = 0; k < 400; ++k)
    points.emplace_back(3.0 * k / 399 + error(generator), std::sin(6.0 * k / 399) + error(generator));
  const Part part = part_of(smooth_spline(points, false, 0.02), false);
  EXPECT_LT((part.point(0) - points.front()).norm(), 0.02);
  EXPECT_LT((part.point(part.perimeter()) - points.back()).norm(), 0.02);
  const auto speed = [](double x) { return std::hypot(1, 2 * std::cos(2 * x)); };
  EXPECT_NEAR(part.perimeter(), (boost::math::quadrature::gauss_kronrod<double, 61>::integrate(speed, 0.0, 3.0)), 0.05);
}

TEST(Smoothing, two_points_make_a_line) {
  const Smoothing smooth = smooth_spline({{0, 0}, {1, 2}}, false, 0.01);
  EXPECT_NEAR(part_of(smooth, false).perimeter(), std::sqrt(5), 1e-12);
}

TEST(Smoothing, point_given_several_times_counts_once) {
  std::vector<Vec2> points = scan(ellipse, 200, 0.005);
  std::vector<Vec2> twice;
  for (const Vec2& point : points) twice.insert(twice.end(), {point, point});
  EXPECT_EQ(part_of(smooth_spline(points, true, 0.02)).perimeter(),
            part_of(smooth_spline(twice, true, 0.02)).perimeter());
}

TEST(Smoothing, tolerance_that_is_no_length_or_too_large_is_refused) {
  const std::vector<Vec2> points = scan(ellipse, 40, 0);
  for (const double tolerance : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(), 5.0}) {
    EXPECT_THAT(message_of(points, tolerance), HasSubstr("expected a length above 0 and at most 0.2236"));
  }
  EXPECT_EQ(message_of(points, 0.2), "no error");
}

TEST(Smoothing, bad_points_are_refused_as_by_the_spline) {
  EXPECT_THAT(message_of({{0, 0}, {1, 0}}, 0.01), HasSubstr("at least 3"));
  EXPECT_THAT(message_of({{0, 0}, {1, std::nan("")}, {0, 1}}, 0.01), HasSubstr("expected finite numbers"));
}

TEST(Smoothing, points_files_are_smoothed_with_a_note) {
  std::string text = "scan\n";
  for (const Vec2& point : scan(ellipse, 400, 0.005))
    text += fmt::format("{},{}\n{},{}\n", point.x(), point.y(), point.x(), point.y());
  rollfix::OutlineOptions options;
  options.smooth = 0.02;
  std::vector<std::string> notes;
  const std::vector<Vec2> points = rollfix::parse_points(text, "scan.csv", options, &notes);
  const rollfix::Outline outline = rollfix::outline_through(points, "scan.csv", options, &notes);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes.front(), HasSubstr("smoothed: within 0.02 of all 800 points (largest deviation 0.0"));
  EXPECT_LT(outline.curves.size(), 40U);
}

}  // namespace
}  // namespace smoothing_test
