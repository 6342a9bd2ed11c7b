#include "touch/heading_arc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "random.hpp"
#include "touch_cases.hpp"

// Headings by which a vector of the part, somewhere in a rectangle, may be one of the world: by vectors drawn from it.
namespace heading_arc_test {

using rollfix::nearest_angle;
using rollfix::Vec2;
using rollfix::touch::HeadingArc;
using rollfix::touch::VectorBox;
using touch_cases::uniform;

Vec2 at_angle(double angle, double length = 1) { return length * Vec2(std::cos(angle), std::sin(angle)); }

VectorBox random_box(std::mt19937_64& generator) {
  const double ahead = uniform(generator, -3, 3), left = uniform(generator, -3, 3);
  const double half_ahead = uniform(generator, 0, 2), half_left = std::pow(10, uniform(generator, -6, 0));
  return {at_angle(uniform(generator, -3, 3)),
          {ahead - half_ahead, ahead + half_ahead},
          {left - half_left, left + half_left}};
}

/// Draws a vector of the box, a heading, and what the world has of it, off by at most the slack.
void expect_holds_what_is_drawn(std::mt19937_64& generator, double slack) {
  const VectorBox box = random_box(generator);
  const double heading = uniform(generator, -std::numbers::pi, std::numbers::pi);
  const Vec2 part =
      box.vector(uniform(generator, box.ahead.lo, box.ahead.hi), uniform(generator, box.left.lo, box.left.hi));
  const Vec2 off = at_angle(uniform(generator, -3, 3), slack * uniform(generator, 0, 1));
  const Vec2 world = rollfix::Pose{0, 0, heading}.turned(part) + off;
  const HeadingArc arc = rollfix::touch::headings_between(box, world, slack);
  EXPECT_LE(std::abs(nearest_angle(heading - arc.middle)), arc.half + 1e-12);
}

TEST(HeadingArc, OfARectangleOfVectorsHoldsTheHeadingOfEach) {
  std::mt19937_64 generator = test_generator(1);
  for (int k = 0; k < test_count(20000); ++k) expect_holds_what_is_drawn(generator, 1e-3);
  for (int k = 0; k < test_count(20000); ++k) expect_holds_what_is_drawn(generator, 0.3);
}

TEST(HeadingArc, OfALongThinRectangleIsNarrowWhereTheLengthSaysWhereOnItTheVectorEnds) {
  const HeadingArc arc = rollfix::touch::headings_between(VectorBox{{1, 0}, {0, 40}, {2.999, 3.001}}, {4, 3}, 1e-3);
  EXPECT_NEAR(nearest_angle(arc.middle), 0, 1e-3);  // a vector of length 5, and 3 across, is 4 ahead
  EXPECT_LT(arc.half, 1e-3);
}

TEST(HeadingArc, IsEmptyWhereNoVectorIsSoLong) {
  EXPECT_TRUE(rollfix::touch::headings_between(VectorBox{{1, 0}, {0, 40}, {3, 4}}, {2, 0}, 0.5).is_empty());
  EXPECT_TRUE(rollfix::touch::headings_between(VectorBox{{1, 0}, {-1, 1}, {3, 4}}, {5, 0}, 0.5).is_empty());
}

}  // namespace heading_arc_test
