// Stretches, double roots, near misses: every degenerate case by name, on parts where the answer is known by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "shapes.hpp"

namespace locate_kinds_test {
namespace {

using namespace rollfix;
using shapes::kPi;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

MATCHER_P2(Spans, lo, hi, "") {
  return std::abs(arg.extent[0].lo - lo) < 1e-8 && std::abs(arg.extent[0].hi - hi) < 1e-8;
}

// ---- stretches ----

TEST(Stretch, a_circle_answers_one_stretch_all_around) {
  const Part circle(gallery("circle,r=2"));
  const Search search = locate(circle, {1, 0.5});
  ASSERT_THAT(shapes::kinds(search), ElementsAre(Kind::stretch));
  EXPECT_THAT(search.placements[0], Spans(0, 4 * kPi));
  EXPECT_EQ(search.verdict().text(), "unobservable");
}

TEST(Stretch, a_circle_of_the_wrong_radius_answers_nothing) {
  EXPECT_EQ(locate(Part(gallery("circle,r=2")), {1, 0.4}).verdict().text(), "inconsistent");
}

TEST(Stretch, a_roll_of_no_length_and_no_turn_fits_everywhere) {
  EXPECT_EQ(locate(Part(gallery("ellipse")), {0, 0}).verdict().text(), "unobservable");
}

TEST(Stretch, a_turn_without_length_fits_nowhere_on_a_smooth_part) {
  EXPECT_EQ(locate(Part(gallery("ellipse")), {0, 0.1}).verdict().text(), "inconsistent");
}

TEST(Stretch, whole_laps_fit_everywhere_in_either_direction) {
  const Part part(gallery("spline,seed=2"));
  for (const int laps : {-2, -1, 1, 3}) {
    EXPECT_EQ(locate(part, {laps * part.perimeter(), laps * 2 * kPi}).verdict().text(), "unobservable") << laps;
    EXPECT_EQ(locate(part, {laps * part.perimeter(), laps * 2 * kPi + 0.01}).verdict().text(), "inconsistent") << laps;
  }
}

TEST(Stretch, whole_laps_fit_everywhere_though_their_length_is_rounded_and_the_curvature_large) {
  const Part part(gallery("spline,n=40,seed=3"));
  ASSERT_GT(part.turning().most_curvature(), 500);
  for (const double rounded : {1 - 4e-16, 1.0, 1 + 4e-16}) {
    EXPECT_EQ(locate(part, {part.perimeter() * rounded, 2 * kPi}).verdict().text(), "unobservable");
  }
}

TEST(Stretch, a_symmetric_part_cannot_tell_rolls_from_one_of_its_images_to_the_next) {
  for (const int teeth : {2, 5, 12}) {
    const Part part(gallery("gear,r=1,depth=0.05,teeth=" + std::to_string(teeth)));
    const double step = part.perimeter() / teeth;
    for (const int steps : {1, teeth - 1, -1, 2 * teeth + 1}) {
      EXPECT_EQ(locate(part, {steps * step, steps * 2 * kPi / teeth}).verdict().text(), "unobservable")
          << teeth << " " << steps;
    }
  }
  const Part ellipse(gallery("ellipse,a=3,b=1"));
  EXPECT_EQ(locate(ellipse, {ellipse.perimeter() / 2, kPi}).verdict().text(), "unobservable");
}

TEST(Stretch, a_line_on_a_line_is_a_stretch_as_long_as_the_rest_of_it) {
  const Part stadium(gallery("stadium,length=2,r=0.5"));
  const Search search = locate(stadium, {0.5, 0});
  ASSERT_THAT(shapes::kinds(search), Each(Kind::stretch));
  ASSERT_EQ(search.placements.size(), 2U);
  for (const Placement& placement : search.placements) EXPECT_NEAR(placement.extent[0].width(), 1.5, 1e-8);
  EXPECT_EQ(search.verdict().text(), "ambiguous (2)");
}

TEST(Stretch, an_arc_on_an_equal_arc_is_a_stretch) {
  const Part stadium(gallery("stadium,length=2,r=0.5"));
  const Search search = locate(stadium, {0.25, 0.5});
  ASSERT_THAT(shapes::kinds(search), ElementsAre(Kind::stretch, Kind::stretch));
  EXPECT_NEAR(search.placements[0].extent[0].width(), 0.5 * kPi - 0.25, 1e-8);
}

TEST(Stretch, from_one_line_to_the_opposite_one_is_a_stretch) {
  const Part stadium(gallery("stadium,length=2,r=0.5"));
  const Search search = locate(stadium, {0.5 * kPi + 1, kPi});
  ASSERT_THAT(shapes::kinds(search), ElementsAre(Kind::stretch, Kind::stretch));
  for (const Placement& placement : search.placements) EXPECT_NEAR(placement.extent[0].width(), 1, 1e-8);
}

TEST(Stretch, across_the_first_point_is_one_stretch_whose_extent_exceeds_the_perimeter) {
  const Part part(shapes::polygon({{1, 0}, {2, 0}, {2, 1}, {0, 1}, {0, 0}}));  // the first point is on an edge
  const Search search = locate(part, {0.5, 0});
  ASSERT_EQ(search.placements.size(), 4U);
  EXPECT_THAT(search.placements.back(), Spans(5, 6.5));
}

TEST(Stretch, a_straight_open_curve_is_one_stretch) {
  const Part line(shapes::polygon({{0, 0}, {3, 4}}, false));
  EXPECT_THAT(locate(line, {2, 0}).placements, ElementsAre(Spans(0, 3)));
  EXPECT_THAT(locate(line, {-2, 0}).placements, ElementsAre(Spans(2, 5)));
  EXPECT_EQ(locate(line, {2, 0}).verdict().text(), "ambiguous (1 stretch)");
  EXPECT_EQ(locate(line, {2, 0.1}).verdict().text(), "inconsistent");
}

// ---- nearly congruent stretches: f is tiny all along ----

TEST(NearlyCongruent, a_roll_far_shorter_than_any_feature_is_decided_quickly) {
  const Part part(gallery("spline,seed=3"));
  for (const double share : {1e-4, 1e-6, 1e-8}) {
    const double length = share * part.perimeter();
    const Search search = locate(part, shapes::reading_from(part, 1.5, length));
    EXPECT_EQ(search.status, Status::complete) << share;
    EXPECT_TRUE(shapes::holds(part, search, 1.5, 1e-9)) << share;
    EXPECT_LT(search.counts.intervals, 20000U) << share;
  }
}

TEST(NearlyCongruent, a_roll_that_is_almost_a_symmetry_is_decided_quickly) {
  const Part part(gallery("gear,teeth=12"));
  for (const double off : {1e-4, 1e-7, 1e-10}) {
    const double length = part.perimeter() / 12 + off;
    const Search search = locate(part, shapes::reading_from(part, 0.3, length));
    EXPECT_EQ(search.status, Status::complete) << off;
    EXPECT_TRUE(shapes::holds(part, search, 0.3, 1e-9)) << off;
    EXPECT_LT(search.counts.intervals, 20000U) << off;
  }
}

TEST(NearlyCongruent, a_whole_loop_within_the_tolerance_tells_nothing) {
  const Part part(gallery("ellipse,a=1,b=0.9999999999"));
  EXPECT_EQ(locate(part, {0.5, 0.5}).verdict().text(), "unobservable");
}

// ---- double roots ----

/// The turn over rolls of this length is largest (or least) where the roll is centred on this vertex.
Reading extreme_reading(const Part& part, double vertex, double length, double beyond = 0) {
  Reading reading = shapes::reading_from(part, vertex - length / 2, length);
  reading.turn += beyond;
  return reading;
}

TEST(Touching, an_exact_double_root_is_one_placement_with_one_root) {
  const Part part(gallery("ellipse,a=1,b=0.5"));
  const Search search = locate(part, extreme_reading(part, 0, 1));
  ASSERT_THAT(shapes::kinds(search), ElementsAre(Kind::touching, Kind::touching));
  for (const Placement& placement : search.placements) {
    EXPECT_EQ(placement.roots.size(), 1U);
    EXPECT_TRUE(std::isinf(placement.error));
  }
  EXPECT_NEAR(search.placements[1].start[0], part.perimeter() - 0.5, 1e-7);
}

TEST(Touching, a_near_miss_within_the_tolerance_is_kept_and_says_so) {
  const Part part(gallery("ellipse,a=1,b=0.5"));
  const Search search = locate(part, extreme_reading(part, 0, 1, 3e-10));
  ASSERT_THAT(shapes::kinds(search), ElementsAre(Kind::touching, Kind::touching));
  EXPECT_TRUE(search.placements[0].roots.empty());
  EXPECT_NEAR(search.placements[0].residual, 3e-10, 1e-12);
}

TEST(Touching, a_miss_beyond_the_tolerance_is_no_placement) {
  const Part part(gallery("ellipse,a=1,b=0.5"));
  EXPECT_TRUE(locate(part, extreme_reading(part, 0, 1, 2e-9)).placements.empty());
}

TEST(Touching, two_roots_too_close_for_the_tolerance_are_one_placement_with_both) {
  const Part part(gallery("ellipse,a=1,b=0.5"));
  const Search search = locate(part, extreme_reading(part, 0, 1, -5e-10));
  ASSERT_THAT(shapes::kinds(search), ElementsAre(Kind::touching, Kind::touching));
  EXPECT_EQ(search.placements[0].roots.size(), 2U);
}

TEST(Touching, two_roots_further_apart_are_two_crossings) {
  const Part part(gallery("ellipse,a=1,b=0.5"));
  const Search search = locate(part, extreme_reading(part, 0, 1, -2e-9));
  EXPECT_THAT(shapes::kinds(search), ElementsAre(Kind::crossing, Kind::crossing, Kind::crossing, Kind::crossing));
}

TEST(Touching, a_fourfold_root_is_one_placement) {
  // Both ends at vertices that mirror each other: f, f', f'' and f''' vanish together.
  const Part part(gallery("limacon,a=1.5,b=1"));
  const double vertex = part.vertices()[1];
  ASSERT_GT(vertex, 0.1);
  const Search search = locate(part, extreme_reading(part, 0, 2 * vertex));
  EXPECT_EQ(search.status, Status::complete);
  ASSERT_EQ(search.placements.size(), 1U);
  EXPECT_EQ(search.placements[0].kind, Kind::touching);
  EXPECT_NEAR(search.placements[0].start[0], part.perimeter() - vertex, 1e-3);
}

TEST(Touching, a_kink_of_f_at_a_joint_touches_without_a_derivative) {
  const Part stadium(gallery("stadium,length=2,r=0.5"));
  const Search search = locate(stadium, {2, 0});  // the whole of a straight side and no more
  ASSERT_THAT(shapes::kinds(search), ElementsAre(Kind::touching, Kind::touching));
  EXPECT_LT(search.placements[0].extent[0].width(), 1e-8);
}

// ---- tolerance, direction, laps ----

TEST(Tolerance, widens_the_extent_in_proportion) {
  const Part part(gallery("ellipse,a=1,b=0.5"));
  const Reading reading = shapes::reading_from(part, 0.3, 1);
  for (const double tolerance : {1e-9, 1e-6, 1e-4}) {
    LocateOptions options;
    options.tolerance = tolerance;
    for (const Placement& placement : locate(part, reading, options).placements) {
      const double expected = 2 * tolerance * std::abs(placement.sensitivity.per_turn[0][0]);
      EXPECT_NEAR(placement.extent[0].width(), expected, 0.02 * expected);
    }
  }
}

/// How far f is from the tolerance where the extents end, at most, in tolerances.
double off_the_tolerance(const std::string& shape, const Reading& reading, double tolerance) {
  const Part part(gallery(shape));
  LocateOptions options;
  options.tolerance = tolerance;
  double most = 0;
  for (const Placement& placement : locate(part, reading, options).placements) {
    for (const double end : {placement.extent[0].lo, placement.extent[0].hi}) {
      const double f = shapes::reading_from(part, end, reading.length[0]).turn - reading.turn;
      most = std::max(most, std::abs(std::abs(f) / tolerance - 1));
    }
  }
  return most;
}

TEST(Tolerance, is_what_f_has_where_extents_end) {
  const std::string needle = "ellipse,a=6.264228717559734,b=92.29928966110403";  // f bends fast near its tips
  EXPECT_LE(off_the_tolerance(needle, {1.3959103423343229, 0.6812037700197795}, 0.02), 2e-3);
  // Near one vertex f is beyond it by a thousandth, where the curvature is largest.
  const std::string snail = "limacon,a=3.0507013927464772,b=-0.6792475276586838";
  EXPECT_LE(off_the_tolerance(snail, {5.5353063748521152e-08, 1.761089815774039e-08}, 1e-9), 2e-3);
}

TEST(Direction, a_roll_backwards_starts_where_the_roll_forwards_ends) {
  const Part part(gallery("limacon"));
  const Reading reading = shapes::reading_from(part, 0.7, 1.3);
  const Search there = locate(part, reading);
  const Search back = locate(part, {-reading.length[0], -reading.turn});
  ASSERT_EQ(there.placements.size(), back.placements.size());
  for (const Placement& placement : there.placements) {
    EXPECT_TRUE(shapes::holds(part, back, placement.end[0], 1e-9));
  }
}

TEST(Laps, a_whole_lap_more_changes_no_placement) {
  const Part part(gallery("spline"));
  const Reading reading = shapes::reading_from(part, 1.1, 0.8);
  const Search once = locate(part, reading);
  const Search again = locate(part, {reading.length[0] + 2 * part.perimeter(), reading.turn + 4 * kPi});
  ASSERT_EQ(once.placements.size(), again.placements.size());
  for (std::size_t k = 0; k < once.placements.size(); ++k) {
    EXPECT_NEAR(once.placements[k].start[0], again.placements[k].start[0], 1e-9);
  }
}

TEST(Seam, a_placement_at_the_first_point_is_found_once) {
  const Part part(gallery("ellipse,a=1,b=0.5"));
  const Search search = locate(part, shapes::reading_from(part, 0, 1));
  EXPECT_EQ(search.placements.size(), 4U);
  EXPECT_TRUE(shapes::holds(part, search, 0, 1e-9));
}

TEST(Seam, a_root_behind_it_belongs_to_the_set_that_begins_before_it) {
  const Part part(gallery("spline,n=14,seed=4,wobble=0.2"));
  LocateOptions options;
  options.tolerance = 1e-2;
  const Search search = locate(part, shapes::reading_from(part, 1e-4, 0.8), options);
  const auto across = std::find_if(search.placements.begin(), search.placements.end(),
                                   [&](const auto& found) { return found.extent[0].hi > part.perimeter(); });
  ASSERT_NE(across, search.placements.end());
  EXPECT_EQ(across->kind, Kind::crossing);
  ASSERT_EQ(across->roots.size(), 1U);
  EXPECT_NEAR(across->roots[0][0], 1e-4, 1e-9);
  EXPECT_NEAR(across->start[0], 1e-4, 1e-9);
}

// ---- open curves ----

TEST(OpenCurve, a_roll_that_starts_or_ends_at_an_end_is_found) {
  const Part part(gallery("exponential"));
  const double length = 0.4 * part.perimeter();
  EXPECT_TRUE(shapes::holds(part, locate(part, shapes::reading_from(part, 0, length)), 0, 1e-9));
  const double last = part.perimeter() - length;
  EXPECT_TRUE(shapes::holds(part, locate(part, shapes::reading_from(part, last, length)), last, 1e-9));
}

TEST(OpenCurve, a_root_at_its_very_end_is_a_crossing) {
  const Part part(gallery("exponential"));
  const double length = 0.4 * part.perimeter();
  for (const double s : {0.0, part.perimeter() - length}) {
    const Search search = locate(part, shapes::reading_from(part, s, length));
    const auto at_end = std::find_if(search.placements.begin(), search.placements.end(),
                                     [&](const auto& found) { return std::abs(found.start[0] - s) < 1e-9; });
    ASSERT_NE(at_end, search.placements.end());
    EXPECT_EQ(at_end->kind, Kind::crossing);
    EXPECT_FALSE(at_end->sensitivity.per_turn[0].empty());
  }
}

TEST(OpenCurve, a_roll_over_all_of_it_has_one_place) {
  const Part part(gallery("log-spiral"));
  const Search search = locate(part, {part.perimeter(), part.total_turn()});
  EXPECT_THAT(search.placements, ElementsAre(Spans(0, 0)));
}

TEST(OpenCurve, a_roll_longer_than_it_is_refused) {
  const Part part(gallery("log-spiral"));
  EXPECT_THROW(locate(part, {1.01 * part.perimeter(), 1}), InputError);
}

// ---- what a search says of itself ----

TEST(Budget, a_search_that_runs_out_says_where_it_stopped) {
  LocateOptions options;
  options.budget = 5;
  const Part part(gallery("ellipse"));  // its halves are congruent: about half a lap is hard to tell from it
  const Search search = locate(part, shapes::reading_from(part, 1, 0.5 * part.perimeter() + 1e-5), options);
  EXPECT_EQ(search.status, Status::incomplete);
  ASSERT_FALSE(search.unresolved.empty());
  EXPECT_EQ(search.unresolved.back()[0].hi, part.perimeter());
  EXPECT_EQ(search.verdict().text(), "undecided");
}

TEST(Budget, of_several_readings_leaves_no_place_unsaid) {
  const Part part(gallery("gear,teeth=12"));
  const std::vector<Reading> readings{shapes::reading_from(part, 0.3, part.perimeter() / 12 + 1e-3),
                                      shapes::reading_from(part, 0.3, part.perimeter() / 5)};
  const Search whole = locate(part, readings);
  ASSERT_EQ(whole.status, Status::complete);
  for (std::size_t budget = 0; budget < 200; ++budget) {
    LocateOptions options;
    options.budget = budget;
    const Search search = locate(part, readings, options);
    EXPECT_EQ(search.status == Status::complete, search.unresolved.empty());
    for (const Placement& placement : whole.placements) {
      const double s = placement.start[0];
      const bool is_open = std::any_of(search.unresolved.begin(), search.unresolved.end(),
                                       [&](const auto& box) { return part.boundary().contains(box[0], s, 1e-9); });
      EXPECT_TRUE(is_open || shapes::holds(part, search, s, 1e-9)) << "budget " << budget << ", s = " << s;
    }
  }
}

// ---- below the outline's own rounding ----

TEST(BelowRounding, a_length_that_only_tight_arcs_can_tell_is_told_by_all_of_them) {
  const double length = -2e-12;  // a quarter of 1e-12 of the perimeter
  LocateOptions options;
  options.tolerance = 1e-9;
  const Search search = locate(Part(gallery("rounded-rectangle,r=0.001")), {length, length / 0.001}, options);
  EXPECT_THAT(shapes::kinds(search), ElementsAre(Kind::stretch, Kind::stretch, Kind::stretch, Kind::stretch));
}

TEST(BelowRounding, a_circle_s_own_length_is_a_stretch_and_another_touches) {
  const Part circle(gallery("circle"));
  EXPECT_THAT(shapes::kinds(locate(circle, {5.75e-12, 5.75e-12})), ElementsAre(Kind::stretch));
  EXPECT_THAT(shapes::kinds(locate(circle, {2.15e-12, 0.35e-12})), ElementsAre(Kind::touching));
}

TEST(BelowRounding, pieces_that_join_cross_only_where_f_changes_sign) {
  LocateOptions options;
  options.tolerance = kLeastTolerance;
  const Search half_around =
      locate(Part(gallery("rounded-rectangle")), {6.5707963267890008, 3.1415926535809162}, options);
  EXPECT_EQ(half_around.status, Status::complete);
  const Search one_rounding =
      locate(Part(gallery("rounded-rectangle,r=0.001")), {-0.0015707963333338802, -1.5707963267995664}, options);
  EXPECT_EQ(one_rounding.status, Status::complete);
}

}  // namespace
}  // namespace locate_kinds_test
