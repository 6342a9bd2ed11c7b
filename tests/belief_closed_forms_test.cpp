// How sure one finger is of its place, of its radius and of the part's pose, where that has a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "answer/steps.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace belief_closed_forms_test {
namespace {

using rollfix::Finger;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Problem;
using rollfix::Vec2;
using shapes::kPi;

Problem roll_on(const Part& part, const Finger& finger, double distance, std::size_t rows, const Noise& noise) {
  rollfix::RollPlan plan;
  plan.start = 1;
  plan.distance = distance;
  plan.rows = rows;
  if (finger.outline() != nullptr) plan.u = 0.25 * finger.outline()->perimeter();
  return {part, rollfix::roll(part, finger, plan).log, {finger}, noise};
}

Noise noise_of(double contact, double angle, double position = 0) {
  Noise noise{contact, angle};
  noise.position = position;
  return noise;
}

/// A disk about the corner of a square, each row a little further.
std::vector<Vec2> pivot(double radius, std::size_t rows, rollfix::Log& log) {
  std::vector<Vec2> arms;
  rollfix::FingerRows& finger = log.fingers[0];
  for (std::size_t row = 0; row < rows; ++row) {
    const double facing = kPi / 2 + 0.2 + 1.1 * static_cast<double>(row) / static_cast<double>(rows);
    arms.emplace_back(radius * std::cos(facing), radius * std::sin(facing));
    finger.u.push_back(0.3);
    finger.psi.push_back(facing - 0.3);
    finger.x.push_back(1 - arms.back().x());
    finger.y.push_back(-arms.back().y());
  }
  return arms;
}

Part circle() { return Part(rollfix::gallery("circle,r=2")); }

/// Which says nothing of the place. Before, it was known like this.
Problem roll_on_circle(double sd) {
  Problem problem = roll_on(circle(), rollfix::disk(0.2), 1, 30, noise_of(0.01, 0.01));
  problem.prior = rollfix::Prior{3, sd};
  return problem;
}

TEST(BeliefClosedForms, a_contact_at_the_tip_of_a_finger_is_as_unsure_as_the_tip_is_sharp) {
  const Part cam(rollfix::gallery("cam"));
  const Finger finger = Finger::outlined(rollfix::gallery("ellipse,a=0.4,b=0.1"));
  const double length = 0.25 * finger.outline()->perimeter();  // from where it is flat to its tip
  Problem problem = roll_on(cam, finger, length, 2, noise_of(1e-5, 1e-5));
  problem.prior = rollfix::Prior{1, 0.2};
  const double there = cam.turning().curvature(1 + length);
  const double flat = 0.1 / (0.4 * 0.4);
  const double tip = 0.4 / (0.1 * 0.1);
  const double variance = 1e-10 * (std::pow(flat + there, 2) + std::pow(tip + there, 2) + 2);
  const double sd = std::sqrt(variance) / std::abs(there - cam.turning().curvature(1));
  const rollfix::Placement placement = rollfix::solve(problem).placements.at(0);
  EXPECT_NEAR(placement.start[0], 1, sd);
  EXPECT_NEAR(placement.sd[0], sd, 0.05 * sd);
}

TEST(BeliefClosedForms, a_disk_that_pivots_tells_its_radius_by_the_circle_that_its_centre_goes_on) {
  const double radius = 0.5;
  Noise noise = noise_of(1e-4, 1e-4, 0.005);
  noise.radius = 0.05;
  Problem problem{shapes::unit_square(), rollfix::Log{}, {rollfix::disk(radius)}, noise};
  const std::vector<Vec2> arms = pivot(radius, 40, *problem.measured.log);
  Vec2 mean(0, 0);
  for (const Vec2& arm : arms) mean += arm / static_cast<double>(arms.size());
  double information = std::pow(radius / noise.radius, 2);  // on the share that the radius is off by
  for (const Vec2& arm : arms) information += (arm - mean).squaredNorm() / std::pow(noise.position, 2);
  const double sd = 1 / std::sqrt(information);
  EXPECT_NEAR(rollfix::solve(problem).weighing->fit.length_scale_sd[0], sd, 0.02 * sd);
}

TEST(BeliefClosedForms, a_first_contact_on_a_jaw_that_is_off_does_not_move_the_part) {
  Problem problem = roll_on(Part(rollfix::gallery("cam")), rollfix::jaw(), 2, 60, noise_of(0.01, 1e-4, 1e-4));
  problem.measured.log->fingers[0].u.front() += 0.02;
  const rollfix::PoseSpread pose = *rollfix::solve(problem).placements.at(0).pose_spread;
  const double sd = std::sqrt(pose.covariance(0, 0) + pose.covariance(1, 1));
  EXPECT_LT(sd, 0.002);
  EXPECT_LT(std::hypot(pose.mean.x, pose.mean.y), 4 * sd);  // the log is of a part at the origin
}

TEST(BeliefClosedForms, rows_that_are_joined_on_a_bend_fit_as_each_of_them_does) {
  const Problem problem =
      roll_on(Part(rollfix::gallery("ellipse,a=2,b=1")), rollfix::disk(0.2), 4, 400, noise_of(1e-4, 1e-4, 1e-4));
  rollfix::Supposed joined;
  joined.nodes = 64;
  std::optional<rollfix::Belief> belief = rollfix::believe(problem, rollfix::observe(problem), joined);
  EXPECT_FALSE(belief->fit().is_bad());
  EXPECT_NEAR(problem.part.boundary().distance(belief->modes().at(0).start[0], 1), 0, 1e-3);
}

TEST(BeliefClosedForms, on_a_circle_the_place_is_known_as_it_was_before) {
  for (const double share : {0.1, 0.01, 0.001}) {
    const double sd = share * circle().perimeter();
    const rollfix::Placement place = rollfix::solve(roll_on_circle(sd)).placements.at(0);
    EXPECT_NEAR(place.start[0], 3, 1e-3 * sd) << share;
    EXPECT_NEAR(place.mean[0], 3, 1e-3 * sd) << share;
    EXPECT_NEAR(place.sd[0], sd, 1e-3 * sd) << share;
  }
}

/// Of a normal distribution that is cut off half a circle away: what 95 % need of the circle.
double needed(double sd) {
  const double farthest = 0.5 * circle().perimeter();
  const auto held = [&](double off) { return std::erf(off / (sd * std::numbers::sqrt2)); };
  double off = 0;
  while (held(off) < 0.95 * held(farthest)) off += 1e-4 * farthest;
  return off / farthest;
}

TEST(BeliefClosedForms, a_place_is_unobservable_where_95_percent_need_nearly_as_much_as_if_all_were_alike) {
  for (const double laps : {0.1, 0.2, 0.25, 0.4, 0.5, 2.0}) {
    const double sd = laps * circle().perimeter();
    const bool is_anywhere = needed(sd) > 0.9 * 0.95;
    EXPECT_EQ(rollfix::solve(roll_on_circle(sd)).verdict.name,
              is_anywhere ? rollfix::Verdict::unobservable : rollfix::Verdict::ambiguous)
        << needed(sd);
  }
}

}  // namespace
}  // namespace belief_closed_forms_test
