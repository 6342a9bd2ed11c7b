// What fingers can't do, where their radii are only known to some noise.
#include <gtest/gtest.h>

#include <algorithm>

#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace reach_radius_test {
namespace {

using rollfix::Answer;
using rollfix::Noise;
using rollfix::Part;
using rollfix::PerFinger;
using rollfix::Placement;
using rollfix::Reading;
using rollfix::Vec2;

bool is_listed(const Answer& answer, const PerFinger<double>& start) {
  return std::any_of(answer.placements.begin(), answer.placements.end(), [&](const Placement& one) {
    double off = 0;
    for (std::size_t k = 0; k < start.size(); ++k) {
      off = std::max(off, answer.part.distance(one.start[k], start[k]));
    }
    return off < 1e-2 * answer.part.perimeter();
  });
}

Noise noise_with(double radius) {
  Noise noise{.contact = 1e-4, .angle = 1e-4};
  noise.radius = radius;
  return noise;
}

/// Rolled into the dimple of a limacon, as far as a disk of radius 0.2 goes: 0.3 is said.
Answer in_dimple(double radius_sd, double& start) {
  const Part part(rollfix::gallery("limacon,a=1,b=0.9"));
  start = rollfix::reach_of_disk(part, 0.2).arcs.front().hi - 0.3;
  return solve(
      rollfix::Problem{part, shapes::reading_from(part, start, 0.29), {rollfix::disk(0.3)}, noise_with(radius_sd)});
}

double centre_distance(const Part& part, double s, double t, double radius) {
  const auto centre = [&](double at) {
    const double angle = part.turning().angle(at);
    return Vec2(part.point(at) + radius * Vec2(std::sin(angle), -std::cos(angle)));
  };
  return (centre(s) - centre(t)).norm();
}

constexpr double kA = 2, kB = 1.4;  // where two disks touch the cam first

/// Two disks on a cam, as large as overlap at their first contacts by this, that roll apart.
Answer rolled_apart(double overlap, double radius_sd) {
  const Part part(rollfix::gallery("cam"));
  double radius = 0.1;
  while (2 * radius - centre_distance(part, kA, kB, radius) < overlap) radius += 1e-3;
  std::vector<Reading> readings;
  for (const double length : {0.4, 0.9}) {
    const double of_a = shapes::reading_from(part, kA, length).turn,
                 of_b = shapes::reading_from(part, kB, -length).turn;
    readings.push_back({length, -length, of_a - of_b});
  }
  rollfix::Problem problem{part, readings, {rollfix::disk(radius)}, noise_with(radius_sd)};
  problem.facing = part.tangent(kA) - part.tangent(kB);
  return solve(problem);
}

}  // namespace

TEST(ReachRadius, a_disk_that_may_be_smaller_goes_further_into_a_dimple) {
  double start = 0;
  EXPECT_FALSE(is_listed(in_dimple(0, start), start));
  EXPECT_FALSE(is_listed(in_dimple(1e-4, start), start));
  EXPECT_TRUE(is_listed(in_dimple(0.025, start), start));
}

TEST(ReachRadius, two_disks_that_may_be_smaller_need_not_overlap) {
  EXPECT_FALSE(is_listed(rolled_apart(0.3, 0), {kA, kB}));
  EXPECT_FALSE(is_listed(rolled_apart(0.3, 1e-4), {kA, kB}));
  EXPECT_TRUE(is_listed(rolled_apart(0.3, 0.1), {kA, kB}));
}

}  // namespace reach_radius_test
