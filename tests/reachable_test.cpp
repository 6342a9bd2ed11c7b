// Placements that the readings allow and the finger does not.

#include "rollfix/locate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "random.hpp"
#include "shapes.hpp"

namespace reachable_test {
namespace {

using namespace rollfix;
using shapes::kPi;

Part l_shape() { return Part(shapes::polygon({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}})); }
Part u_shape() { return Part(shapes::polygon({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}})); }
Part limacon() { return Part(gallery("limacon,a=1,b=0.9")); }

LocateOptions tight() {
  LocateOptions options;
  options.tolerance = 1e-6;
  return options;
}

// ---- rolls

TEST(CanRoll, only_where_all_of_the_way_is_one_arc) {
  const Reach reach = reach_of_disk(u_shape(), 0.3);  // 9.3 to 9.7 and 10.3 to 24.7
  EXPECT_TRUE(can_roll(reach, {9.4, 9.4}, {0, 0.2}));
  EXPECT_FALSE(can_roll(reach, {9.4, 9.4}, {0, 0.5}));
  EXPECT_FALSE(can_roll(reach, {9.4, 9.4}, {-0.2, 0}));
  EXPECT_FALSE(can_roll(reach, {9.4, 9.4}, {0, 2}));  // it ends on an arc, but on another
  EXPECT_TRUE(can_roll(reach, {15, 15}, {0, 3}));     // across s = 0
  EXPECT_TRUE(can_roll(reach, {1, 1}, {-3, 3}));
  EXPECT_FALSE(can_roll(reach, {15, 15}, {0, 16}));  // a lap
}

TEST(CanRoll, from_somewhere_in_an_extent_is_enough) {
  const Reach reach = reach_of_disk(u_shape(), 0.3);
  EXPECT_TRUE(can_roll(reach, {9, 9.4}, {0, 0.2}));
  EXPECT_TRUE(can_roll(reach, {8, 12}, {0, 0.35}));
  EXPECT_FALSE(can_roll(reach, {8.5, 9.2}, {0, 0.45}));
  EXPECT_TRUE(can_roll(reach, {15.9, 17}, {0, 0}));
}

TEST(CanRoll, any_number_of_laps_of_a_part_that_is_all_within_reach) {
  const Reach reach = reach_of_disk(Part(gallery("ellipse")), 1);
  EXPECT_TRUE(can_roll(reach, {3, 3}, {-100, 1000}));
}

TEST(CanRoll, agrees_with_stepping_along_the_way) {
  std::mt19937_64 generator = test_generator(91);
  std::uniform_real_distribution<double> unit(0, 1);
  const Part part(gallery("spline,n=40,seed=3"), {true});
  const Reach reach = reach_of_disk(part, 0.03);
  ASSERT_FALSE(reach.is_whole());
  int possible = 0;
  for (int round = 0; round < test_count(500); ++round) {
    const double s = part.perimeter() * unit(generator);
    const Interval roll{-0.5 * part.perimeter() * std::pow(unit(generator), 2),
                        1.5 * part.perimeter() * std::pow(unit(generator), 2)};
    bool steps = true;
    for (int k = 0; k <= 2000; ++k) steps = steps && reach.contains(s + roll.lo + roll.width() * k / 2000);
    const bool rolls = can_roll(reach, {s, s}, roll);
    possible += rolls ? 1 : 0;
    EXPECT_TRUE(steps || !rolls) << "seed " << test_seed() << " round " << round;
    // A gap narrower than a step is all that stepping can miss.
    double narrowest = part.perimeter();
    for (const Interval& gap : reach.gaps()) narrowest = std::min(narrowest, gap.width());
    if (narrowest < roll.width() / 1000) continue;
    EXPECT_EQ(rolls, steps) << "seed " << test_seed() << " round " << round;
  }
  EXPECT_GT(possible, 10);
}

// ---- one finger

