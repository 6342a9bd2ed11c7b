#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/rolling.hpp"
#include "touch_cases.hpp"

// Rolls of a disk on a part that lies somewhere, drawn by a simulator that knows the outline's points and tangents
// alone: smooth parts, and roll by roll lift-off in between.
namespace roll_cases {

using namespace touch_cases;
using rollfix::Log;

/// How rolls are made and measured.
struct Rolling {
  std::size_t count = 2;
  double length = 0.1;    // of each, a share of the perimeter, to either side
  std::size_t rows = 40;  // of each, besides the first
  double radius = 0.03;   // of the diagonal, as are the next two
  double contact_sd = 0;
  double place_sd = 0;
  double angle_sd = 0;
  bool centres = true;
  std::size_t touches = 0;  // with normals, besides
};

struct RollCase {
  TouchProblem problem;
  Pose truth;
  std::vector<double> starts;
  std::vector<double> lengths;
};

/// The tangent's angle at s: unwrapped along the roll, by small steps.
inline double follow(const Part& part, double s, double near) {
  return near + rollfix::nearest_angle(part.tangent(s) - near);
}

/// A disk that rolls over a smooth stretch of the boundary from s on.
inline Log roll_log(const Part& part, const Pose& pose, double s, double length, double radius, const Rolling& rolling,
                    double size, std::mt19937_64& generator) {
  constexpr int kFine = 20;  // steps from row to row by which the tangent is followed
  Log log;
  log.name = "roll";
  rollfix::FingerRows& rows = log.fingers.front();
  rows.u_wrapped = rows.psi_wrapped = false;
  double tangent = part.tangent(s);
  const double psi_at_first = uniform(generator, -1, 1);
  const double u_first = tangent + pose.heading + 0.5 * std::numbers::pi - psi_at_first;
  for (std::size_t k = 0; k <= rolling.rows; ++k) {
    const double gone = length * static_cast<double>(k) / static_cast<double>(rolling.rows);
    for (int fine = kFine - 1; fine >= 0 && k > 0; --fine) {
      tangent = follow(part, s + gone - length * fine / (kFine * static_cast<double>(rolling.rows)), tangent);
    }
    const double u = u_first - gone / radius;
    const double psi = tangent + pose.heading + 0.5 * std::numbers::pi - u;
    const Vec2 centre = pose.world(part.point(s + gone) + radius * outward(tangent));
    rows.u.push_back(u + normal(generator, rolling.contact_sd * size) / radius);
    rows.psi.push_back(psi + normal(generator, rolling.angle_sd));
    log.time.push_back(static_cast<double>(k));
    if (!rolling.centres) continue;
    rows.x.push_back(centre.x() + normal(generator, rolling.place_sd * size));
    rows.y.push_back(centre.y() + normal(generator, rolling.place_sd * size));
  }
  return log;
}

/// The same on a part with corners, about which the finger pivots: rolled by the library, then moved and made noisy.
inline Log pivoting_log(const Part& part, const Pose& pose, double s, double length, double radius,
                        const Rolling& rolling, double size, std::mt19937_64& generator) {
  rollfix::RollPlan plan;
  plan.start = s;
  plan.psi = uniform(generator, -1, 1);
  plan.distance = length;
  plan.rows = rolling.rows + 1;
  Log log = rollfix::roll(part, rollfix::disk(radius), plan).log;
  rollfix::FingerRows& rows = log.fingers.front();
  rows.u_wrapped = rows.psi_wrapped = false;
  for (std::size_t k = 0; k < rows.u.size(); ++k) {
    const Vec2 centre = pose.world({rows.x[k], rows.y[k]});
    rows.u[k] += normal(generator, rolling.contact_sd * size) / radius;
    rows.psi[k] += pose.heading + normal(generator, rolling.angle_sd);
    rows.x[k] = centre.x() + normal(generator, rolling.place_sd * size);
    rows.y[k] = centre.y() + normal(generator, rolling.place_sd * size);
  }
  if (!rolling.centres) rows.x = rows.y = {};
  return log;
}

inline bool has_corners(const Part& part) { return part.corners().size() > 0; }

/// Whether a disk gets to all places of a stretch.
inline bool can_roll(const Part& part, double s, double length, double radius, const std::vector<Vec2>& boundary) {
  constexpr int kPlaces = 200;
  constexpr double kLarger = 1.05;  // where a larger disk gets to, this one does
  for (int k = 0; k <= kPlaces; ++k) {
    const double at = s + length * k / kPlaces;
    const Vec2 centre = part.point(at) + kLarger * radius * outward(part.tangent(at));
    for (const Vec2& point : boundary) {
      if ((point - centre).norm() < kLarger * radius * (1 - 1e-3)) return false;
    }
  }
  return true;
}

inline RollCase random_rolls(const Part& part, const Rolling& rolling, std::mt19937_64& generator) {
  const double size = diagonal(part);
  const double radius = rolling.radius * size;
  const std::vector<Vec2> boundary = dense(part);
  RollCase result{{part, {}}, {}, {}, {}};
  result.truth = {uniform(generator, -size, size), uniform(generator, -size, size),
                  uniform(generator, -std::numbers::pi, std::numbers::pi)};
  while (result.problem.rolls.size() < rolling.count) {
    const double s = uniform(generator, 0, part.perimeter());
    const double length = rolling.length * part.perimeter() * (uniform(generator, -1, 1) > 0 ? 1 : -1);
    if (!can_roll(part, s, length, radius, boundary)) continue;
    const auto roll = has_corners(part) ? pivoting_log : roll_log;
    try {
      result.problem.rolls.push_back(roll(part, result.truth, s, length, radius, rolling, size, generator));
    } catch (const rollfix::InputError&) {
      continue;  // into a concave corner
    }
    result.starts.push_back(s);
    result.lengths.push_back(length);
  }
  for (std::size_t k = 0; k < rolling.touches; ++k) {
    const Place place = random_place(part, radius, boundary, generator);
    MeasuredTouch touch;
    touch.at =
        result.truth.world(place.point + radius * outward(place.tangent)) + scatter(generator, rolling.place_sd * size);
    touch.normal = place.tangent - 0.5 * std::numbers::pi + result.truth.heading + normal(generator, rolling.angle_sd);
    result.problem.touches.push_back(touch);
  }
  result.problem.finger = rollfix::disk(radius);
  result.problem.diagnose = false;
  if (rolling.contact_sd > 0 || rolling.angle_sd > 0) {
    rollfix::Noise noise;
    noise.contact = rolling.contact_sd * size;
    noise.angle = rolling.angle_sd;
    noise.position = rolling.centres ? rolling.place_sd * size : 0;
    result.problem.noise = noise;
  }
  return result;
}

}  // namespace roll_cases
