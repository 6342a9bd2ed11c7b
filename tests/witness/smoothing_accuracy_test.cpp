// How near a smoothed scan is to its points and to the shape that was scanned.
#include "rollfix/outline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/part.hpp"
#include "scans.hpp"
#include "shapes.hpp"

namespace smoothing_accuracy_test {
namespace {

using rollfix::Curve;
using rollfix::Part;
using rollfix::smooth_spline;
using rollfix::Smoothing;
using rollfix::Vec2;
using scans::ellipse;
using scans::Formula;
using scans::length_of;
using scans::limacon;
using scans::part_of;
using scans::scan;
using shapes::kPi;

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

}  // namespace

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

TEST(Smoothing, more_points_do_not_make_more_spirals) {
  const std::size_t few = part_of(smooth_spline(scan(ellipse, 300, 0.005), true, 0.02)).turning().spirals().size();
  const std::size_t many = part_of(smooth_spline(scan(ellipse, 10000, 0.005), true, 0.02)).turning().spirals().size();
  EXPECT_LT(few, 40U);
  EXPECT_LT(many, 40U);
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

}  // namespace smoothing_accuracy_test