TEST(DropUnreachable, takes_out_what_lies_in_a_dimple_and_leaves_the_rest) {
  const Part part = limacon();
  const Reach reach = reach_of_disk(part, 0.5);
  const Interval arc = reach.arcs.at(0);
  std::mt19937_64 generator = test_generator(92);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t dropped = 0;
  for (int round = 0; round < test_count(100); ++round) {
    const double length = 1.5 * (unit(generator) - 0.5);
    const Reading reading = shapes::reading_from(part, part.perimeter() * unit(generator), length);
    Search search = locate(part, reading, tight());
    const std::vector<Placement> before = search.placements;
    const std::vector<Impossible> impossible = drop_unreachable(part, reach, {reading}, search.placements);
    EXPECT_EQ(search.placements.size() + impossible.size(), before.size());
    dropped += impossible.size();
    // The arc has two ends and goes round the outside: a roll is possible when both its ends are on it, and the gap,
    // which is shorter than the rest, is not passed.
    const auto inside = [&](double s) { return part.boundary().contains({arc.lo, arc.hi + 1e-4}, s); };
    for (const Placement& placement : search.placements) {
      EXPECT_TRUE(inside(placement.start[0]) && inside(placement.start[0] + length)) << "seed " << test_seed();
    }
    for (const Impossible& item : impossible) {
      const double s = item.placement.start[0];
      bool leaves = false;
      for (int k = 0; k <= 200; ++k) leaves = leaves || !reach.contains(s + length * k / 200);
      EXPECT_TRUE(leaves) << "seed " << test_seed() << " s " << s << " L " << length;
    }
  }
  EXPECT_GT(dropped, 5U);
}

TEST(DropUnreachable, never_drops_a_roll_that_stays_within_reach) {
  const Part part(gallery("gear"));
  const Reach reach = reach_of_disk(part, 0.2);
  std::mt19937_64 generator = test_generator(93);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < test_count(200); ++round) {
    const Interval& arc = reach.arcs[static_cast<std::size_t>(unit(generator) * 12) % reach.arcs.size()];
    const double s = arc.lo + arc.width() * unit(generator);
    const double length = arc.lo + arc.width() * unit(generator) - s;
    const Reading reading = shapes::reading_from(part, s, length);
    Search search = locate(part, reading, tight());
    drop_unreachable(part, reach, {reading}, search.placements);
    EXPECT_TRUE(shapes::holds(part, search, part.boundary().base(s), 1e-6)) << "seed " << test_seed();
  }
}

TEST(DropUnreachable, takes_the_instants_in_between_into_account) {
  // There and back: the last row is the first place again, but on the way the finger would have been in the corner.
  const Part part = l_shape();
  const Reach reach = reach_of_disk(part, 0.3);
  Search search = locate(part, {0.1, 0.0}, tight());
  const std::size_t all = search.placements.size();
  Search again = search;
  EXPECT_EQ(drop_unreachable(part, reach, {{0.1, 0.0}}, search.placements).size(), 0U);
  drop_unreachable(part, reach, {{0.1, 0.0}}, again.placements, {{1.9, 0.0}});
  EXPECT_LT(again.placements.size(), all);
}

TEST(DropUnreachable, allows_for_the_error_of_a_length) {
  // A finger that rolls until it meets the other side of the dimple, and a length of three digits.
  const Part part = limacon();
  const Reach reach = reach_of_disk(part, 0.5);
  const double s = reach.arcs.at(0).lo + 0.5;
  const double length = -0.5 - 4e-4;
  const Reading reading = shapes::reading_from(part, s, length);
  Search search = locate(part, reading, tight());
  Search again = search;
  drop_unreachable(part, reach, {reading}, search.placements);
  EXPECT_FALSE(shapes::holds(part, search, part.boundary().base(s), 1e-6));
  drop_unreachable(part, reach, {reading}, again.placements, {}, 5e-4);
  EXPECT_TRUE(shapes::holds(part, again, part.boundary().base(s), 1e-6));
}

