// The place of a polygon that is nearest to a touch with its normal, against the closed form: each side by itself, and
// each convex corner with the normals between its sides.
#include "touch/nearest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "random.hpp"
#include "touch/touch_cases.hpp"

namespace nearest_place_test {

namespace {

using rollfix::Vec2;
using rollfix::touch::InPart;
using touch_cases::polygon;
using touch_cases::uniform;

constexpr double kPi = std::numbers::pi;

// A plate with a tab, narrower than what places are off by, and with a notch.
const std::vector<Vec2> kPlate{{0, 0},   {40, 0}, {40, 20}, {22, 20}, {22, 23}, {19, 23},
                               {19, 20}, {8, 20}, {8, 17},  {6, 17},  {6, 20},  {0, 20}};

double turned(double angle) { return std::remainder(angle, 2 * kPi); }
double angle_of(const Vec2& along) { return std::atan2(along.y(), along.x()); }

double least_by_closed_form(const InPart& touch) {
  double least = std::numeric_limits<double>::infinity();
  const std::size_t n = kPlate.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 from = kPlate[k], side = kPlate[(k + 1) % n] - from, next = kPlate[(k + 2) % n] - kPlate[(k + 1) % n];
    const double share = std::clamp((touch.at - from).dot(side) / side.squaredNorm(), 0.0, 1.0);
    const double off = turned(*touch.tangent - angle_of(side)) / touch.angle_unit;
    least = std::min(least, (touch.at - from - share * side).squaredNorm() / std::pow(touch.place_unit, 2) + off * off);
    const double corner = turned(angle_of(next) - angle_of(side));
    if (corner <= 0) continue;
    const double past = turned(*touch.tangent - angle_of(side) - 0.5 * corner);
    const double beyond = std::max(0.0, std::abs(past) - 0.5 * corner) / touch.angle_unit;
    least = std::min(least, (touch.at - from - side).squaredNorm() / std::pow(touch.place_unit, 2) + beyond * beyond);
  }
  return least;
}

}  // namespace

TEST(NearestPlace, OfATouchWithItsNormalIsAsFarAsTheClosedFormSays) {
  const rollfix::Part part = polygon(kPlate);
  const rollfix::touch::CentrePath path(part, 0, nullptr);
  rollfix::touch::PathTree tree(path);
  std::mt19937_64 generator = test_generator(1);
  for (int k = 0; k < test_count(2000); ++k) {
    InPart touch{
        {uniform(generator, -3, 43), uniform(generator, -3, 26)}, true, uniform(generator, -kPi, kPi), 1, 0.01};
    const double square = distance_at(nearest_place(tree, touch).point, touch).square;
    EXPECT_NEAR(square, least_by_closed_form(touch), 1e-4 * (1 + square))
        << touch.at.transpose() << ", " << *touch.tangent;
  }
}

/// A circle is one spiral, so that the tree's first disc is wider than the part.
TEST(NearestPlace, FarFromThePartIsBetweenBothBounds) {
  const rollfix::Part circle(rollfix::gallery("circle,r=1"));
  rollfix::touch::PartDistance distance(circle);
  std::mt19937_64 generator = test_generator(2);
  for (int k = 0; k < test_count(2000); ++k) {
    const Vec2 point(uniform(generator, -9, 9), uniform(generator, -9, 9));
    const rollfix::Interval between = distance.between(point);
    EXPECT_LE(between.lo, point.norm() - 1 + 1e-9) << point.transpose();
    EXPECT_GE(between.hi, point.norm() - 1 - 1e-9) << point.transpose();
  }
}

}  // namespace nearest_place_test
