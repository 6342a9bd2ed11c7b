// The turning function against closed forms and against quadrature that shares nothing with it.

#include "rollfix/turning_function.hpp"

#include <gtest/gtest.h>

#include <GeographicLib/EllipticFunction.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <memory>
#include <numbers>

#include "random.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

namespace turning_function_test {
namespace {

using namespace rollfix;
constexpr double kPi = std::numbers::pi;

/// 1e-12 rad, or what the last digit of s is worth where the curvature is extreme.
double attainable(const Part& part) {
  return std::max(1e-12, 1e-15 * part.perimeter() * part.turning().most_curvature());
}

double angle_off(double angle, double expected) { return std::abs(std::remainder(angle - expected, 2 * kPi)); }

/// A cycloid's arch between parameters lo and hi: x = t - sin t, y = 1 - cos t, traversed from right to left so that
/// it turns left. Known: s = 4 (cos(t / 2) - cos(hi / 2)) and the tangent's turn is (hi - t) / 2.
struct Cycloid {
  Interval range;
  Interval domain() const { return {-range.hi, -range.lo}; }
  Jet jet(double u) const {
    const double t = -u;
    const double c = std::cos(t);
    const double s = std::sin(t);
    return {{t - s, 1 - c}, {c - 1, -s}, {s, c}, {c, -s}};
  }
};

/// y = cosh x: s = sinh x - sinh lo, the tangent's angle is atan(sinh x).
struct Catenary {
  Interval range;
  Interval domain() const { return range; }
  Jet jet(double u) const { return {{u, std::cosh(u)}, {1, std::sinh(u)}, {0, std::cosh(u)}, {0, std::sinh(u)}}; }
};

TEST(TurningFunction, of_a_circle_is_a_straight_line_of_slope_one_over_r) {
  const Part part(gallery("circle,r=2.5"));
  EXPECT_NEAR(part.perimeter(), 5 * kPi, 1e-15 * 5 * kPi);
  for (const double s : {0.0, 1.0, 7.7, 15.7, 40.0, -3.0}) {
    EXPECT_NEAR(part.turning().angle(s), kPi / 2 + s / 2.5, 1e-14 * (1 + std::abs(s)));
    EXPECT_NEAR(part.turning().curvature(s), 0.4, 1e-15);
  }
}

TEST(TurningFunction, of_an_ellipse_agrees_with_the_elliptic_integral) {
  for (const double b : {0.97, 0.5, 0.1, 0.02}) {
    const Part part(gallery("ellipse,a=1,b=" + std::to_string(b)));
    const double modulus = std::sqrt(1 - b * b);
    const double quarter = boost::math::ellint_2(modulus);
    ASSERT_NEAR(part.perimeter(), 4 * quarter, 1e-12 * 4 * quarter) << "b = " << b;
    auto generator = test_generator();
    std::uniform_real_distribution<double> parameter(0, 2 * kPi);
    for (int k = 0; k < test_count(1000); ++k) {
      const double u = parameter(generator);
      const double s = quarter - boost::math::ellint_2(modulus, kPi / 2 - u);
      const double expected = std::atan2(b * std::cos(u), -std::sin(u));
      EXPECT_LT(angle_off(part.turning().angle(s), expected), attainable(part)) << "b = " << b << ", u = " << u;
    }
  }
}

TEST(TurningFunction, of_an_ellipse_agrees_with_geographiclib) {
  const Part part(gallery("ellipse,a=1,b=0.5"));
  const GeographicLib::EllipticFunction elliptic(0.75);
  EXPECT_NEAR(part.perimeter(), 4 * elliptic.E(), 1e-12 * part.perimeter());
  for (double s = 0.01; s < 1.2; s += 0.05) {  // in the first quadrant: s = E - E(pi / 2 - u)
    const double u = kPi / 2 - elliptic.Einv(elliptic.E() - s);
    EXPECT_LT((part.point(s) - Vec2(std::cos(u), 0.5 * std::sin(u))).norm(), 1e-12);
  }
}

TEST(TurningFunction, of_a_logarithmic_spiral_grows_with_the_logarithm_of_the_length) {
  const Part part(gallery("log-spiral,a=1,b=0.2,turns=2"));
  const double scale = std::sqrt(1 + 0.04) / 0.2;
  const double length = scale * (std::exp(0.2 * 4 * kPi) - 1);
  ASSERT_NEAR(part.perimeter(), length, 1e-12 * length);
  const double first = part.turning().angle(0);
  for (double s = 0; s < length; s += 0.03 * length) {
    EXPECT_NEAR(part.turning().angle(s) - first, std::log(1 + s / scale) / 0.2, 1e-12);
  }
}

TEST(TurningFunction, of_a_cycloid_turns_by_half_the_rolling_angle) {
  const Part part(Outline{"cycloid", {Curve(Cycloid{{0.3, 5.9}})}, false});
  const double length = 4 * (std::cos(0.15) - std::cos(2.95));
  ASSERT_NEAR(part.perimeter(), length, 1e-12 * length);
  const double first = part.turning().angle(0);
  for (double t = 5.9; t > 0.3; t -= 0.1) {
    EXPECT_NEAR(part.turning().angle(4 * (std::cos(t / 2) - std::cos(2.95))) - first, (5.9 - t) / 2, 1e-12);
  }
}

TEST(TurningFunction, of_a_catenary_is_the_gudermannian) {
  const Part part(Outline{"catenary", {Curve(Catenary{{-2, 3}})}, false});
  for (double x = -2; x < 3; x += 0.1) {
    EXPECT_NEAR(part.turning().angle(std::sinh(x) - std::sinh(-2.0)), std::atan(std::sinh(x)), 1e-12);
  }
}

class TurningOfShape : public testing::TestWithParam<std::string> {};

TEST_P(TurningOfShape, has_arc_length_and_turn_as_quadrature_gives_them) {
  using boost::math::quadrature::gauss_kronrod;
  const Outline outline = gallery(GetParam());
  const Part part(outline);
  double s = 0;
  double turn = 0;
  const double first = part.turning().angle(0);
  double corners = 0;
  for (std::size_t k = 0; k < outline.curves.size(); ++k) {
    const Curve& curve = outline.curves[k];
    for (const Corner& corner : part.corners()) {
      if (k > 0 && std::abs(corner.s - s) < 1e-9 * part.perimeter()) corners += corner.turn;
    }
    const int cells = 16;
    for (int cell = 0; cell < cells; ++cell) {
      const double lo = curve.domain().lo + curve.domain().width() * cell / cells;
      const double hi =
          cell + 1 == cells ? curve.domain().hi : curve.domain().lo + curve.domain().width() * (cell + 1) / cells;
      s += gauss_kronrod<double, 61>::integrate([&](double u) { return curve.jet(u).first.norm(); }, lo, hi, 4, 1e-14);
      turn += gauss_kronrod<double, 61>::integrate(
          [&](double u) { return curvature(curve.jet(u)) * curve.jet(u).first.norm(); }, lo, hi, 4, 1e-14);
      const double before_corner = s * (1 - 4e-15);  // the sum may be a last digit beyond it
      EXPECT_NEAR(part.turning().angle(before_corner), first + turn + corners, 5 * attainable(part)) << "s = " << s;
    }
  }
  EXPECT_NEAR(part.perimeter(), s, 1e-12 * s);
}

TEST_P(TurningOfShape, has_spirals_on_which_the_curvature_is_monotone_and_keeps_its_sign) {
  const Part part(gallery(GetParam()));
  const TurningFunction& turning = part.turning();
  const double noise = 1e-9 * turning.most_curvature();
  double end = 0;
  for (const Spiral& spiral : turning.spirals()) {
    EXPECT_EQ(spiral.lo, end);
    end = spiral.hi;
    double last = spiral.start.curvature;
    for (int k = 1; k < 50; ++k) {
      const double now = turning.curvature(spiral.lo + (spiral.hi - spiral.lo) * k / 50);
      EXPECT_GE((now - last) * (spiral.trend == 0 ? 0 : spiral.trend), -noise);
      EXPECT_GE(now * (spiral.start.curvature + spiral.end.curvature), -noise * noise - noise * std::abs(now));
      last = now;
    }
  }
  EXPECT_EQ(end, part.perimeter());
}

TEST_P(TurningOfShape, turns_by_whole_turns_around_a_closed_outline_and_is_unwrapped_in_both_directions) {
  const Part part(gallery(GetParam()));
  if (!part.closed()) return;
  EXPECT_EQ(part.turns(), 1);
  const TurningFunction& turning = part.turning();
  for (const double s : {0.123, 0.77}) {
    const double base = s * part.perimeter();
    for (const int laps : {-3, -1, 1, 2, 5}) {
      EXPECT_NEAR(turning.angle(base + laps * part.perimeter()) - turning.angle(base), laps * 2 * kPi, 1e-11);
    }
  }
}

TEST_P(TurningOfShape, finds_a_point_from_its_arc_length) {
  const Part part(gallery(GetParam()));
  const int count = 2000;
  double length = 0;
  for (int k = 0; k < count; ++k) {
    length += (part.point(part.perimeter() * (k + 1) / count * (1 - 1e-15)) - part.point(part.perimeter() * k / count))
                  .norm();
  }
  EXPECT_NEAR(length, part.perimeter(), 1e-3 * part.perimeter());  // a polygon is a little shorter
}

std::vector<std::string> every_shape() {
  std::vector<std::string> names;
  for (const GalleryShape& shape : gallery_shapes()) names.push_back(shape.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Gallery, TurningOfShape, testing::ValuesIn(every_shape()), shapes::as_identifier);

/// A curve that counts how often it is asked.
struct Counted {
  EllipticArc curve;
  std::shared_ptr<int> calls = std::make_shared<int>(0);
  Interval domain() const { return curve.domain(); }
  Jet jet(double u) const { return ++*calls, curve.jet(u); }
  Vec2 velocity(double u) const { return ++*calls, curve.velocity(u); }
};

TEST(TurningFunction, is_made_of_few_looks_at_the_curve) {
  const Counted counted{EllipticArc({0, 0}, {2, 0}, {0, 1}, 0, 2 * kPi)};
  const Part part(Outline{"ellipse", {counted}, true}, PartOptions{true});
  EXPECT_LT(*counted.calls, 42 * part.turning().panels().size());  // of them 17 where the arc length is even
}

TEST(TurningFunction, jumps_at_a_corner_and_has_both_limits) {
  const Part square(gallery("polygon,n=4,r=1"));
  ASSERT_EQ(square.corners().size(), 4U);
  const double s = square.corners()[1].s;
  EXPECT_NEAR(square.turning().angle(s, Side::after) - square.turning().angle(s, Side::before), kPi / 2, 1e-14);
  EXPECT_NEAR(square.turning().angle(0, Side::after) - square.turning().angle(0, Side::before), kPi / 2, 1e-14);
  EXPECT_EQ(square.turning().curvature(0.3), 0);
}

TEST(TurningFunction, has_the_same_bits_on_every_run) {
  const Part one(gallery("spline,seed=3"));
  const Part two(gallery("spline,seed=3"));
  for (double s = 0; s < one.perimeter(); s += 0.0173) {
    EXPECT_EQ(one.turning().at(s).angle, two.turning().at(s).angle);
    EXPECT_EQ(one.turning().at(s).curvature, two.turning().at(s).curvature);
  }
}

}  // namespace
}  // namespace turning_function_test
