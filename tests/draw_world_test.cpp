// Figures of the world: what has to be seen of a part and of fingers there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "corner_fingers.hpp"
#include "draw_helpers.hpp"
#include "plan/plans.hpp"
#include "rollfix/draw.hpp"

namespace draw_world_test {
namespace {

using draw_test::count_of;
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

/// On a circle of radius 1: finger a within half a unit of s = 0, finger b nearly known.
rollfix::HoldAnswer on_a_circle(bool continuum) {
  rollfix::HoldAnswer answer{gallery_part("circle,r=1"), {}};
  const double P = answer.part.perimeter();
  answer.rolls.resize(2);
  answer.noise = rollfix::Noise{};
  rollfix::HoldPlacement placement;
  placement.contacts.resize(2);
  placement.contacts[0].interval = placement.contacts[0].extent = {P - 0.5, P + 0.5};
  placement.contacts[1].interval = placement.contacts[1].extent = {2, 2.001};
  placement.last = {1, 0.5, 0.3};
  placement.continuum = continuum;
  answer.placements = {placement};
  return answer;
}

std::string figure_of(const rollfix::HoldAnswer& answer) { return rollfix::draw_hold({&answer}).str(); }

/// The drawn circle is as wide as two radii.
double radius_of(const std::vector<Vec2>& circle) {
  double least = circle[0].x(), most = circle[0].x();
  for (const Vec2& point : circle) {
    least = std::min(least, point.x());
    most = std::max(most, point.x());
  }
  return 0.5 * (most - least);
}

/// That of a unit of arc to both sides of the seam, on the side of the part where s = 0 is.
void expect_stretch_about_the_seam(const std::string& figure, const std::string& group) {
  const auto stretches = paths_in(figure, group);
  ASSERT_EQ(stretches.size(), 1U);
  const std::vector<Vec2>& line = stretches.front();
  const double radius = radius_of(paths_in(figure, "placement").at(0));
  EXPECT_NEAR((line.back() - line.front()).norm(), 2 * radius * std::sin(0.5), 0.05);
  EXPECT_NEAR(line.front().x(), line.back().x(), 0.05);
  EXPECT_GT(line[line.size() / 2].x(), line.front().x());
}

TEST(HoldFigure, shows_a_free_first_contact_as_the_stretch_that_it_may_be_on) {
  const std::string figure = figure_of(on_a_circle(true));
  expect_stretch_about_the_seam(figure, "interval");
  EXPECT_THAT(figure, testing::HasSubstr("finger a's first contact in 0: 95 % in 5.783 to 0.5<"));
}

TEST(HoldFigure, shows_it_without_noise_and_without_a_place_as_well) {
  rollfix::HoldAnswer answer = on_a_circle(true);
  answer.noise.reset();
  answer.place = rollfix::PlaceKnown::unknown;
  expect_stretch_about_the_seam(figure_of(answer), "extent");
}

TEST(HoldFigure, has_points_where_contacts_are_known) {
  EXPECT_EQ(count_of(figure_of(on_a_circle(false)), "<circle"), 2);
  EXPECT_EQ(count_of(figure_of(on_a_circle(false)), "class=\"interval\""), 0);
  EXPECT_EQ(count_of(figure_of(on_a_circle(true)), "<circle"), 1);
}

}  // namespace
}  // namespace draw_world_test
