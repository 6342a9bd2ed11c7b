// Points from scans: noise and pixel stairs go, the shape stays.
#include "rollfix/outline/points.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <random>

#include "pixels.hpp"
#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/part/part.hpp"
#include "shapes.hpp"

namespace smoothing_test {
namespace {

using rollfix::Curve;
using rollfix::Part;
using rollfix::smooth_spline;
using rollfix::Smoothing;
using rollfix::Vec2;
using shapes::kPi;
using testing::HasSubstr;

using Formula = Vec2 (*)(double);

Vec2 ellipse(double u) { return {2 * std::cos(u), std::sin(u)}; }
Vec2 limacon(double u) { return (3 + 1.8 * std::cos(u)) * Vec2(std::cos(u), std::sin(u)); }
Vec2 square(double u) {
  const std::vector<Vec2> corners = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  const double along = 2 * u / kPi;
  const auto side = std::min<std::size_t>(3, static_cast<std::size_t>(along));
  return corners[side] + (along - static_cast<double>(side)) * (corners[side + 1] - corners[side]);
}

/// Points of a closed curve, each moved to anywhere in a square of this half width.
std::vector<Vec2> scan(Formula formula, int count, double noise, std::uint64_t stream = 0) {
  auto generator = test_generator(stream);
  std::uniform_real_distribution<double> error(-noise, noise);
  std::vector<Vec2> points;
  for (int k = 0; k < count; ++k) {
    const Vec2 exact = formula(2 * kPi * k / count);
    points.push_back(exact + Vec2(error(generator), error(generator)));
  }
  return points;
}

Part part_of(const Smoothing& smooth, bool closed = true) { return Part({"scan", smooth.curves, closed}); }

/// The distance from a point to a polyline of 200 chords per curve.
double distance(const Vec2& point, const std::vector<Curve>& curves) {
  double least = 1e300;
  for (const Curve& curve : curves) {
    const rollfix::Interval domain = curve.domain();
    Vec2 from = curve.front();
    for (int k = 1; k <= 200; ++k) {
      const Vec2 to = curve.position(domain.lo + domain.width() * k / 200);
      const Vec2 chord = to - from;
      const double share = std::clamp((point - from).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (from + share * chord - point).norm());
      from = to;
    }
  }
  return least;
}

/// How far a smoothed curve strays from the true one.
double error_of(const Part& part, Formula truth) {
  double worst = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec2 point = part.point(part.perimeter() * k / 300);
    double least = 1e300;
    for (int j = 0; j < 20000; ++j) least = std::min(least, (truth(2 * kPi * j / 20000) - point).norm());
    worst = std::max(worst, least);
  }
  return worst;
}

double length_of(Formula formula) {
  double sum = 0;
  for (int k = 0; k < 100000; ++k) sum += (formula(2 * kPi * (k + 1) / 100000) - formula(2 * kPi * k / 100000)).norm();
  return sum;
}

std::string message_of(const std::vector<Vec2>& points, double tolerance) {
  try {
    smooth_spline(points, true, tolerance);
  } catch (const rollfix::InputError& error) {
    return error.what();
  }
  return "no error";
}

// ---- Within the tolerance.

TEST(Smoothing, every_point_is_within_the_tolerance_and_the_deviation_is_the_largest_distance) {
  for (int k = 0; k < test_count(12); ++k) {
    const double tolerance = 0.004 * (1 + k % 5);
    const std::vector<Vec2> points =
        scan(k % 2 == 0 ? ellipse : limacon, 30 + 37 * k, 0.003, static_cast<std::uint64_t>(k));
    const Smoothing smooth = smooth_spline(points, true, tolerance);
    double largest = 0;
    for (const Vec2& point : points) largest = std::max(largest, distance(point, smooth.curves));
    EXPECT_LE(smooth.deviation, tolerance);
    EXPECT_LE(largest, smooth.deviation + 0.01 * tolerance) << "tolerance " << tolerance << ", case " << k;
    EXPECT_GE(largest, 0.9 * smooth.deviation) << "tolerance " << tolerance << ", case " << k;
  }
}

TEST(Smoothing, noise_of_an_ellipse_and_of_a_limacon_averages_out) {
  for (const Formula truth : {ellipse, limacon}) {
    const Part part = part_of(smooth_spline(scan(truth, 800, 0.01), true, 0.02));
    EXPECT_LT(error_of(part, truth), 0.014);  // what a single point may be off
    EXPECT_NEAR(part.perimeter(), length_of(truth), 2e-3 * length_of(truth));
    EXPECT_NEAR(part.total_turn(), 2 * kPi, 1e-9);
  }
}

TEST(Smoothing, inflections_are_those_of_the_shape_and_not_of_the_noise) {
  EXPECT_EQ(part_of(smooth_spline(scan(ellipse, 800, 0.01), true, 0.02)).inflections().size(), 0U);
  EXPECT_EQ(part_of(smooth_spline(scan(limacon, 800, 0.02), true, 0.05)).inflections().size(), 2U);
}

TEST(Smoothing, more_points_do_not_make_more_spirals) {
  const std::size_t few = part_of(smooth_spline(scan(ellipse, 300, 0.005), true, 0.02)).turning().spirals().size();
  const std::size_t many = part_of(smooth_spline(scan(ellipse, 10000, 0.005), true, 0.02)).turning().spirals().size();
  EXPECT_LT(few, 40U);
  EXPECT_LT(many, 40U);
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

TEST(Smoothing, random_walks_are_smoothed_or_refused_but_never_left_beyond_the_tolerance) {
  auto generator = test_generator();
  std::normal_distribution<double> step;
  for (int k = 0; k < test_count(60); ++k) {
    std::vector<Vec2> points = {{0, 0}};
    for (int i = 0; i < 5 + 3 * k; ++i) points.push_back(points.back() + Vec2(step(generator), step(generator)));
    const bool closed = k % 2 == 0;
    const Smoothing smooth = smooth_spline(points, closed, 0.05);
    EXPECT_LE(smooth.deviation, 0.05);
    for (const Vec2& point : points) EXPECT_LT(distance(point, smooth.curves), 0.051) << "case " << k;
  }
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
