// A part squeezed between a finger that is turned and a wheel on a free pin.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "plans.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/outline.hpp"

namespace rollfix::plan_wheel_test {
namespace {

using namespace plans;  // NOLINT(google-build-using-namespace): the words of this test
using testing::HasSubstr;

const Part& ellipse() {
  static const Part part(gallery("ellipse"));
  return part;
}

PlanProblem squeezed(const Finger& a, double length, std::optional<double> friction = {}) {
  return two(ellipse(), finger(a, 2.4, length, friction), wheel(0.3));
}

/// The moment of the wheel's force about finger a's contact, over its arm: the wheel presses along its own normal.
double moment(const PlanProblem& problem, const Plan& plan, std::size_t row) {
  const FingerRows& pin = plan.roll.log.fingers[1];
  const Vec2 at_a = contact_in_world(problem, plan, 0, row);
  const Vec2 at_b = contact_in_world(problem, plan, 1, row);
  const Vec2 normal = (at_b - Vec2(pin.x[row], pin.y[row])).normalized();
  return cross(Vec2(at_b - at_a), normal) / (at_b - at_a).norm();
}

TEST(PlanWheel, presses_through_its_pin_and_finger_as_contact_all_the_time) {
  for (const Finger& a : {jaw(), disk(0.4)}) {
    const PlanProblem problem = squeezed(a, 0.4);
    const Plan plan = solve(problem);
    for (std::size_t row = 0; row < 101; row += 10) EXPECT_NEAR(moment(problem, plan, row), 0, 1e-9);
  }
}

TEST(PlanWheel, rolls_without_slip_though_nothing_turns_it) {
  const PlanProblem problem = squeezed(jaw(), 0.4);
  const Plan plan = solve(problem);
  for (const std::size_t which : {0U, 1U}) EXPECT_LT(slip(problem, plan, which), 1e-5) << which;
  for (const std::size_t which : {0U, 1U}) EXPECT_LT(off_contact(problem, plan, which), 1e-9) << which;
}

TEST(PlanWheel, leaves_the_jaw_as_it_is_turned) {
  const Plan plan = solve(squeezed(jaw(), 0.4));
  EXPECT_NEAR(plan.roll.log.fingers[0].psi.back(), plan.roll.log.fingers[0].psi.front(), 1e-12);
}

TEST(PlanWheel, of_an_ellipse_across_its_short_axis_is_in_balance_on_the_other_end_of_it) {
  PlanProblem problem = two(ellipse(), finger(jaw(), 0.25 * ellipse().perimeter(), 0.2), wheel(0.3));
  EXPECT_NEAR(solve(problem).roll.s[1].front(), 0.75 * ellipse().perimeter(), 1e-8);
}

TEST(PlanWheel, is_told_where_it_would_be_in_balance) {
  PlanProblem problem = squeezed(jaw(), 0.2);
  problem.fingers[1].start = 6.2;
  EXPECT_THAT(refusal_of([&] { solve(problem); }), HasSubstr("give as its start t = 7.31"));
}

TEST(PlanWheel, is_refused_a_length_of_its_own) {
  PlanProblem problem = squeezed(jaw(), 0.2);
  problem.fingers[1].length = 0.2;
  EXPECT_THAT(refusal_of([&] { solve(problem); }), HasSubstr("leave the second length out"));
}

TEST(PlanWheel, whose_part_rolls_out_is_no_plan_though_no_reader_could_unwrap_its_few_rows) {
  PlanProblem problem = two(ellipse(), finger(disk(0.3), 2.3, -1.5, 5), wheel(0.2));
  problem.rows = 2;
  const Plan plan = solve(problem);
  ASSERT_TRUE(plan.failure);
  EXPECT_EQ(plan.margins[*plan.failure].condition, Condition::stable);
}

// ---- stability, against the part rolled out by hand ----

/// Part and wheel as seen by finger a, which rests: s, t, and from those all else.
struct Held {
  const Part& part;
  double radius;  // of finger a; infinite of a jaw
  double wheel;   // radius
  double s0, t0;

