#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "belief/one/grid.hpp"
#include "belief_cases.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

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

/// The points of the grid after a roll over a third of the egg that starts at 0.2 P.
std::size_t grid_points_on(const Part& part, std::optional<rollfix::Prior> prior = {}) {
  const double P = part.perimeter();
  BeliefOptions options;
  options.prior = prior;
  options.noise = noise_on(part, 1e-3, 5e-3, 5e-3);
  const ErrorModel errors(options, LogKind::contact, kCurvature, P);
  const TiltedBoundary boundary = boundary_of(part, options.noise.contact);
  Nodes nodes(errors, boundary.tilt(), false);
  const NoisyRoll roll = roll_on(part, kRadius, 0.2 * P, P / 3, 200, options.noise, 7);
  const std::vector<rollfix::Reading> rows = rollfix::readings_as_given(roll.log, {DiskFinger{kRadius}});
  for (std::size_t k = 1; k < rows.size(); ++k) nodes.add({rows[k], kCurvature});
  Grid grid(boundary, errors, options, part.boundary(), corner_length(kCurvature, part), nullptr,
            std::pmr::get_default_resource(), kMostPoints);
  grid.settle(nodes);
  return grid.points();
}

TEST(BeliefGrid, an_egg_of_many_points_needs_no_more_places_on_trial_than_one_of_few) {
  const auto few = static_cast<double>(grid_points_on(egg_through(60)));
  EXPECT_LE(static_cast<double>(grid_points_on(egg_through(400))), 1.2 * few);
  EXPECT_LE(static_cast<double>(grid_points_on(egg_through(2000))), 1.2 * few);
}

TEST(BeliefGrid, a_narrow_prior_far_from_where_the_rows_fit_needs_few_places_on_trial) {
  const Part egg = egg_through(60);
  const double P = egg.perimeter();
  const auto without = static_cast<double>(grid_points_on(egg));
  for (double sd = 1e-2; sd > 1e-8; sd /= 10) {
    for (const double s : {0.2, 0.45, 0.7, 0.95}) {
      EXPECT_LE(static_cast<double>(grid_points_on(egg, rollfix::Prior{s * P, sd * P})), 3 * without + 200)
          << sd << " P at " << s << " P";
    }
  }
}

/// 65 rows over 0.4 of its perimeter P, from 0.2 on.
struct RollOnCam {
  Part part = part_of("cam");
  double P = part.perimeter();
  double radius = 0.03 * P;
  BeliefOptions options{noise_on(part, 1e-3, 5e-3, 5e-3)};
  NoisyRoll roll = roll_on(part, radius, 0.2 * P, 0.4 * P, 65, options.noise, 7);
};

