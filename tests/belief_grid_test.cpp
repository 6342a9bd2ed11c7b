#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "belief/grid.hpp"
#include "belief_cases.hpp"
#include "rollfix/outline/points.hpp"

// What a posterior costs follows the part's shape, however many points its outline was given by.
namespace belief_grid_test {

using namespace belief_cases;
using namespace rollfix::belief;
using rollfix::LogKind;
using rollfix::Vec2;

namespace {

/// An egg as a spline through so many of its points.
Part egg_through(int count) {
  std::vector<Vec2> points;
  for (int k = 0; k < count; ++k) {
    const double t = 2 * std::numbers::pi * k / count;
    const double bulge = 1 + 0.15 * std::cos(t);
    points.push_back({3 * bulge * std::cos(t), 2 * bulge * std::sin(t)});
  }
  return Part(rollfix::Outline{"egg", rollfix::spline_through(points, true), true});
}

constexpr double kRadius = 0.4;
constexpr double kCurvature = 1 / kRadius;

TiltedBoundary boundary_of(const Part& part, double contact) {
  return TiltedBoundary(part, tilt_of(kCurvature, 0, part), accuracy_of(contact, part));
}

/// The points of the grid after a roll over a third of the egg.
std::size_t grid_points_on(const Part& part) {
  const double P = part.perimeter();
  BeliefOptions options;
  options.noise = noise_on(part, 1e-3, 5e-3, 5e-3);
  const ErrorModel errors(options, LogKind::contact, kCurvature, P);
  const TiltedBoundary boundary = boundary_of(part, options.noise.contact);
  Nodes nodes(errors, boundary.tilt(), false);
  const NoisyRoll roll = roll_on(part, kRadius, 0.2 * P, P / 3, 200, options.noise, 7);
  const std::vector<rollfix::Reading> rows = rollfix::readings_as_given(roll.log, {DiskFinger{kRadius}});
  for (std::size_t k = 1; k < rows.size(); ++k) nodes.add(rows[k], kCurvature, 0);
  Grid grid(boundary, errors, options, part.boundary(), corner_length(kCurvature, part), nullptr);
  grid.settle(nodes);
  return grid.points();
}

TEST(BeliefGrid, an_egg_of_many_points_needs_no_more_places_on_trial_than_one_of_few) {
  const auto few = static_cast<double>(grid_points_on(egg_through(60)));
  EXPECT_LE(static_cast<double>(grid_points_on(egg_through(400))), 1.2 * few);
  EXPECT_LE(static_cast<double>(grid_points_on(egg_through(2000))), 1.2 * few);
}

TEST(BeliefGrid, a_spline_through_points_has_no_kinks) {
  for (const int count : {60, 400, 2000}) {
    EXPECT_TRUE(boundary_of(egg_through(count), 0.01).arcs().front().kinks().empty()) << count << " points";
  }
}

TEST(BeliefGrid, a_polygons_kinks_are_both_ends_of_its_corners) {
  const Part polygon = part_of("polygon");
  EXPECT_EQ(boundary_of(polygon, 0.01).arcs().front().kinks().size(), 2 * polygon.corners().size());
}

TEST(BeliefGrid, the_arcs_of_a_stadium_end_in_kinks) {
  EXPECT_EQ(boundary_of(part_of("stadium"), 0.01).arcs().front().kinks().size(), 4U);
}

TEST(BeliefGrid, half_of_a_cells_mass_lies_where_its_density_is_larger) {
  GridCell cell;
  EXPECT_DOUBLE_EQ(cell.quantile(0.5), 0.5);
  cell.rise = std::log(3.0);
  // The integral of 3^x from 0 to q is half of that to 1: 3^q = 2.
  EXPECT_NEAR(cell.quantile(0.5), std::log(2.0) / std::log(3.0), 1e-12);
  // The mean of that density is 3/2 - 1/ln 3.
  EXPECT_NEAR(cell.mean(), 1.5 - 1 / std::log(3.0), 1e-3);
}

}  // namespace
}  // namespace belief_grid_test
