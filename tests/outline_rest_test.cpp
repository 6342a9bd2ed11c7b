// Bezier curves that start or end at rest: control points next to an end that are that one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "beziers.hpp"
#include "random.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

namespace outline_rest_test {
namespace {

using beziers::bernstein;
using beziers::bow;
using beziers::open_outline;
using rollfix::Bezier;
using rollfix::bezier_curves;
using rollfix::BezierFromRest;
using rollfix::check;
using rollfix::cross;
using rollfix::Curve;
using rollfix::InputError;
using rollfix::Outline;
using rollfix::Part;
using rollfix::Vec2;
using shapes::random_point;
using std::numbers::pi;
using testing::IsEmpty;
using testing::SizeIs;

/// The cubic with these control points, its length and turn by its own polynomial, from which the factor of u in the
/// velocity is taken out.
struct RestingCubic {
  Vec2 rest, near, far;  // control points: rest, rest, near, far

  Vec2 slope(double u) const { return 6 * (1 - u) * (near - rest) + 3 * u * (far - near); }  // velocity / u
  double length() const {
    const auto speed = [&](double u) { return u * slope(u).norm(); };
    return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(speed, 0, 1, 20, 1e-14);
  }
  double turn() const { return std::atan2(cross(slope(0), slope(1)), slope(0).dot(slope(1))); }
  std::vector<Vec2> points() const { return {rest, rest, near, far}; }
};

const RestingCubic kResting{{1, 2}, {3, 5}, {8, 3}};

TEST(BezierFromRest, is_the_same_curve) {
  const Curve usual = Bezier(kResting.points());
  const BezierFromRest resting(kResting.points());
  EXPECT_EQ(Curve(resting).front(), usual.front());
  EXPECT_EQ(Curve(resting).back(), usual.back());
  for (const double v : {0.5, 0.9, 0.95, 0.99}) {
    const Vec2 place = resting.jet(v).position;
    // The usual parameter from the distance along the first handle's direction.
    double lo = 0, hi = 1;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (lo + hi);
      (usual.position(middle).x() < place.x() ? lo : hi) = middle;
    }
    EXPECT_NEAR((usual.position(lo) - place).norm(), 0, 1e-14) << v;
  }
}

TEST(BezierFromRest, derivatives_are_right) {
  EXPECT_THAT(check(open_outline({BezierFromRest(kResting.points())})), IsEmpty());
  std::vector<Vec2> backwards = kResting.points();
  std::reverse(backwards.begin(), backwards.end());
  EXPECT_THAT(check(open_outline({BezierFromRest(backwards, {}, rollfix::Rest::end)})), IsEmpty());
  EXPECT_THAT(check(open_outline({BezierFromRest(kResting.points(), {1, 2, 0.5, 3})})), IsEmpty());
}

TEST(BezierFromRest, has_its_tangent_at_the_resting_end) {
  const BezierFromRest resting(kResting.points());
  const Vec2 ahead = resting.jet(0).first.normalized();
  EXPECT_NEAR(cross(ahead, (kResting.near - kResting.rest).normalized()), 0, 1e-11);
  EXPECT_GT(ahead.dot(kResting.near - kResting.rest), 0);
}

TEST(BezierFromRest, has_its_record) {
  EXPECT_EQ(BezierFromRest(kResting.points()).record().kind, "bezier-from-rest");
  EXPECT_EQ(BezierFromRest(bow(4), {}, rollfix::Rest::end).record().kind, "bezier-to-rest");
  EXPECT_EQ(BezierFromRest(kResting.points(), {1, 2, 1, 1}).record().numbers[2], 1);
}

TEST(PartOfRestingBezier, has_the_length_and_turn_of_the_cubic) {
  auto generator = test_generator();
  for (int i = 0; i < test_count(50); ++i) {
    const RestingCubic cubic{random_point(generator), random_point(generator), random_point(generator)};
    const Part part(open_outline(bezier_curves(cubic.points())), {true});
    EXPECT_NEAR(part.perimeter(), cubic.length(), 1e-12 * cubic.length());
    EXPECT_NEAR(std::remainder(part.total_turn() - cubic.turn(), 2 * pi), 0, 2e-11);
  }
}

TEST(PartOfRestingBezier, has_no_false_inflections_or_vertices_near_the_resting_end) {
  // The curvature falls all the way from infinity.
  const Part part(open_outline(bezier_curves({{0, 0}, {0, 0}, {2, 0}, {3, 3}})));
  EXPECT_THAT(part.inflections(), IsEmpty());
  EXPECT_THAT(part.vertices(), testing::Each(testing::Gt(0.1)));
  EXPECT_LT(part.turning().spirals().size(), 4U);
}

TEST(PartOfRestingBezier, turns_like_the_square_root_of_the_length) {
  // Near the resting end u = sqrt(s / (3 |near|)), and the turn is u |far x near| / (2 |near|^2).
  const Part part(open_outline(bezier_curves({{0, 0}, {0, 0}, {2, 0}, {3, 3}})));
  for (const double s : {1e-10, 1e-12, 1e-16}) {
    const double expected = std::sqrt(s / 6) * 6 / (2 * 4);
    EXPECT_NEAR(part.turning().angle(s), expected, 4e-12 + 2 * std::sqrt(s) * expected) << s;
  }
}

TEST(PartOfRestingBezier, far_from_the_beginning_has_numbers_on_every_spiral) {
  // Its first panels are shorter there than what an arc length is rounded to.
  Outline outline = open_outline({rollfix::Line({-100, 0}, {0, 0})});
  for (const Curve& curve : bezier_curves({{0, 0}, {0, 0}, {2, 0}, {3, 3}})) outline.curves.push_back(curve);
  const Part part(outline);
  double last = 0;
  for (const rollfix::Spiral& spiral : part.turning().spirals()) {
    EXPECT_GT(spiral.hi, spiral.lo);
    EXPECT_TRUE(std::isfinite(spiral.start.curvature) && std::isfinite(spiral.end.curvature)) << spiral.lo;
    EXPECT_GE(spiral.start.angle, last);
    last = spiral.end.angle;
  }
  const double s = 1e-9;  // as in the next test
  EXPECT_NEAR(part.turning().angle(100 + s), std::sqrt(s / 6) * 6 / (2 * 4), 2e-7);
  EXPECT_NEAR(part.total_turn(), std::atan2(3, 1), 1e-11);
}

TEST(PartOfRestingBezier, at_both_ends_joins_smoothly_in_the_middle) {
  const auto curves = bezier_curves({{0, 0}, {0, 0}, {2, 0}, {2, 0}});
  EXPECT_THAT(curves, SizeIs(1));  // straight
  // Handles that cross give an S, with both ends at rest.
  const std::vector<Vec2> points = {{0, 0}, {0, 0}, {1, 2}, {3, 1}, {4, 0}, {4, 0}};
  const auto halves = bezier_curves(points);
  ASSERT_THAT(halves, SizeIs(2));
  EXPECT_EQ(halves[0].back(), halves[1].front());
  EXPECT_NEAR((halves[0].back() - bernstein(points, {}, 0.5)).norm(), 0, 1e-15);
  const Part part(open_outline(halves));
  EXPECT_THAT(part.corners(), IsEmpty());
  const Curve usual = Bezier(points);
  const auto speed = [&](double u) { return usual.velocity(u).norm(); };
  const double length = boost::math::quadrature::gauss_kronrod<double, 61>::integrate(speed, 0, 1, 20, 1e-14);
  EXPECT_NEAR(part.perimeter(), length, 1e-12 * length);
}

TEST(PartOfRestingBezier, is_built_however_near_the_handle_is) {
  for (double gap = 1; gap > 1e-20; gap /= 8) {
    const std::vector<Vec2> points = {{0, 0}, {0, gap}, {2, 0}, {3, 3}};
    const auto curves = bezier_curves(points);
    const Part part(open_outline(curves), {true});
    const double turn = part.total_turn();
    EXPECT_NEAR(turn, gap < 5.4e-15 ? std::atan2(3, 1) : std::atan2(3, 1) - pi / 2, 2e-11) << gap;
    const RestingCubic at_rest{{0, 0}, {2, 0}, {3, 3}};
    EXPECT_NEAR(part.perimeter(), at_rest.length(), 2 * gap + 1e-12) << gap;
  }
}

TEST(BezierCurves, straight_ones_are_lines) {
  const auto kind = [](const std::vector<Vec2>& points) { return bezier_curves(points).at(0).record()->kind; };
  EXPECT_EQ(kind({{0, 0}, {0, 0}, {3, 3}, {3, 3}}), "line");
  EXPECT_EQ(kind({{0, 0}, {1, 1}, {2, 2}, {3, 3}}), "line");
  EXPECT_EQ(kind({{0, 0}, {3, 1}}), "line");
  EXPECT_EQ(kind({{0, 0}, {4, 4}, {1, 1}, {3, 3}}), "bezier");  // runs back on its way
  EXPECT_EQ(kind({{0, 0}, {1, 1}, {2, 2.001}, {3, 3}}), "bezier");
}

TEST(BezierCurves, a_point_is_nothing) {
  EXPECT_THAT(bezier_curves({{1, 2}, {1, 2}, {1, 2}}), IsEmpty());
  EXPECT_THROW(bezier_curves({{1, 2}}), InputError);
}

TEST(LocateAtRest, lists_only_what_fits) {
  const Part part = shapes::drawn_with_rests();
  std::mt19937_64 generator = test_generator();
  const int count = test_count(100);  // where such a roll starts is rounded, now this way, now that
  for (int k = 0; k < count; ++k) {
    const double length = std::uniform_real_distribution<double>(-1, 1)(generator) * part.perimeter();
    for (double turn = -6; turn < 6; turn += 0.1) {
      for (const rollfix::Placement& placement : locate(part, rollfix::Reading(length, turn)).placements) {
        EXPECT_LE(placement.residual, 1e-9) << length << ", " << turn << " at " << placement.start[0];
      }
    }
  }
}

}  // namespace
}  // namespace outline_rest_test
