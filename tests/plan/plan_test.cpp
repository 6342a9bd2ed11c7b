// What fingers have to do so that a part between them keeps rolling, and what stands in the way.
#include "rollfix/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "plans.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace rollfix::plan_test {
namespace {

using namespace plans;  // NOLINT(google-build-using-namespace): the words of this test
using testing::AllOf;
using testing::HasSubstr;

const Part& ellipse() {
  static const Part part(gallery("ellipse"));
  return part;
}

const Part& circle() {
  static const Part part(gallery("circle,r=2"));
  return part;
}

const double kAround = 4 * kPi;  // of the circle

/// Across the flat sides of an ellipse, where it is held well.
PlanProblem across(double length = 0.8, double friction = 0.5) {
  return two(ellipse(), finger(disk(0.3), 2.4, length, friction), finger(disk(0.2), 7.2, {}, friction));
}

void expect_rolls(const PlanProblem& problem, const Plan& plan) {
  for (std::size_t which = 0; which < problem.fingers.size(); ++which) {
    EXPECT_LT(slip(problem, plan, which), 1e-7) << which;
    EXPECT_LT(off_contact(problem, plan, which), 1e-9) << which;
  }
}

TEST(Plan, rolls_without_slip_at_both_contacts) {
  const PlanProblem problem = across();
  const Plan plan = solve(problem);
  ASSERT_TRUE(plan.feasible()) << verdict_text(plan, problem);
  expect_rolls(problem, plan);
}

TEST(Plan, has_velocities_that_lead_where_its_rows_are) {
  PlanProblem problem = across();
  problem.fingers[1].length = -0.4;
  problem.rows = 401;
  const Plan plan = solve(problem);
  for (const std::size_t which : {0U, 1U}) EXPECT_LT(off_integral(plan, which), 1e-6);
}

/// Two flattened fingers across the flat sides of an ellipse.
PlanProblem of_outlines(double length = 0.5) {
  const Finger flat = Finger::outlined(gallery("ellipse,a=0.5,b=0.2"));
  PlanProblem problem = two(ellipse(), finger(flat, 2.4, length), finger(flat, 7.2, -0.3));
  problem.fingers[0].u = 0.4;
  problem.fingers[1].u = 0.4;
  return problem;
}

TEST(Plan, keeps_outlines_apart_and_tells_how_far_they_are) {
  const PlanProblem problem = of_outlines();
  const Plan plan = solve(problem);
  expect_rolls(problem, plan);
  EXPECT_EQ(plan.unchecked.size(), 2U);  // their reach alone
  const PlanMargin& apart = margin_of(plan, Condition::apart);
  EXPECT_TRUE(apart.proved);
  double least = 1e9;
  for (std::size_t row = 0; row < problem.rows; ++row) {
    least = std::min(least, plans::distance_in(problem, plan, row));
  }
  EXPECT_NEAR(apart.value, least, 1e-3);
}

TEST(Plan, says_where_outlines_would_enter_each_other_unless_they_may) {
  const Finger large = Finger::outlined(gallery("ellipse,a=3,b=2"));
  PlanProblem problem = two(ellipse(), finger(large, 2.4, 0.3), finger(large, 4.6, -0.3));
  problem.fingers[0].u = problem.fingers[1].u = 2;
  const Plan plan = solve(problem);
  ASSERT_TRUE(plan.failure);
  EXPECT_EQ(plan.margins[*plan.failure].condition, Condition::apart);
  EXPECT_LT(plans::distance_in(problem, plan, plan.margins[*plan.failure].row), 0.05);  // the nearest row
  problem.may_overlap = true;
  const Plan passing = solve(problem);
  for (const PlanMargin& margin : passing.margins) EXPECT_NE(margin.condition, Condition::apart);
  problem.clearance = 0.1;
  EXPECT_THAT(refusal_of([&] { solve(problem); }), HasSubstr("leave their clearance out"));
}

TEST(Plan, of_a_part_face_down_is_that_of_a_part_drawn_the_other_way_round) {
  std::vector<Vec2> points;
  std::vector<Vec2> turned_over;
  for (int k = 0; k < 9; ++k) {
    const double r = 1 + 0.12 * std::sin(1.7 * k * k);
    points.emplace_back(r * std::cos(2 * kPi * k / 9), r * std::sin(2 * kPi * k / 9));
    turned_over.emplace_back(-points.back().x(), points.back().y());
  }
  const Part part(outline_through(points, "as drawn"));
  const Part mirrored(outline_through(turned_over, "turned over"));
  const double P = part.perimeter();
  for (const Finger& shape : {Finger(disk(0.2)), jaw(), Finger::outlined(gallery("cam"))}) {
    PlanProblem face_down = two(part, finger(shape, 0.4, 0.2), finger(disk(0.3), 0.4 + 0.5 * P, -0.2));
    if (!shape.is_disk()) face_down.fingers[0].u = 0.7;
    face_down.part_rotation = 0.3;
    PlanProblem drawn = face_down;
    drawn.part = mirrored;
    face_down.mirrored = true;
    for (PlanFinger& one : drawn.fingers) {
      one.start = P - *one.start;
      one.length = -*one.length;
    }
    const Plan a = solve(face_down);
    const Plan b = solve(drawn);
    ASSERT_EQ(a.roll.pose.size(), b.roll.pose.size());
    for (const std::size_t row : {std::size_t{0}, std::size_t{40}, std::size_t{100}}) {
      EXPECT_NEAR(a.roll.pose[row].x, b.roll.pose[row].x, 1e-8) << shape.name();
      EXPECT_NEAR(a.roll.pose[row].heading, b.roll.pose[row].heading, 1e-8);
      EXPECT_NEAR(std::remainder(a.force[row] - b.force[row], 2 * kPi), 0, 1e-8);
      for (const std::size_t which : {0U, 1U}) {
        const FingerRows& of_a = a.roll.log.fingers[which];
        const FingerRows& of_b = b.roll.log.fingers[which];
        EXPECT_NEAR(of_a.x[row], of_b.x[row], 1e-8) << shape.name();
        EXPECT_NEAR(of_a.y[row], of_b.y[row], 1e-8) << shape.name();
        EXPECT_NEAR(std::remainder(of_a.psi[row] - of_b.psi[row], 2 * kPi), 0, 1e-8) << shape.name();
        EXPECT_NEAR(a.rates[which].vx[row], b.rates[which].vx[row], 1e-6) << shape.name();
        EXPECT_NEAR(a.rates[which].omega[row], b.rates[which].omega[row], 1e-6) << shape.name();
      }
    }
  }
}

TEST(Plan, begins_and_ends_at_rest) {
  const Plan plan = solve(across());
  for (const PlanRates& rates : plan.rates) {
    EXPECT_EQ(std::hypot(rates.vx.front(), rates.vy.front(), rates.omega.front()), 0);
    EXPECT_EQ(std::hypot(rates.vx.back(), rates.vy.back(), rates.omega.back()), 0);
  }
}

TEST(Plan, is_a_log_from_which_locate_finds_its_start) {
  const PlanProblem problem = across();
  const Plan plan = solve(problem);
  const Log log = parse_log(format_plan(plan), "plan");
  const Answer answer = solve(Problem{problem.part, log, {disk(0.3), disk(0.2)}});
  EXPECT_NEAR(answer.placements.at(0).start[0], 2.4, 1e-7);
  EXPECT_NEAR(answer.placements.at(0).start[1], 7.2, 1e-7);
}

TEST(Plan, on_a_circle_needs_the_friction_of_half_the_angle_by_which_the_contacts_leave_a_diameter) {
  PlanProblem problem = two(circle(), finger(disk(0.3), 0, 1.0, 0.5), finger(disk(0.3), 0.5 * kAround, 0.2, 0.5));
  const Plan plan = solve(problem);
  EXPECT_NEAR(plan.friction_needed[0], std::tan((1.0 - 0.2) / (2 * 2)), 1e-7);
  EXPECT_NEAR(plan.friction_needed[1], std::tan((1.0 - 0.2) / (2 * 2)), 1e-7);
}

TEST(Plan, on_a_circle_rolls_the_other_finger_alike_where_it_may_choose) {
  const Plan plan = solve(two(circle(), finger(disk(0.3), 0, 5.0, 0.2), finger(disk(0.3), 0.5 * kAround, {}, 0.2)));
  ASSERT_FALSE(plan.failure);
  EXPECT_LT(plan.friction_needed[0], 0.2);
  EXPECT_NEAR(plan.length[1], 5.0, 2 * 2 * std::atan(0.2));
}

TEST(Plan, names_the_finger_that_slips_and_where_and_the_friction_that_would_do) {
  PlanProblem problem = two(circle(), finger(disk(0.3), 0, 1.0, 0.9), finger(disk(0.3), 0.5 * kAround, 0.2, 0.1));
  const Plan plan = solve(problem);
  ASSERT_TRUE(plan.failure);
  const PlanMargin& failed = plan.margins[*plan.failure];
  EXPECT_EQ(failed.condition, Condition::friction);
  EXPECT_EQ(failed.finger, 1U);
  EXPECT_NEAR((failed.place[0] - failed.place[1] + 0.5 * kAround) / 4, std::atan(0.1), 0.01);
  EXPECT_THAT(verdict_text(plan, problem), AllOf(HasSubstr("finger b slips"), HasSubstr("friction 0.2027 would do")));
}

TEST(Plan, needs_no_more_friction_by_another_way_between_the_same_ends_than_evenly) {
  PlanProblem problem = two(ellipse(), finger(disk(0.2), 2.4, 4.8, 0.45), finger(disk(0.2), 7.2, 4.9, 0.45));
  const Plan plan = solve(problem);
  problem.fingers[0].friction = problem.fingers[1].friction = std::nullopt;
  const Plan even = solve(problem);
  EXPECT_EQ(even.path, PlanPath::even);
  EXPECT_GT(std::max(even.friction_needed[0], even.friction_needed[1]),
            std::max(plan.friction_needed[0], plan.friction_needed[1]) - 1e-9);
}

TEST(Plan, presses_apart_in_a_hole) {
  Outline ring = gallery("circle,r=2");
  ring.hole = true;
  const Part hole(ring);
  const PlanProblem problem = two(hole, finger(disk(0.2), 0, 0.5, 0.5), finger(disk(0.2), 0.5 * kAround, 0.4, 0.5));
  const Plan plan = solve(problem);
  EXPECT_TRUE(plan.expanding);
  EXPECT_NEAR(plan.friction_needed[0], std::tan(0.1 / 4), 1e-7);
  expect_rolls(problem, plan);
}

TEST(Plan, presses_in_one_direction_and_shares_the_ways_between_both_fingers) {
  const Plan plan = solve(two(circle(), finger(disk(0.3), 0, 12), finger(disk(0.3), 0.5 * kAround, 12)));
  for (const double force : plan.force) EXPECT_NEAR(force, plan.force.front(), 1e-9);
  const FingerRows& a = plan.roll.log.fingers[0];
  const FingerRows& b = plan.roll.log.fingers[1];
  EXPECT_NEAR(a.x.back() - a.x.front(), -(b.x.back() - b.x.front()), 1e-12);
  EXPECT_NEAR(a.y.back() - a.y.front(), -(b.y.back() - b.y.front()), 1e-12);
}

TEST(Plan, turns_a_round_part_between_two_fingers_as_between_rollers) {
  const Plan plan = solve(two(circle(), finger(disk(0.3), 0, 12), finger(disk(0.3), 0.5 * kAround, 12)));
  EXPECT_NEAR(plan.roll.pose.back().heading - plan.roll.pose.front().heading, -12 / 2.0, 1e-9);
  EXPECT_NEAR(plan.roll.log.fingers[0].psi.back() - plan.roll.log.fingers[0].psi.front(), 12 / 0.3, 1e-9);
}

TEST(Plan, leaves_in_place_what_is_to_stay) {
  PlanProblem problem = across();
  problem.staying = Staying::a;
  const Plan of_a = solve(problem);
  problem.staying = Staying::part;
  const Plan of_part = solve(problem);
  EXPECT_NEAR(of_a.roll.log.fingers[0].x.back(), of_a.roll.log.fingers[0].x.front(), 1e-12);
  EXPECT_NEAR(of_part.roll.pose.back().x, of_part.roll.pose.front().x, 1e-12);
  expect_rolls(problem, of_part);
}

TEST(Plan, turns_the_part_as_is_asked) {
  PlanProblem problem = across();
  problem.part_rotation = 0.3;
  const Plan plan = solve(problem);
  EXPECT_NEAR(plan.roll.pose.back().heading - plan.roll.pose.front().heading, 0.3, 1e-12);
  expect_rolls(problem, plan);
}

TEST(Plan, takes_as_long_as_the_limits_ask_for) {
  PlanProblem problem = across();
  problem.limits.speed = 0.05;
  const Plan plan = solve(problem);
  EXPECT_FALSE(plan.failure);
  double fastest = 0;
  for (std::size_t k = 0; k < 101; ++k)
    fastest = std::max(fastest, std::hypot(plan.rates[0].vx[k], plan.rates[0].vy[k]));
  EXPECT_NEAR(fastest, 0.05, 1e-4);
}

TEST(Plan, refuses_what_a_limit_does_not_allow) {
  PlanProblem problem = across();
  problem.limits.rotation = 0.2;
  EXPECT_THAT(verdict_text(solve(problem), problem), HasSubstr("turns too far"));
  problem.limits.rotation.reset();
  problem.limits.travel = 0.01;
  EXPECT_THAT(verdict_text(solve(problem), problem), HasSubstr("travels too far"));
  problem.limits.travel.reset();
  problem.limits.speed = 0.01;
  problem.duration = 1;
  EXPECT_THAT(verdict_text(solve(problem), problem), HasSubstr("is too fast"));
}

TEST(Plan, keeps_fingers_from_each_other) {
  // On a thin part large disks meet around its end.
  const Part thin(gallery("ellipse,a=2,b=0.2"));
  PlanProblem problem = two(thin, finger(disk(1.2), 0.4, -0.39), finger(disk(1.2), thin.perimeter() - 0.4, 0.39));
  const Plan plan = solve(problem);
  ASSERT_TRUE(plan.failure);
  EXPECT_EQ(plan.margins[*plan.failure].condition, Condition::apart);
}

TEST(Plan, of_one_finger_on_a_part_at_rest_needs_no_friction) {
  const PlanProblem problem = one(ellipse(), finger(disk(0.3), 1, -2));
  const Plan plan = solve(problem);
  EXPECT_TRUE(plan.feasible());
  EXPECT_NEAR(plan.length[0], -2, 1e-9);
  expect_rolls(problem, plan);
}

TEST(Plan, of_one_finger_is_refused_where_it_would_hit_the_part_elsewhere) {
  const Part limacon(gallery("limacon,a=1.1,b=1"));
  const PlanProblem problem = one(limacon, finger(disk(0.08), 0.3 * limacon.perimeter(), 0.15 * limacon.perimeter()));
  const Reach reach = reach_of_disk(limacon, 0.08);
  const Plan plan = solve(problem);
  EXPECT_EQ(plan.feasible(), reach.arc_at(*problem.fingers[0].start)->hi >= 0.45 * limacon.perimeter());
}

TEST(Plan, rolls_over_the_corners_of_a_polygon) {
  const Part square(shapes::polygon({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}));
  const PlanProblem problem = two(square, finger(disk(0.3), 1, 0.6, 0.8), finger(disk(0.3), 5, 0.5, 0.8));
  const Plan plan = solve(problem);
  EXPECT_TRUE(plan.feasible()) << verdict_text(plan, problem);
  expect_rolls(problem, plan);
}

TEST(Plan, of_a_jaw_and_a_disk_rolls_as_well) {
  const PlanProblem problem = two(ellipse(), finger(jaw(), 2.4, 0.3, 0.6), finger(disk(0.3), 7.2, {}, 0.6));
  const Plan plan = solve(problem);
  EXPECT_TRUE(plan.feasible()) << verdict_text(plan, problem);
  expect_rolls(problem, plan);
}

TEST(Plan, says_what_contradicts_itself) {
  EXPECT_THAT(refusal_of([] { solve(two(ellipse(), finger(disk(0.3), 1), finger(disk(0.3), 4))); }),
              HasSubstr("expected how far finger a is to roll"));
  EXPECT_THAT(refusal_of([] { solve(two(ellipse(), finger(disk(0.3), 1, 0), finger(disk(0.3), 4))); }),
              HasSubstr("nothing would move"));
  EXPECT_THAT(refusal_of([] { solve(one(ellipse(), wheel(0.3, 1))); }), HasSubstr("a wheel is finger b"));
}

TEST(Plan, tells_whoever_proposes_rolls_why_one_can_not_be_done) {
  EXPECT_FALSE(plannable(across()));
  EXPECT_THAT(*plannable(across(3, 0.05)), HasSubstr("slips"));
  EXPECT_THAT(*plannable(two(ellipse(), finger(disk(0.3), 1), finger(disk(0.3), 4))), HasSubstr("expected"));
}

}  // namespace
}  // namespace rollfix::plan_test