TEST(BeliefGrid, a_prior_narrower_than_what_the_rows_tell_decides_as_noisy_as_it_is_taken) {
  const RollOnCam cam;
  for (const double s : {0.2, 0.5, 0.8}) {
    BeliefOptions options = cam.options;
    options.prior = rollfix::Prior{s * cam.P, 1e-6 * cam.P};
    Belief belief = belief_in(cam.part, cam.roll.log, cam.radius, options);
    const double sd = 1e-6 * cam.P * belief.fit().widened;
    EXPECT_NEAR(belief.modes().front().mean[0], s * cam.P, 0.1 * sd);
    EXPECT_NEAR(belief.modes().front().sd[0], sd, 0.1 * sd);
  }
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

TEST(BeliefGrid, a_boundary_looks_the_same_as_often_as_its_part) {
  EXPECT_EQ(boundary_of(part_of("gear"), 0.01).folds(), 12U);
  EXPECT_EQ(boundary_of(part_of("polygon"), 0.01).folds(), 6U);
  EXPECT_EQ(boundary_of(part_of("ellipse,a=2,b=1"), 0.01).folds(), 2U);
  EXPECT_EQ(boundary_of(part_of("cam"), 0.01).folds(), 1U);
  EXPECT_EQ(boundary_of(egg_through(60), 0.01).folds(), 1U);
}

/// A star of lines: what a finger gets along lies between two of its concave corners.
Part star_of(int points) {
  std::vector<Vec2> corners;
  for (int k = 0; k < 2 * points; ++k) {
    const double angle = std::numbers::pi * k / points;
    corners.push_back((k % 2 == 0 ? 2 : 1) * Vec2(std::cos(angle), std::sin(angle)));
  }
  return Part(shapes::polygon(corners));
}

TEST(BeliefGrid, a_star_is_cut_at_its_concave_corners_and_looks_the_same_from_arc_to_arc) {
  const Part star = star_of(5);
  const TiltedBoundary boundary = boundary_of(star, 0.01);
  EXPECT_EQ(boundary.arcs().size(), 5U);
  EXPECT_EQ(boundary.folds(), 5U);
  EXPECT_EQ(boundary.shift(2).arcs, 2U);
  EXPECT_NEAR(boundary.shift(2).s, 0.4 * star.perimeter(), 1e-12);
}

/// So wide that it tells nothing of any place, but what looks alike is not taken to be.
constexpr double kAnyPlace = 1e4;

void expect_the_same_places_with_every_fold_looked_at(const Part& part, double radius, std::uint64_t seed) {
  const double P = part.perimeter();
  BeliefOptions options;
  options.noise = noise_on(part, 1e-3, 5e-3, 5e-3);
  const NoisyRoll roll = roll_on(part, radius, 0.9 * P, 0.15 * P, 60, options.noise, seed);
  Belief folded = belief_in(part, roll.log, radius, options);
  options.prior = rollfix::Prior{0, kAnyPlace * P};
  Belief whole = belief_in(part, roll.log, radius, options);
  ASSERT_EQ(folded.modes().size(), whole.modes().size());
  for (const Mode& mode : whole.modes()) {
    const Mode* same = mode_at(folded.modes(), mode.mean[0], part);
    ASSERT_NE(same, nullptr);
    EXPECT_LE(distance(part, same->mean[0], mode.mean[0]), 0.02 * mode.sd[0]);
    EXPECT_LE(distance(part, same->end_mean[0], mode.end_mean[0]), 0.02 * mode.end_sd[0]);
    EXPECT_NEAR(same->sd[0], mode.sd[0], 0.02 * mode.sd[0]);
    EXPECT_NEAR(same->probability, mode.probability, 0.02 * mode.probability);
  }
}

TEST(BeliefGrid, what_looks_alike_is_told_of_as_if_each_place_were_looked_at) {
  const Part gear = part_of("gear");
  const Part ellipse = part_of("ellipse,a=2,b=1");
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    expect_the_same_places_with_every_fold_looked_at(gear, 0.002 * gear.perimeter(), seed);
    expect_the_same_places_with_every_fold_looked_at(ellipse, 0.03 * ellipse.perimeter(), seed);
    expect_the_same_places_with_every_fold_looked_at(star_of(3), 0.1, seed);
  }
}

TEST(BeliefGrid, places_that_look_alike_are_as_probable) {
  const Part polygon = part_of("polygon");
  const double P = polygon.perimeter();
  BeliefOptions options;
  options.noise = noise_on(polygon, 2e-4, 3e-3, 0);
  const double radius = 0.03 * P;
  const NoisyRoll roll = roll_on(polygon, radius, 0.31 * P, 0.6 * P, 100, options.noise, 3);
  Belief belief = belief_in(polygon, roll.log, radius, options);
  ASSERT_EQ(belief.modes().size(), 6U);
  for (const Mode& mode : belief.modes()) EXPECT_DOUBLE_EQ(mode.probability, 1.0 / 6);
}

TEST(BeliefGrid, a_roll_that_has_grown_is_what_it_is_at_once) {
  const RollOnCam cam;
  Belief at_once = belief_in(cam.part, cam.roll.log, cam.radius, cam.options);
  Belief growing(cam.part, LogKind::contact, cam.options);
  for (const rollfix::Reading& reading : rollfix::readings_as_given(cam.roll.log, {DiskFinger{cam.radius}})) {
    rollfix::Sample sample;
    sample.reading = reading;
    sample.finger_curvature = 1 / cam.radius;
    growing.add(sample);
    growing.modes();
  }
  ASSERT_EQ(growing.modes().size(), at_once.modes().size());
  for (std::size_t k = 0; k < at_once.modes().size(); ++k) {
    EXPECT_NEAR(growing.modes()[k].mean[0], at_once.modes()[k].mean[0], 1e-9 * cam.P);
    EXPECT_NEAR(growing.modes()[k].sd[0], at_once.modes()[k].sd[0], 1e-9 * cam.P);
  }
}

TEST(BeliefGrid, half_of_a_cells_mass_lies_where_its_density_is_larger) {
  GridCell cell;
  EXPECT_DOUBLE_EQ(cell.quantile(0.5), 0.5);
  cell.rise = std::log(3.0);
  // The integral of 3^x from 0 to q is half of that to 1: 3^q = 2.
  EXPECT_NEAR(cell.quantile(0.5), std::log(2.0) / std::log(3.0), 1e-12);
  // The mean of that density is 3/2 - 1/ln 3.
  EXPECT_NEAR(cell.mean(), 1.5 - 1 / std::log(3.0), 1e-3);
  cell.rise = 2e5;  // more than a double can hold: nearly all is at the upper end
  EXPECT_NEAR(cell.quantile(0.5), 1 + std::log(0.5) / 2e5, 1e-12);
}

}  // namespace
}  // namespace belief_grid_test
