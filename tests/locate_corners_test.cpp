// Corners: the pivot at a convex one makes f a set; a concave one has no pivot.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rollfix/locate.hpp"
#include "shapes.hpp"

namespace locate_corners_test {
namespace {

using namespace rollfix;
using shapes::kPi;
using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::Pointwise;

TEST(Corner, the_edges_of_a_square_are_four_stretches) {
  const Search search = locate(shapes::unit_square(), {0.5, 0});
  ASSERT_EQ(search.placements.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(search.placements[k].kind, Kind::stretch);
    EXPECT_NEAR(search.placements[k].extent[0].lo, static_cast<double>(k), 1e-9);
    EXPECT_NEAR(search.placements[k].extent[0].hi, static_cast<double>(k) + 0.5, 1e-9);
  }
}

TEST(Corner, a_turn_between_those_of_the_sides_is_a_pivot_at_the_start_or_at_the_end) {
  const Search search = locate(shapes::unit_square(), {0.5, kPi / 4});
  EXPECT_THAT(shapes::kinds(search), Each(Kind::corner));
  EXPECT_THAT(shapes::starts(search), Pointwise(DoubleNear(1e-9), std::vector<double>{0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5}));
  const Placement& at_start = search.placements[0];
  EXPECT_EQ(at_start.extent[0].width(), 0);
  EXPECT_EQ(at_start.sensitivity.per_turn[0][0], 0);
  EXPECT_EQ(at_start.sensitivity.per_length[0][0][0], 0);
  EXPECT_NEAR(at_start.tangent[0], -kPi / 4, 1e-12);
  const Placement& at_end = search.placements[1];
  EXPECT_EQ(at_end.sensitivity.per_turn[0][0], 0);
  EXPECT_EQ(at_end.sensitivity.per_length[0][0][0], -1);
}

TEST(Corner, corners_at_both_ends_are_one_placement_with_the_pivots_that_are_possible) {
  const Search search = locate(shapes::unit_square(), {1, kPi / 4});
  ASSERT_EQ(search.placements.size(), 4U);
  const Placement& placement = search.placements[0];
  EXPECT_EQ(placement.kind, Kind::corner);
  ASSERT_TRUE(placement.pivot.has_value());
  EXPECT_NEAR((*placement.pivot)[0].start.lo, -kPi / 4, 1e-12);
  EXPECT_NEAR((*placement.pivot)[0].start.hi, 0, 1e-12);
  EXPECT_NEAR((*placement.pivot)[0].end.lo, 0, 1e-12);
  EXPECT_NEAR((*placement.pivot)[0].end.hi, kPi / 4, 1e-12);
  EXPECT_TRUE(std::isnan(placement.sensitivity.per_turn[0][0]));
}

TEST(Corner, a_roll_from_edge_to_edge_of_a_square_fits_everywhere) {
  EXPECT_EQ(locate(shapes::unit_square(), {1, kPi / 2}).verdict().text(), "unobservable");
}

TEST(Corner, a_pivot_alone_has_no_length) {
  const Search search = locate(shapes::unit_square(), {0, 0.5});
  EXPECT_THAT(shapes::kinds(search), Each(Kind::corner));
  EXPECT_EQ(search.placements.size(), 4U);
  EXPECT_EQ(locate(shapes::unit_square(), {0, 1.6}).placements.size(), 0U);  // more than a corner turns
  EXPECT_EQ(locate(shapes::unit_square(), {0, -0.5}).placements.size(), 4U);
}

TEST(Corner, all_readings_share_the_pivot_of_the_first_contact) {
  // Pivoted at a corner so that 45 degrees are left there: 0.3 along the edge and 0.6 along it read the same turn.
  const Part square = shapes::unit_square();
  EXPECT_THAT(shapes::starts(locate(square, std::vector<Reading>{{0.3, kPi / 4}, {0.6, kPi / 4}})),
              Pointwise(DoubleNear(1e-9), std::vector<double>{0, 1, 2, 3}));
  EXPECT_TRUE(locate(square, std::vector<Reading>{{0.3, kPi / 4}, {0.6, kPi / 3}}).placements.empty());
}

TEST(Corner, a_concave_corner_has_no_pivot) {
  const Part notch(shapes::polygon({{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}));
  EXPECT_TRUE(locate(notch, {0.5, -kPi / 4}).placements.empty());
  const Search across = locate(notch, {0.5, -kPi / 2});  // a bare reading may span it
  ASSERT_EQ(across.placements.size(), 2U);
  EXPECT_THAT(shapes::kinds(across), Each(Kind::stretch));
  EXPECT_NEAR(across.placements[0].extent[0].lo, 6.5, 1e-9);
  EXPECT_NEAR(across.placements[0].extent[0].hi, 7, 1e-9);
}

TEST(Corner, a_start_at_a_concave_one_may_point_either_way_while_the_end_pivots) {
  // From (2, 1), before it downwards and after it to the left, to (1, 2), where the finger comes up and goes left.
  const Part notch(shapes::polygon({{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}));
  EXPECT_TRUE(shapes::holds(notch, locate(notch, {2, -kPi / 4}), 7, 1e-9));
  EXPECT_TRUE(shapes::holds(notch, locate(notch, {2, -3 * kPi / 4}), 7, 1e-9));
  EXPECT_FALSE(shapes::holds(notch, locate(notch, {2, kPi / 4}), 7, 1e-9));
}

TEST(Corner, a_roll_from_an_open_curves_very_end_may_end_in_a_pivot) {
  const Part angle(shapes::polygon({{0, 0}, {2, 0}, {2, 3}}, false));
  EXPECT_THAT(shapes::starts(locate(angle, {2, kPi / 4})), ElementsAre(DoubleNear(0, 1e-9), DoubleNear(2, 1e-9)));
  EXPECT_THAT(shapes::starts(locate(angle, {-3, -kPi / 4})), ElementsAre(DoubleNear(5, 1e-9)));
}

TEST(Corner, a_rounding_far_smaller_than_the_roll_tends_to_the_corner) {
  const Part sharp(gallery("polygon,n=3,r=1"));
  const double side = sharp.perimeter() / 3;
  const Search corner = locate(sharp, {0.25 * side, 1});
  EXPECT_EQ(corner.placements.size(), 6U);
  EXPECT_THAT(shapes::kinds(corner), Each(Kind::corner));
}

TEST(Corner, of_a_wing_at_the_first_point_is_found_across_the_seam) {
  const Part wing(gallery("naca,digits=0012"));
  ASSERT_EQ(wing.corners().size(), 1U);
  EXPECT_EQ(wing.corners()[0].s, 0);
  const double before = wing.turning().angle(-0.1, Side::before);
  const double after = wing.turning().angle(0.1);
  const Search search = locate(wing, {0.2, after - before});
  EXPECT_TRUE(shapes::holds(wing, search, wing.perimeter() - 0.1, 1e-9));
}

TEST(Corner, of_a_reuleaux_triangle_between_arcs) {
  const Part part(gallery("reuleaux,width=1"));
  EXPECT_EQ(locate(part, {0.2, 0.2}).placements.size(), 3U);  // along an arc: stretches
  const Search search = locate(part, {0.2, 0.5});             // an arc and a part of a corner's 120 degrees
  EXPECT_EQ(search.placements.size(), 6U);
  EXPECT_THAT(shapes::kinds(search), Each(Kind::corner));
}

}  // namespace
}  // namespace locate_corners_test
