// Figures of the world: what has to be seen of a part and of fingers there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "corner_fingers.hpp"
#include "draw_helpers.hpp"
#include "plan/plans.hpp"
#include "rollfix/draw.hpp"

namespace draw_world_test {
namespace {

using draw_test::gallery_part;
using draw_test::paths_in;
using rollfix::Vec2;

/// Of a line on the page: where it turns by more than 60 degrees.
int sharp_turns(const std::vector<Vec2>& line) {
  int turns = 0;
  for (std::size_t k = 1; k + 1 < line.size(); ++k) {
    const Vec2 in = (line[k] - line[k - 1]).normalized(), out = (line[k + 1] - line[k]).normalized();
    turns += in.dot(out) < 0.5 ? 1 : 0;
  }
  return turns;
}

/// The figure of a plan by which this finger rolls a little.
std::string figure_of_plan(const rollfix::Finger& finger) {
  const rollfix::PlanProblem problem = plans::one(gallery_part("cam"), plans::finger(finger, 2, 0.3));
  const rollfix::Plan plan = rollfix::solve(problem);
  return rollfix::draw_plan({&plan, &problem}).str();
}

TEST(PlanFigure, has_the_corners_of_a_finger) {
  // None of them is a whole number of 96ths round it.
  const corner_fingers::Polygon tip{{{0.23, 0}, {0.23, 0.4}, {-0.2, 0.4}, {-0.2, 0}}};
  EXPECT_EQ(sharp_turns(paths_in(figure_of_plan(tip.finger()), "finger").at(0)), 4);
}

}  // namespace
}  // namespace draw_world_test