  double theta(double s) const { return part.turning().angle(s); }

  /// The pin when finger a's contact has moved to s and the wheel's to t.
  Vec2 pin(double s, double t) const {
    // Finger a rolls on the part: it stays, the part turns by minus what a rolling finger would.
    const double turned = -(theta(s) - theta(s0)) - (s - s0) / radius;
    const Pose part_pose{0, 0, turned};
    const double tangent = theta(s) + turned;  // of the part at the contact, in finger a's frame
    const Vec2 outward(std::sin(tangent), -std::cos(tangent));
    const Vec2 start_outward(std::sin(theta(s0)), -std::cos(theta(s0)));
    const Vec2 along(std::cos(theta(s0)), std::sin(theta(s0)));
    // Where on finger a the contact is: on a jaw it goes along the line, on a disk around its centre.
    const Vec2 contact = std::isinf(radius) ? Vec2((s - s0) * along) : Vec2(radius * (start_outward - outward));
    const Vec2 c = part.point(t) + wheel * Vec2(std::sin(theta(t)), -std::cos(theta(t)));
    return contact + part_pose.turned(Vec2(c - part.point(s)));
  }

  /// The t with which the pin stays on the line through its first place along `way`.
  double t_on_line(double s, const Vec2& way) const {
    const Vec2 first = pin(s0, t0);
    double t = t0;
    for (int round = 0; round < 50; ++round) {
      const double h = 1e-6;
      const double off = cross(way, Vec2(pin(s, t) - first));
      const double slope =
          (cross(way, Vec2(pin(s, t + h) - first)) - cross(way, Vec2(pin(s, t - h) - first))) / (2 * h);
      t -= off / slope;
    }
    return t;
  }

  /// d2(pin along way)/ds2, over the curvature K of what rolls, by differences.
  double lift(const Vec2& way) const {
    const double h = 1e-3;
    const auto along = [&](double s) { return way.dot(pin(s, t_on_line(s, way)) - pin(s0, t0)); };
    const double K = part.turning().curvature(s0) + 1 / radius;
    return (along(s0 + h) + along(s0 - h)) / (h * h) / K;
  }
};

TEST(PlanWheel, is_stable_where_rolling_out_lifts_the_pin) {
  std::mt19937_64 generator = test_generator(71);
  std::uniform_real_distribution<double> anywhere(0, 1);
  int stable = 0;
  int unstable = 0;
  for (int k = 0; k < test_count(12); ++k) {
    const Part part = roundish(generator);
    const bool is_jaw = k % 2 == 0;
    const double s = anywhere(generator) * part.perimeter();
    if (part.turning().curvature(s) < 0.05) continue;
    PlanProblem problem =
        two(part, finger(is_jaw ? jaw() : disk(0.5), s, 1e-3), wheel(0.3, s + 0.5 * part.perimeter()));
    Plan plan;
    try {
      plan = solve(problem);
    } catch (const InputError&) {
      continue;  // in balance elsewhere
    }
    const Held held{part, is_jaw ? std::numeric_limits<double>::infinity() : 0.5, 0.3, plan.roll.s[0].front(),
                    plan.roll.s[1].front()};
    const Vec2 normal(std::sin(held.theta(held.t0)), -std::cos(held.theta(held.t0)));
    const double lift = held.lift(normal);
    if (std::abs(lift) < 0.02) continue;
    const bool is_stable = margin_of(plan, Condition::stable, 1).value > 0;
    EXPECT_EQ(is_stable, lift > 0) << "s = " << s << ", lift " << lift;
    (is_stable ? stable : unstable) += 1;
  }
  EXPECT_GT(stable, 0);
  RecordProperty("unstable", unstable);
}

}  // namespace
}  // namespace rollfix::plan_wheel_test