TEST(DropUnreachable, says_where_the_finger_hits_what) {
  // Along the leg y = 1 towards the corner at (1, 1): the disk hits the leg x = 1.
  const Part part = l_shape();
  const Reach reach = reach_of_disk(part, 0.4);
  const auto obstruction = obstruction_of(part, reach, 5, {0, 0.9});
  ASSERT_TRUE(obstruction.has_value());
  EXPECT_FALSE(obstruction->concave_corner);
  EXPECT_NEAR(obstruction->s, 5.9, 1e-6);
  EXPECT_NEAR(obstruction->hit.depth, 0.3, 1e-6);
  EXPECT_NEAR(obstruction->hit.point.x(), 1, 1e-6);
  EXPECT_FALSE(obstruction_of(part, reach, 5, {0, 0.5}).has_value());
}

TEST(DropUnreachable, says_that_a_concave_corner_is_in_the_way) {
  const Part part = l_shape();
  const Reach reach = reach_of_disk(part, 1e-6);
  const auto obstruction = obstruction_of(part, reach, 5.5, {0, 1});
  ASSERT_TRUE(obstruction.has_value());
  EXPECT_NEAR(obstruction->s, 6, 1e-5);
}

TEST(DropUnreachable, of_a_pivot_looks_at_its_angles) {
  // At (2, 3), beside the slot's mouth, a disk wider than the slot can pivot away from the slot but not into it.
  const Part part = u_shape();
  const Reach reach = reach_of_disk(part, 0.6);
  const double limit = reach.pivots.at(3).angles.at(0).hi;
  const double edge = part.turning().angle(6.5);  // of the edge before the corner at s = 7
  const auto left = [&](double turn) {
    Search search = locate(part, {0.2, turn}, tight());
    drop_unreachable(part, reach, {{0.2, turn}}, search.placements);
    return std::any_of(search.placements.begin(), search.placements.end(),
                       [](const Placement& placement) { return std::abs(placement.start[0] - 6.8) < 1e-6; });
  };
  EXPECT_TRUE(left(limit - edge - 0.01));
  EXPECT_FALSE(left(limit - edge + 0.01));
}

TEST(DropUnreachable, a_pivot_that_is_barred_half_way_leads_to_the_side_where_it_began) {
  // A nail comes up to a right-angled corner: a disk touches the corner from either side and can't get past the nail.
  const Part part(shapes::polygon(
      {{0, 0}, {-6, 6}, {-8, 6}, {-8, -8}, {8, -8}, {8, 6}, {6, 6}, {6, 0.3}, {1.9, 0}, {6, -0.3}, {6, -6}, {-6, -6}}));
  const Reach reach = reach_of_disk(part, 1);
  ASSERT_EQ(reach.pivots.at(0).angles.size(), 2U);
  const auto left = [&](double length, double turn) {
    Search search = locate(part, {length, turn}, tight());
    drop_unreachable(part, reach, {{length, turn}}, search.placements);
    return std::any_of(search.placements.begin(), search.placements.end(),
                       [](const Placement& placement) { return std::abs(placement.start[0]) < 1e-6; });
  };
  EXPECT_TRUE(left(1, 0.1));
  EXPECT_FALSE(left(1, kPi / 2 - 0.1));
  EXPECT_TRUE(left(-1, -0.1));
  EXPECT_FALSE(left(-1, 0.1 - kPi / 2));
}

TEST(DropUnreachable, a_finger_that_only_pivots_gets_to_the_end_of_the_pivot) {
  // At the slot's mouth, at s = 7 and 12, a jaw lies along the hull and can't turn into the slot.
  const Part part = u_shape();
  for (const double turn : {0.5, -0.5}) {
    Search search = locate(part, {0, turn}, tight());
    EXPECT_EQ(drop_unreachable(part, reach_of_jaw(part), {{0, turn}}, search.placements).size(), 2U);
    EXPECT_THAT(shapes::starts(search), testing::Pointwise(testing::DoubleNear(1e-6), {0.0, 3.0, 6.0, 13.0}));
  }
}

