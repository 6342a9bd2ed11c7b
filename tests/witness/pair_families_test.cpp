// A stretch reaches as far as the pairs that fit, and the line through it runs through all of them.

#include <gtest/gtest.h>

#include "pair_cases.hpp"
#include "pair_oracle.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

namespace pair_families_test {
namespace {

using namespace rollfix;

TEST(PairFamilies, a_fold_is_in_the_extent_of_a_stretch_that_folds_between_its_samples) {
  const Outline outline = gallery("spline");
  const Part part(outline);
  const Reading reading{0.16794155640297431, 0.60547448341776733, -0.45690797298424624};
  const PerFinger<double> near_the_fold{2.2080034203627035, 0.3785676637628308};  // found by Newton's method elsewhere
  const pair_oracle::Boundary boundary(outline);
  EXPECT_NEAR(boundary.phi(near_the_fold[0], reading.length[0]) - boundary.phi(near_the_fold[1], reading.length[1]),
              reading.turn, 1e-12);
  const Search search = locate(part, {{0, 0, 0}, reading});
  EXPECT_TRUE(pair_cases::holds(part, search, near_the_fold, 1e-9 * part.perimeter()));
}

TEST(PairFamilies, pivots_of_two_contacts_at_once_are_on_the_line_through_their_stretch) {
  const Part part(gallery("polygon,n=7"));
  const double side = part.perimeter() / 7;
  // Finger a rolls from within a side to the corner s = 0 and pivots there; finger b stays on one side.
  const PerFinger<double> start{3.49 * side, 0.08 * side};
  const double pivot = 0.6 * 2 * shapes::kPi / 7;
  const Reading reading{3.51 * side, 0.09 * side, 3 * 2 * shapes::kPi / 7 + pivot};
  const Search search = locate(part, {reading, reading});
  EXPECT_TRUE(pair_cases::holds(part, search, start, 1e-9 * part.perimeter()));
}

TEST(PairFamilies, a_stretch_starts_where_its_first_contact_is_least_whatever_the_order_of_the_readings) {
  std::mt19937_64 generator(test_seed());
  for (const char* name : {"polygon", "reuleaux", "stadium", "rounded-rectangle"}) {
    const Part part(gallery(name));
    for (int k = 0; k < test_count(20); ++k) {
      const std::vector<Reading> readings = pair_cases::random_case(part, 2, generator).readings;
      const Search search = locate(part, readings);
      const Search reversed = locate(part, {readings[1], readings[0]});
      ASSERT_EQ(search.placements.size(), reversed.placements.size()) << name << k;
      for (std::size_t i = 0; i < search.placements.size(); ++i) {
        const Placement& placement = search.placements[i];
        if (placement.kind != Kind::stretch || placement.whole_loop[0]) continue;
        const Boundary boundary = part.boundary();
        const double near = 1e-8 * part.perimeter();
        EXPECT_NEAR(boundary.offset(placement.extent[0].lo, placement.start[0]), 0, near) << name << k;
        for (const std::size_t finger : {0U, 1U}) {
          EXPECT_NEAR(boundary.offset(reversed.placements[i].start[finger], placement.start[finger]), 0, near)
              << name << k;
        }
      }
    }
  }
}

TEST(PairFamilies, a_line_leaves_no_placement_beside_it_that_does_not_fit) {
  // Found by a random search: on the line the facing is off by up to twice the tolerance where the turn is right.
  const std::vector<Vec2> points{{0.88202, 0},        {1.09064, 0.79240}, {0.45730, 1.40741},   {-0.27884, 0.85818},
                                 {-0.25687, 0.18663}, {-0.66588, 0},      {-0.43284, -0.31447}, {-0.24169, -0.74384},
                                 {0.09289, -0.28588}, {0.71569, -0.51998}};
  const Part part(Outline{"blob", spline_through(points, true), true});
  LocateOptions options;
  options.tolerance = 0.00022461693988221185;
  options.facing = 1.8213082414664417;
  options.budget = 20000;
  constexpr double kMostOff = 1.25;  // of the tolerance: a placement is told by the middle of its band
  for (const Placement& placement : locate(part, Reading(0, 0, 0), options).placements) {
    EXPECT_LE(placement.residual, kMostOff * options.tolerance);
  }
}

}  // namespace
}  // namespace pair_families_test
