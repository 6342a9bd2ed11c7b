// The laws of the search, each on random outlines of every kind, one finger and two by the same words. Their numbers
// are those of rollfix/locate.hpp.

#include "laws.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>

#include "random.hpp"

namespace laws_test {
namespace {

using namespace laws;

double any_share() { return *rc::gen::inRange(1, 100) / 100.0; }

// Law (1)
RC_GTEST_PROP(Laws, the_truth_that_made_the_readings_is_among_the_answers, ()) {
  const Asked asked = *any_asked();
  const Part part = asked.part();
  const Search search = asked.search();
  RC_ASSERT(search.status == Status::complete);
  RC_ASSERT(std::any_of(search.placements.begin(), search.placements.end(), [&](const Placement& placement) {
    bool holds = true;
    for (std::size_t finger = 0; finger < asked.start.size(); ++finger) {
      holds =
          holds && (placement.whole_loop[finger] ||
                    part.boundary().contains(placement.extent[finger], asked.start[finger], kPlace * part.perimeter()));
    }
    return holds;
  }));
}

// Law (2)
RC_GTEST_PROP(Laws, moving_and_turning_the_part_changes_nothing, ()) {
  const Asked asked = *any_asked();
  Asked moved = asked;
  move(moved, turned_by(2 * std::numbers::pi * any_share()), {any_share(), -any_share()});
  expect_same(asked, moved, {});
}

// Law (3)
RC_GTEST_PROP(Laws, scaling_the_part_scales_the_places, ()) {
  const Asked asked = *any_asked();
  const double factor = std::pow(10.0, *rc::gen::inRange(-9, 10));
  Asked scaled = asked;
  move(scaled, factor * Eigen::Matrix2d::Identity(), Vec2::Zero());
  scaled.outline.gap *= factor;
  for (Reading& reading : scaled.readings) {
    for (double& length : reading.length) length *= factor;
  }
  Map map;
  map.factor = factor;
  expect_same(asked, scaled, map);
}

/// Angles of pivots have no unit: they are halved as far in millimetres as in kilometres.
// Law (3)
TEST(Laws, pivots_of_two_fingers_are_decided_in_every_unit) {
  for (const double side : {1.0, 1e-7, 1e7}) {
    const Part hexagon(gallery(fmt::format("polygon,n=6,r={}", side)));
    const Search search = locate(hexagon, {{2 * side, 2 * side, -0.9}, {side, side, 0}});
    EXPECT_EQ(search.status, Status::complete) << side;
    EXPECT_EQ(search.placements.size(), 1U) << side;
  }
}

// Law (4)
RC_GTEST_PROP(Laws, mirroring_the_part_mirrors_the_places, ()) {
  const Asked asked = *any_asked();
  Asked mirrored = asked;
  move(mirrored, Eigen::Vector2d(-1, 1).asDiagonal().toDenseMatrix(), Vec2::Zero());
  if (!asked.outline.closed) mirrored.outline = reversed(mirrored.outline);  // a closed one is turned round by itself
  turn_round(mirrored.readings);
  if (mirrored.options.facing) *mirrored.options.facing *= -1;
  Map map;
  map.backwards = true;
  expect_same(asked, mirrored, map);
}

// Law (5)
RC_GTEST_PROP(Laws, the_direction_in_which_a_closed_outline_was_drawn_changes_nothing, ()) {
  const Asked asked = *any_asked();
  RC_PRE(asked.outline.closed);
  Asked other_way = asked;
  other_way.outline = reversed(other_way.outline);
  expect_same(asked, other_way, {});
}

// Law (6)
RC_GTEST_PROP(Laws, other_parameters_of_the_same_curves_change_nothing, ()) {
  const Asked asked = *any_asked();
  Asked paced = asked;
  const double bend = any_share() - 0.5;
  for (Curve& curve : paced.outline.curves) curve = Paced{curve, curve.domain(), bend};
  expect_same(asked, paced, {});
}

/// As a drawing has arcs that are written as splines: equal curvatures differ in their last digits.
// Law (6)
TEST(Laws, arcs_that_are_general_curves_leave_the_stretches_that_arcs_leave) {
  Asked asked{"stadium",
              gallery("stadium,length=0.22358097378897623,r=0.7205602027664347"),
              {{-1.1656171957963593, 4.6699407508919579, -7.1677772453879633},
               {-1.1070947540394132, -3.5350516050614904, 3.3695405903635307}},
              {},
              {0.0, 0.0}};
  asked.outline.gallery.clear();
  Asked general = asked;
  for (Curve& curve : general.outline.curves) curve = Paced{curve, curve.domain(), -0.49};
  EXPECT_EQ(asked.search().placements.size(), 4U);
  expect_same(asked, general, {});
}

// Law (6)
RC_GTEST_PROP(Laws, cutting_the_curves_changes_nothing, ()) {
  const Asked asked = *any_asked();
  Asked finer = asked;
  cut(finer, any_share());
  expect_same(asked, finer, {});
}

// Law (7)
RC_GTEST_PROP(Laws, another_first_point_shifts_the_places, ()) {
  const Asked asked = *any_asked();
  RC_PRE(asked.outline.closed);
  Asked elsewhere = asked;
  cut(elsewhere, any_share());
  const double off = start_at(elsewhere, *rc::gen::inRange<std::size_t>(1, elsewhere.outline.curves.size()));
  Map map;
  map.shift = {-off, -off};
  expect_same(asked, elsewhere, map);
}

// Law (8)
RC_GTEST_PROP(Laws, the_order_of_readings_does_not_matter, ()) {
  const Asked asked = *any_asked();
  Asked ordered = asked;
  std::reverse(ordered.readings.begin(), ordered.readings.end());
  expect_same(asked, ordered, {});
}

// Law (9)
RC_GTEST_PROP(Laws, swapping_the_fingers_swaps_the_places, ()) {
  const Asked asked = *any_asked_of(2);
  Asked swapped = asked;
  for (Reading& reading : swapped.readings) reading = {reading.length[1], reading.length[0], -reading.turn};
  if (swapped.options.facing) *swapped.options.facing *= -1;
  Map map;
  map.swapped = true;
  expect_same(asked, swapped, map);
}

// Law (10)
RC_GTEST_PROP(Laws, rolling_back_starts_where_the_roll_ended, ()) {
  const Asked asked = *rc::gen::oneOf(any_asked(1, 1, false), any_asked(2, 1, true));
  const Reading there = asked.readings.front();
  Asked back = asked;
  turn_round(back.readings);
  if (back.options.facing) *back.options.facing += there.turn;
  Map map;
  map.starts_only = asked.start.size() == 2;
  for (std::size_t finger = 0; finger < asked.start.size(); ++finger) map.shift[finger] = there.length[finger];
  expect_same(asked, back, map);
}

/// A roll in two steps is a reading after each: what fits both is where what fits one and what fits the other meet.
// Law (11)
RC_GTEST_PROP(Laws, a_reading_on_the_way_leaves_what_fits_both, ()) {
  const Asked asked = *any_asked(1, 2, false);
  const Part part = asked.part();
  const Search together = asked.search(), first = locate(part, asked.readings[0]),
               last = locate(part, asked.readings[1]);
  const double slack = kPlace * part.perimeter();
  const auto holds = [&](const Search& search, double s) {
    return std::any_of(search.placements.begin(), search.placements.end(), [&](const Placement& placement) {
      return part.boundary().contains(placement.extent[0], s, slack);
    });
  };
  for (const Placement& placement : together.placements) {
    RC_ASSERT(holds(first, placement.start[0]) && holds(last, placement.start[0]));
  }
  for (const Placement& placement : first.placements) {
    const double s = placement.start[0];
    const bool is_pivot = placement.kind == Kind::corner;  // whose angle both readings share
    if (!is_pivot && holds(last, s) &&
        std::abs(turn(part, s, asked.readings[1].length[0]) - asked.readings[1].turn) < 1e-10) {
      RC_ASSERT(holds(together, s));
    }
  }
}

}  // namespace
}  // namespace laws_test
