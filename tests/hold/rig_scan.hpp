#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hold/rig_cases.hpp"

// Every place of the jaw's first contact, tried one by one: the outline is a polygon of many points, and a wheel
// touches where its pin is one radius off it. Shares nothing with the search. Smooth closed outlines.
namespace rig_cases {

class RigScan {
 public:
  explicit RigScan(const HoldProblem& problem, int points = 3000)
      : problem_(problem), points_(problem.part.polyline(0, problem.part.perimeter(), points)) {}

  /// The largest of |distance - r| over all instants, for a first contact.
  double worst(double s0) const {
    const rollfix::FingerRows& jaw = problem_.logs[0].fingers[0];
    const rollfix::FingerRows& pin = problem_.wheels[0].log.rows.fingers[0];
    double most = 0;
    for (std::size_t k = 0; k < jaw.u.size(); ++k) {
      const double s = s0 - (jaw.u[k] - jaw.u[0]);
      const double heading = jaw.psi[k] - std::numbers::pi - problem_.part.tangent(s);
      const Vec2 contact = Vec2(jaw.x[k], jaw.y[k]) + turned({jaw.u[k], 0}, jaw.psi[k]);
      const Vec2 seen = problem_.part.point(s) + turned(Vec2(pin.x[k], pin.y[k]) - contact, -heading);
      most = std::max(most, std::abs(distance(seen) - problem_.wheels[0].radius));
    }
    return most;
  }

  /// Whether the jaw can lie there at the first instant.
  bool jaw_fits(double s0) const {
    const Vec2 n = normal_of(problem_.part.tangent(s0)), at = problem_.part.point(s0);
    return std::none_of(points_.begin(), points_.end(),
                        [&](const Vec2& point) { return (point - at).dot(n) > 1e-6 * problem_.part.perimeter(); });
  }

 private:
  /// Below 0 inside.
  double distance(const Vec2& point) const {
    double least = 1e300;
    bool inside = false;
    for (std::size_t k = 0; k + 1 < points_.size(); ++k) {
      const Vec2 &a = points_[k], &b = points_[k + 1];
      const Vec2 along = b - a;
      const double share = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (point - a - share * along).squaredNorm());
      const bool crosses = (a.y() > point.y()) != (b.y() > point.y());
      if (crosses && point.x() < a.x() + (point.y() - a.y()) / along.y() * along.x()) inside = !inside;
    }
    return inside ? -std::sqrt(least) : std::sqrt(least);
  }

  const HoldProblem& problem_;
  std::vector<Vec2> points_;
};

/// The first contacts of the jaw that fit, by so many places all round.
inline std::vector<double> scanned(const HoldProblem& problem, std::size_t places) {
  const RigScan coarse(problem, 300);
  const RigScan fine(problem);
  const double step = problem.part.perimeter() / static_cast<double>(places);
  std::vector<double> worst;
  for (std::size_t k = 0; k < places; ++k) worst.push_back(coarse.worst(step * static_cast<double>(k)));
  std::vector<double> found;
  for (std::size_t k = 0; k < places; ++k) {
    const double before = worst[(k + places - 1) % places], after = worst[(k + 1) % places];
    if (worst[k] > before || worst[k] >= after || worst[k] > 20 * step) continue;
    double at = step * static_cast<double>(k);
    double least = fine.worst(at);
    for (double stride = step; stride > 1e-7 * step; stride *= 0.5) {
      for (const double next : {at - stride, at + stride}) {
        const double there = fine.worst(next);
        if (there >= least) continue;
        least = there;
        at = next;
      }
    }
    // A polygon of so many points is off by so much.
    if (least < 1e-5 * problem.part.perimeter() && fine.jaw_fits(at))
      found.push_back(problem.part.boundary().canonical(at));
  }
  std::sort(found.begin(), found.end());
  return found;
}

inline void expect_same_places(const HoldAnswer& answer, const std::vector<double>& found) {
  ASSERT_EQ(answer.placements.size(), found.size()) << answer.verdict_text();
  for (const double s : found) {
    const bool is_there =
        std::any_of(answer.placements.begin(), answer.placements.end(), [&](const HoldPlacement& one) {
          return answer.part.distance(one.contacts[0].start, s) < 1e-3 * answer.part.perimeter();
        });
    EXPECT_TRUE(is_there) << "at s = " << s;
  }
}

/// The place near t, other than s, at which the normal goes through the boundary's point at s.
inline double foot_across(const Part& part, double s, double t) {
  for (int k = 0; k < 60; ++k) {
    const Vec2 way = part.point(t) - part.point(s);
    const Vec2 tangent(std::cos(part.tangent(t)), std::sin(part.tangent(t)));
    const double slope = 1 + part.turning().curvature(t) * way.dot(Vec2(-tangent.y(), tangent.x()));
    t -= way.dot(tangent) / slope;
  }
  return t;
}

}  // namespace rig_cases