TEST(DropUnreachable, of_a_jaw_leaves_what_is_on_the_convex_hull) {
  const Part part = limacon();
  const Reach reach = reach_of_jaw(part);
  const Reading outside = shapes::reading_from(part, 1, 0.5);
  Search search = locate(part, outside, tight());
  drop_unreachable(part, reach, {outside}, search.placements);
  EXPECT_TRUE(shapes::holds(part, search, 1, 1e-6));
  const Reading inside = shapes::reading_from(part, 0.5 * part.perimeter() - 0.1, 0.2);
  search = locate(part, inside, tight());
  const std::vector<Impossible> dropped = drop_unreachable(part, reach, {inside}, search.placements);
  EXPECT_FALSE(shapes::holds(part, search, 0.5 * part.perimeter() - 0.1, 1e-6));
  EXPECT_FALSE(dropped.empty());
}

// ---- two fingers

std::array<Reach, 2> disks(const Part& part, double a, double b) {
  return {reach_of_disk(part, a), reach_of_disk(part, b)};
}

Reading pair_reading(const Part& part, double s, double t, double length_a, double length_b) {
  const TurningFunction& turning = part.turning();
  return {length_a, length_b,
          (turning.angle(s + length_a) - turning.angle(s)) - (turning.angle(t + length_b) - turning.angle(t))};
}

/// Is the pair still there that the readings were made from?
bool remains(const Part& part, double s, double t, const std::vector<std::array<double, 2>>& lengths, double a,
             double b) {
  std::vector<Reading> readings;
  for (const auto& [length_a, length_b] : lengths) readings.push_back(pair_reading(part, s, t, length_a, length_b));
  Search search = locate(part, readings);
  drop_unreachable(part, disks(part, a, b), readings, search.placements);
  return std::any_of(search.placements.begin(), search.placements.end(), [&](const Placement& placement) {
    return std::abs(placement.start[0] - s) < 1e-6 && std::abs(placement.start[1] - t) < 1e-6;
  });
}

double centre_distance(const Part& part, double s, double t, double a, double b) {
  const auto centre = [&](double at, double r) {
    const double angle = part.turning().angle(at);
    return Vec2(part.point(at) + r * Vec2(std::sin(angle), -std::cos(angle)));
  };
  return (centre(s, a) - centre(t, b)).norm();
}

TEST(Overlap, drops_a_pair_whose_disks_are_in_each_other_and_keeps_one_whose_are_not) {
  const Part part(gallery("cam"));
  std::mt19937_64 generator = test_generator(94);
  std::uniform_real_distribution<double> unit(0, 1);
  int overlapping = 0;
  int apart = 0;
  for (int round = 0; round < test_count(40); ++round) {
    const double s = part.perimeter() * unit(generator);
    const double t = part.perimeter() * unit(generator);
    const double a = 0.1 + 0.8 * unit(generator);
    const double b = 0.1 + 0.8 * unit(generator);
    const std::vector<std::array<double, 2>> lengths{{0.4, -0.3}, {0.9, -0.8}};
    double least = centre_distance(part, s, t, a, b);
    for (const auto& [length_a, length_b] : lengths) {
      least = std::min(least, centre_distance(part, s + length_a, t + length_b, a, b));
    }
    if (std::abs(least - a - b) < 1e-3) continue;
    (least < a + b ? overlapping : apart) += 1;
    EXPECT_EQ(remains(part, s, t, lengths, a, b), least > a + b)
        << "seed " << test_seed() << " s " << s << " t " << t << " a " << a << " b " << b;
  }
  EXPECT_GT(overlapping, 3);
  EXPECT_GT(apart, 3);
}

