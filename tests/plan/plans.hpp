#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/plan.hpp"

/// Plans to look at, and what mechanics says of them: written from forces and velocities in the world alone.
namespace plans {

using rollfix::Part;
using rollfix::Plan;
using rollfix::PlanFinger;
using rollfix::PlanProblem;
using rollfix::Pose;
using rollfix::Vec2;

inline constexpr double kPi = std::numbers::pi;

inline PlanFinger finger(const rollfix::Finger& shape, double start, std::optional<double> length = {},
                         std::optional<double> friction = {}) {
  PlanFinger finger;
  finger.finger = shape;
  finger.start = start;
  finger.length = length;
  finger.friction = friction;
  return finger;
}

inline PlanFinger wheel(double radius, std::optional<double> start = {}) {
  PlanFinger finger;
  finger.finger = rollfix::disk(radius);
  finger.start = start;
  finger.wheel = true;
  return finger;
}

inline PlanProblem two(const Part& part, const PlanFinger& a, const PlanFinger& b) {
  PlanProblem problem{part, {a, b}};
  problem.pose = {0.3, -0.2, 0.4};
  return problem;
}

inline PlanProblem one(const Part& part, const PlanFinger& a) {
  PlanProblem problem{part, a};
  problem.pose = {0.3, -0.2, 0.4};
  return problem;
}

/// A smooth part that is nearly round: a wobbly circle through nine points.
inline Part roundish(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> radius(0.85, 1.15);
  std::vector<Vec2> points;
  for (int k = 0; k < 9; ++k) {
    const double r = radius(generator);
    points.emplace_back(r * std::cos(2 * kPi * k / 9), r * std::sin(2 * kPi * k / 9));
  }
  return Part(rollfix::outline_through(points, "roundish"));
}

inline Pose pose_in(const PlanProblem& problem, const Plan& plan, std::size_t row) {
  return plan.roll.pose.empty() ? problem.pose : plan.roll.pose[row];
}

inline Vec2 contact_in_world(const PlanProblem& problem, const Plan& plan, std::size_t which, std::size_t row) {
  return pose_in(problem, plan, row).world(problem.part.point(plan.roll.s[which][row]));
}

inline Vec2 carried(double vx, double vy, double omega, const Vec2& arm) {
  return {vx - omega * arm.y(), vy + omega * arm.x()};
}

/// How fast the finger's skin slides over the part at the contact, the largest of all rows, per largest speed.
inline double slip(const PlanProblem& problem, const Plan& plan, std::size_t which) {
  const rollfix::FingerRows& rows = plan.roll.log.fingers[which];
  const rollfix::PlanRates& rates = plan.rates[which];
  double most = 0;
  double scale = 1e-300;
  for (std::size_t k = 0; k < rows.x.size(); ++k) {
    const Vec2 contact = contact_in_world(problem, plan, which, k);
    const Vec2 of_finger = carried(rates.vx[k], rates.vy[k], rates.omega[k], contact - Vec2(rows.x[k], rows.y[k]));
    Vec2 of_part = Vec2::Zero();
    if (!plan.roll.pose.empty()) {
      const Pose& pose = plan.roll.pose[k];
      of_part = carried(plan.part_rates.vx[k], plan.part_rates.vy[k], plan.part_rates.omega[k],
                        contact - Vec2(pose.x, pose.y));
    }
    most = std::max(most, (of_finger - of_part).norm());
    scale = std::max(scale, std::abs(rates.omega[k]) + of_finger.norm());
  }
  return most / scale;
}

/// How far the finger's rim is from the part's point that it is to touch, the largest of all rows.
inline double off_contact(const PlanProblem& problem, const Plan& plan, std::size_t which) {
  const rollfix::FingerRows& rows = plan.roll.log.fingers[which];
  double most = 0;
  for (std::size_t k = 0; k < rows.x.size(); ++k) {
    const Vec2 rim = problem.fingers[which].finger.point(rows.u[k]);
    const Pose frame{rows.x[k], rows.y[k], rows.psi[k]};
    most = std::max(most, (frame.world(rim) - contact_in_world(problem, plan, which, k)).norm());
  }
  return most;
}

/// How far two outlines' rims are apart in a row, from many points of both in the world.
inline double distance_in(const PlanProblem& problem, const Plan& plan, std::size_t row) {
  constexpr int kPoints = 200;
  std::vector<std::vector<Vec2>> rims(2);
  for (const std::size_t which : {0U, 1U}) {
    const rollfix::FingerRows& rows = plan.roll.log.fingers[which];
    const rollfix::Finger& shape = problem.fingers[which].finger;
    const Pose frame{rows.x[row], rows.y[row], rows.psi[row]};
    for (int k = 0; k < kPoints; ++k) rims[which].push_back(frame.world(shape.point(shape.period() * k / kPoints)));
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Vec2& one : rims[0]) {
    for (const Vec2& other : rims[1]) least = std::min(least, (one - other).norm());
  }
  return least;
}

/// What the velocities of a finger add up to, by Simpson's rule, against where it is at the end; rows must be odd.
inline double off_integral(const Plan& plan, std::size_t which) {
  const rollfix::FingerRows& rows = plan.roll.log.fingers[which];
  const rollfix::PlanRates& rates = plan.rates[which];
  const double step = plan.roll.log.time[1] - plan.roll.log.time[0];
  Vec2 sum = Vec2::Zero();
  double turned = 0;
  const std::size_t last = rows.x.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    const double weight = (k == 0 || k == last ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) * step / 3;
    sum += weight * Vec2(rates.vx[k], rates.vy[k]);
    turned += weight * rates.omega[k];
  }
  const Vec2 moved(rows.x[last] - rows.x[0], rows.y[last] - rows.y[0]);
  return (sum - moved).norm() + std::abs(turned - (rows.psi[last] - rows.psi[0]));
}

/// The angle of the line from one contact to the other against the normal into the part, from points close by.
inline double tilt(const Part& part, double s, double t, bool apart = false) {
  const double h = 1e-6 * part.perimeter();
  const Vec2 along = (part.point(s + h) - part.point(s - h)).normalized();
  const Vec2 inward(-along.y(), along.x());
  Vec2 line = (part.point(t) - part.point(s)).normalized();
  if (apart) line = -line;
  return std::atan2(rollfix::cross(inward, line), inward.dot(line));
}

inline const rollfix::PlanMargin& margin_of(const Plan& plan, rollfix::Condition condition, std::size_t which = 0) {
  for (const rollfix::PlanMargin& margin : plan.margins) {
    if (margin.condition == condition && margin.finger == which) return margin;
  }
  throw std::runtime_error(std::string("no margin of ") + rollfix::name_of(condition));
}

}  // namespace plans