TEST(Overlap, says_when_and_by_how_much) {
  const Part part(gallery("circle,r=1"));
  // A quarter apart on the circle, then both at one place: centres on a circle of radius 1.5.
  const std::vector<Reading> readings{{kPi / 4, -kPi / 4, 2 * kPi / 4}};
  LocateOptions options;
  options.facing = -kPi / 2;
  Search search = locate(part, readings, options);
  const std::vector<Impossible> dropped = drop_unreachable(part, disks(part, 0.5, 0.5), readings, search.placements);
  ASSERT_EQ(dropped.size(), 1U);
  EXPECT_TRUE(search.placements.empty());
  EXPECT_EQ(dropped[0].reason, Impossible::Reason::overlap);
  EXPECT_EQ(dropped[0].instant, 1U);
  EXPECT_NEAR(dropped[0].depth, 1, 1e-6);
}

TEST(Overlap, of_fingers_at_different_heights_is_none) {
  const Part part(gallery("circle,r=1"));
  const std::vector<Reading> readings{{kPi / 4, -kPi / 4, 2 * kPi / 4}};
  LocateOptions options;
  options.facing = -kPi / 2;
  Search search = locate(part, readings, options);
  EXPECT_TRUE(drop_unreachable(part, disks(part, 0.5, 0.5), readings, search.placements, {}, 0, true).empty());
  EXPECT_EQ(search.placements.size(), 1U);
}

TEST(Overlap, drops_an_extent_only_where_the_disks_are_in_each_other_from_everywhere_in_it) {
  // On a circle of radius 1, disks of radius 0.5 are apart where their contacts are 2 asin(1 / 3) = 0.68 apart.
  const Part part(gallery("circle,r=1"));
  const std::vector<Reading> readings{{0.3, 0.3, 0}};
  for (const double reach : {0.01, 0.02, 0.06, 0.2}) {
    Placement placement;
    placement.kind = Kind::crossing;
    placement.start = placement.end = PerFinger<double>(1.0, 1.6);
    placement.extent = PerFinger<Interval>(Interval{1 - reach, 1 + reach}, Interval{1.6 - reach, 1.6 + reach});
    placement.whole_loop = PerFinger<bool>(false, false);
    Search search;
    search.placements.push_back(placement);
    drop_unreachable(part, disks(part, 0.5, 0.5), readings, search.placements);
    EXPECT_EQ(search.placements.size(), reach > 0.05 ? 1U : 0U) << reach;
  }
}

TEST(Overlap, drops_the_continuum_of_two_fingers_at_one_place) {
  // Equal rolls and no turn: t = s fits everywhere, and two disks can't be there.
  const Part part(gallery("cam"));
  const std::vector<Reading> readings{{0.5, 0.5, 0}};
  LocateOptions options;
  options.facing = 0;
  Search search = locate(part, readings, options);
  ASSERT_FALSE(search.placements.empty());
  drop_unreachable(part, disks(part, 0.2, 0.2), readings, search.placements);
  for (const Placement& placement : search.placements) EXPECT_NE(placement.kind, Kind::stretch);
}

TEST(DropUnreachable, of_two_fingers_names_the_one_that_leaves_its_reach) {
  const Part part = limacon();
  const double dimple = 0.5 * part.perimeter();
  std::vector<Reading> readings{pair_reading(part, 1, dimple - 0.05, 0.4, 0.08),
                                pair_reading(part, 1, dimple - 0.05, 0.8, 0.11)};
  LocateOptions options;
  options.facing = part.turning().angle(1) - part.turning().angle(dimple - 0.05);
  Search search = locate(part, readings, options);
  const std::vector<Impossible> dropped = drop_unreachable(part, disks(part, 0.3, 0.3), readings, search.placements);
  const auto mine = std::find_if(dropped.begin(), dropped.end(),
                                 [&](const Impossible& item) { return std::abs(item.placement.start[0] - 1) < 1e-6; });
  ASSERT_NE(mine, dropped.end());
  EXPECT_EQ(mine->reason, Impossible::Reason::reach);
  EXPECT_EQ(mine->finger, 1U);
  EXPECT_GT(mine->obstruction.hit.depth, 0.01);
}

}  // namespace
}  // namespace reachable_test
