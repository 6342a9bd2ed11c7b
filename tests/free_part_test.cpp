// Two disks that roll on a part which is free to move: what their sensors say and how everything moves.
#include "integrated_rolls.hpp"
#include "rollfix/rolling.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "free_roll.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

namespace rollfix::free_part_test {
namespace {

using free_rolls::boundary_point;
using free_rolls::by_distances;
using free_rolls::by_profiles;
using free_rolls::centre_at;
using free_rolls::felt_contact;
using free_rolls::part_of;
using free_rolls::rate;
using integrated_rolls::integrated_roll_free;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
constexpr double kPi = std::numbers::pi;

Reading reading_at(const FingerRows& rows, double radius, std::size_t row) {
  return reading_between({radius}, {rows.u[0], rows.psi[0]}, {rows.u[row], rows.psi[row]});
}

/// The largest difference between two rolls in anything that they say.
double difference(const Roll& one, const Roll& two) {
  double most = 0;
  const auto compare = [&](const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  };
  compare(one.log.time, two.log.time);
  for (const std::size_t finger : {0U, 1U}) {
    for (const auto& column : {&FingerRows::u, &FingerRows::psi, &FingerRows::x, &FingerRows::y}) {
      compare(one.log.fingers[finger].*column, two.log.fingers[finger].*column);
    }
    compare(one.s[finger], two.s[finger]);
    compare(one.angle[finger], two.angle[finger]);
  }
  for (std::size_t k = 0; k < one.pose.size(); ++k) {
    most = std::max({most, std::abs(one.pose[k].x - two.pose[k].x), std::abs(one.pose[k].y - two.pose[k].y),
                     std::abs(one.pose[k].heading - two.pose[k].heading)});
  }
  return most;
}

// --- Signs, on circles: everything is known there.

TEST(FreePart, on_a_circle_that_turns_by_itself_all_signs_are_known) {
  const double R = 2;
  const Part circle = part_of("circle,r=2");
  FreePlan plan = by_distances(0.5, 0, R * 0.75, 0.25, R * kPi, R * -0.5, 0.3);
  plan.pose = {};
  plan.fingers[0].psi = plan.fingers[1].psi = 0;
  const Roll found = roll_free(circle, plan);
  // Against the part a coin turns by (1 + R/r) times the angle travelled; the part's own turn comes on top.
  EXPECT_NEAR(found.log.fingers[0].psi.back(), 0.75 * (1 + R / 0.5) + 0.3, 1e-10);
  EXPECT_NEAR(found.log.fingers[1].psi.back(), -0.5 * (1 + R / 0.25) + 0.3, 1e-10);
  EXPECT_NEAR(found.log.fingers[0].u.back() - found.log.fingers[0].u.front(), -0.75 * R / 0.5, 1e-10);
  EXPECT_NEAR(found.log.fingers[1].u.back() - found.log.fingers[1].u.front(), 0.5 * R / 0.25, 1e-10);
  EXPECT_NEAR(found.pose.back().heading, 0.3, 1e-12);
  // Finger a stays at (R + r, 0). The circle's centre is opposite to the way that the contact has gone.
  EXPECT_NEAR(found.log.fingers[0].x.back(), 2.5, 1e-10);
  EXPECT_NEAR(found.log.fingers[0].y.back(), 0, 1e-10);
  EXPECT_NEAR(found.pose.back().x, 2.5 - 2.5 * std::cos(0.75 + 0.3), 1e-10);
  EXPECT_NEAR(found.pose.back().y, -2.5 * std::sin(0.75 + 0.3), 1e-10);
  // Finger b has started on the left and is 0.5 back on the circle.
  EXPECT_NEAR(found.log.fingers[1].x.back(), found.pose.back().x - 2.25 * std::cos(-0.5 + 0.3), 1e-10);
  EXPECT_NEAR(found.log.fingers[1].y.back(), found.pose.back().y - 2.25 * std::sin(-0.5 + 0.3), 1e-10);
}

TEST(FreePart, a_circle_between_two_fingers_that_turn_alike_works_like_gears) {
  // Both disks are at rest in place and turn with omega: the circle turns backwards by r / R.
  const double R = 3;
  FreePlan plan;
  const double omega = 1.5;
  const double omega_part = -omega / R;
  plan.fingers[0] = {{1}, 0, 0, {}, [=](double) { return omega; }};
  plan.fingers[1] = {{1}, kPi * R, 0, {}, [=](double) { return omega; }};
  plan.omega_part = [=](double) { return omega_part; };
  plan.duration = 2;
  const Roll found = roll_free(part_of("circle,r=3"), plan);
  for (std::size_t row = 0; row < found.pose.size(); row += 10) {
    EXPECT_NEAR(found.pose[row].x, 0, 1e-10);
    EXPECT_NEAR(found.pose[row].y, 0, 1e-10);
    EXPECT_NEAR((centre_at(found.log.fingers[1], row) - Vec2(-4, 0)).norm(), 0, 1e-10);
    EXPECT_NEAR(found.log.fingers[0].u[row] + found.log.fingers[0].psi[row], kPi, 1e-10);
  }
}

TEST(FreePart, that_does_not_move_is_a_stationary_part) {
  const Part part = part_of("limacon");
  FreePlan plan = by_distances(0.1, 0.3, 2, 0.2, 4, -1);
  plan.pose = {};
  plan.velocity_part = [](double) { return Vec2(0, 0); };
  const Roll both = roll_free(part, plan);
  for (const bool is_a : {true, false}) {
    RollPlan alone;
    alone.start = is_a ? plan.fingers[0].start : plan.fingers[1].start;
    alone.psi = is_a ? plan.fingers[0].psi : plan.fingers[1].psi;
    alone.distance = is_a ? plan.fingers[0].distance : plan.fingers[1].distance;
    alone.rows = plan.rows;
    const Roll single = roll(part, {is_a ? 0.1 : 0.2}, alone);
    const FingerRows& rows = both.log.fingers[is_a ? 0 : 1];
    const FingerRows& others = single.log.fingers[0];
    for (std::size_t row = 0; row < plan.rows; row += 20) {
      EXPECT_NEAR(rows.u[row], others.u[row], 1e-10);
      EXPECT_NEAR(rows.psi[row], others.psi[row], 1e-10);
      EXPECT_LT((centre_at(rows, row) - centre_at(others, row)).norm(), 1e-10);
    }
  }
}

// --- What rolling is, in the world, by differences of what was recorded.

struct Case {
  const char* shape;
  double ra;
  double rb;
  double near = 1e-6;  // what a derivative by differences is worth
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.shape << " ra=" << one.ra << " rb=" << one.rb; }

class FreePartCases : public testing::TestWithParam<Case> {
 protected:
  Part part_ = part_of(GetParam().shape);
  double ra_ = GetParam().ra;
  double rb_ = GetParam().rb;
  double near_ = GetParam().near;
  double P_ = part_.perimeter();
  FreePlan profiles_ = by_profiles(ra_, 0.15 * P_, rb_, 0.6 * P_, 1, 2001);
};

TEST_P(FreePartCases, the_fingers_touch_the_part_where_they_feel_it) {
  const Roll found = roll_free(part_, profiles_);
  for (std::size_t row = 0; row < found.s[0].size(); row += 50) {
    EXPECT_LT(
        (felt_contact(found.log.fingers[0], ra_, row) - boundary_point(part_, found, found.s[0][row], row)).norm(),
        1e-9);
    EXPECT_LT(
        (felt_contact(found.log.fingers[1], rb_, row) - boundary_point(part_, found, found.s[1][row], row)).norm(),
        1e-9);
  }
}

/// The velocity of a body's point at `place`: of the body's own reference point plus omega times the arm.
Vec2 velocity_at(const Vec2& place, const Vec2& reference, const Vec2& velocity, double omega) {
  const Vec2 arm = place - reference;
  return velocity + omega * Vec2(-arm.y(), arm.x());
}

TEST_P(FreePartCases, nothing_slips_at_either_contact) {
  const Roll found = roll_free(part_, profiles_);
  const double step = found.log.time[1];
  const auto slip = [&](const FingerRows& rows, double radius, std::size_t row) {
    const Vec2 contact = felt_contact(rows, radius, row);
    const auto centre = [&](std::size_t k) -> Vec2 { return centre_at(rows, k); };
    const auto psi = [&](std::size_t k) { return rows.psi[k]; };
    const auto origin = [&](std::size_t k) { return Vec2(found.pose[k].x, found.pose[k].y); };
    const auto heading = [&](std::size_t k) { return found.pose[k].heading; };
    const Vec2 of_finger = velocity_at(contact, centre(row), rate(centre, row, step), rate(psi, row, step));
    const Vec2 of_part = velocity_at(contact, origin(row), rate(origin, row, step), rate(heading, row, step));
    return (of_finger - of_part).norm();
  };
  for (std::size_t row = 7; row + 2 < found.s[0].size(); row += 83) {
    EXPECT_LT(slip(found.log.fingers[0], ra_, row), near_) << "finger a, row " << row;
    EXPECT_LT(slip(found.log.fingers[1], rb_, row), near_) << "finger b, row " << row;
  }
}

TEST_P(FreePartCases, equation_7_holds_along_the_way) {
  const Roll found = roll_free(part_, profiles_);
  const double step = found.log.time[1];
  for (std::size_t row = 11; row + 2 < found.s[0].size(); row += 79) {
    const double time = found.log.time[row];
    const double u_rate = rate([&](std::size_t k) { return found.log.fingers[0].u[k]; }, row, step);
    const double v_rate = rate([&](std::size_t k) { return found.log.fingers[1].u[k]; }, row, step);
    const double s_rate = rate([&](std::size_t k) { return found.s[0][k]; }, row, step);
    const double t_rate = rate([&](std::size_t k) { return found.s[1][k]; }, row, step);
    const double left = u_rate - part_.turning().curvature(found.s[0][row]) * s_rate + profiles_.fingers[0].omega(time);
    const double right =
        v_rate - part_.turning().curvature(found.s[1][row]) * t_rate + profiles_.fingers[1].omega(time);
    EXPECT_NEAR(left, right, near_) << "row " << row;
    EXPECT_NEAR(left, profiles_.omega_part(time), near_) << "row " << row;  // what was eliminated
  }
}

TEST_P(FreePartCases, the_difference_of_the_readings_is_that_of_the_total_curvatures) {
  const Roll found = roll_free(part_, profiles_);
  const TurningFunction& turning = part_.turning();
  for (std::size_t row = 1; row < found.s[0].size(); row += 101) {
    const Reading a = reading_at(found.log.fingers[0], ra_, row);
    const Reading b = reading_at(found.log.fingers[1], rb_, row);
    const double phi_a = turning.angle(found.s[0][0] + a.length[0]) - turning.angle(found.s[0][0]);
    const double phi_b = turning.angle(found.s[1][0] + b.length[0]) - turning.angle(found.s[1][0]);
    EXPECT_NEAR(a.turn - b.turn, phi_a - phi_b, 1e-8) << "row " << row;  // eqs. (8) and (9)
  }
}

TEST_P(FreePartCases, the_facing_of_the_fingers_is_that_of_the_tangents) {
  const Roll found = roll_free(part_, profiles_);
  for (std::size_t row = 0; row < found.s[0].size(); row += 101) {
    const double felt = found.log.fingers[0].u[row] + found.log.fingers[0].psi[row] - found.log.fingers[1].u[row] -
                        found.log.fingers[1].psi[row];
    const double tangents = part_.turning().angle(found.s[0][row]) - part_.turning().angle(found.s[1][row]);
    EXPECT_NEAR(std::remainder(felt - tangents, 2 * kPi), 0, 1e-9) << "row " << row;
  }
}

TEST_P(FreePartCases, integration_and_closed_form_agree) {
  EXPECT_LT(difference(integrated_roll_free(part_, profiles_), roll_free(part_, profiles_)), 1e-9);
  const FreePlan plan = by_distances(ra_, 0.15 * P_, 0.4 * P_, rb_, 0.6 * P_, -0.3 * P_, 1.2);
  EXPECT_LT(difference(integrated_roll_free(part_, plan), roll_free(part_, plan)), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Gallery, FreePartCases,
                         testing::Values(Case{"circle", 0.3, 0.5}, Case{"ellipse", 0.3, 0.3}, Case{"ellipse", 2, 0.2},
                                         Case{"limacon", 0.1, 0.05}, Case{"cam", 0.5, 0.2},
                                         Case{"spline,seed=3", 0.1, 0.06, 1e-3}));

TEST(FreePart, integration_and_closed_form_agree_on_random_splines_and_rolls) {
  std::mt19937_64 generator = test_generator(61);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < test_count(10); ++k) {
    const Part part = part_of("spline,n=12,wobble=0.1,seed=" + std::to_string(generator() % 100000));
    const FreePlan plan =
        by_distances(0.02 + 0.05 * share(generator), share(generator) * part.perimeter(), 4 * share(generator) - 2,
                     0.02 + 0.05 * share(generator), share(generator) * part.perimeter(), 4 * share(generator) - 2,
                     6 * share(generator) - 3);
    EXPECT_LT(difference(integrated_roll_free(part, plan), roll_free(part, plan)), 1e-9)
        << part.name() << " a: r=" << plan.fingers[0].finger.length_per_u() << " s=" << plan.fingers[0].start
        << " L=" << *plan.fingers[0].distance << " b: r=" << plan.fingers[1].finger.length_per_u()
        << " t=" << plan.fingers[1].start << " L=" << *plan.fingers[1].distance;
  }
}

// --- Corners.

TEST(FreePart, both_fingers_pivot_at_convex_corners) {
  const Part square = part_of("polygon,n=4,r=1.4142135623730951");  // sides of length 2
  const FreePlan plan = by_distances(0.5, 1, 2, 0.2, 5.5, -2, 0.4);
  const Roll found = integrated_roll_free(square, plan);
  EXPECT_LT(difference(found, roll_free(square, plan)), 1e-9);
  EXPECT_NEAR(reading_at(found.log.fingers[0], 0.5, 200).length[0], 2, 1e-9);
  EXPECT_NEAR(reading_at(found.log.fingers[0], 0.5, 200).turn, kPi / 2 + 0.4, 1e-9);
  EXPECT_NEAR(reading_at(found.log.fingers[1], 0.2, 200).turn, -kPi / 2 + 0.4, 1e-9);
  std::size_t pivoting = 0;
  for (std::size_t row = 0; row < found.s[0].size(); ++row) {
    EXPECT_LT(
        (felt_contact(found.log.fingers[0], 0.5, row) - boundary_point(square, found, found.s[0][row], row)).norm(),
        1e-9);
    if (std::abs(found.s[0][row] - 2) < 1e-12) ++pivoting;
  }
  EXPECT_GT(pivoting, 10U);
}

// --- How things move along.

TEST(FreePart, finger_a_stays_in_place_unless_told_otherwise) {
  const Roll found = roll_free(part_of("ellipse"), by_profiles(0.3, 1, 0.2, 5));
  for (std::size_t row = 0; row < found.s[0].size(); ++row) {
    EXPECT_LT((centre_at(found.log.fingers[0], row) - centre_at(found.log.fingers[0], 0)).norm(), 1e-14);
  }
  EXPECT_GT((centre_at(found.log.fingers[1], 100) - centre_at(found.log.fingers[1], 0)).norm(), 0.1);
}

TEST(FreePart, finger_a_moves_as_it_is_told) {
  FreePlan plan = by_profiles(0.3, 1, 0.2, 5);
  plan.velocity_a = [](double time) { return Vec2(std::cos(time), 3 * time * time); };
  const Roll found = roll_free(part_of("ellipse"), plan);
  const double time = found.log.time[150];
  const Vec2 moved = centre_at(found.log.fingers[0], 150) - centre_at(found.log.fingers[0], 0);
  EXPECT_LT((moved - Vec2(std::sin(time), time * time * time)).norm(), 1e-12);
}

TEST(FreePart, the_part_moves_as_it_is_told) {
  FreePlan plan = by_profiles(0.3, 1, 0.2, 5);
  plan.velocity_part = [](double time) { return Vec2(std::cos(time), 3 * time * time); };
  const Roll found = roll_free(part_of("ellipse"), plan);
  const double time = found.log.time[150];
  EXPECT_NEAR(found.pose[150].x, 0.4 + std::sin(time), 1e-12);
  EXPECT_NEAR(found.pose[150].y, -0.7 + time * time * time, 1e-12);
  EXPECT_NEAR(found.pose[150].heading, 2.1 + 0.8 * time - time * time / 2, 1e-12);
}

TEST(FreePart, starts_as_the_plan_says) {
  const FreePlan plan = by_profiles(0.3, 1, 0.2, 5);
  const Roll found = roll_free(part_of("ellipse"), plan);
  EXPECT_EQ(found.log.fingers[0].psi[0], 0.3);
  EXPECT_EQ(found.log.fingers[1].psi[0], -1.1);
  EXPECT_EQ(found.pose[0].heading, 2.1);
  EXPECT_NEAR(found.pose[0].x, 0.4, 1e-15);
  EXPECT_NEAR(found.pose[0].y, -0.7, 1e-15);
  EXPECT_EQ(found.s[0][0], 1);
  EXPECT_EQ(found.s[1][0], 5);
}

TEST(FreePart, how_things_move_along_changes_no_reading) {
  const Part part = part_of("limacon");
  FreePlan plan = by_distances(0.1, 0.3, 2, 0.2, 4, -1, 0.7);
  const Roll plain = roll_free(part, plan);
  plan.velocity_part = [](double) { return Vec2(5, -3); };
  const Roll moved = roll_free(part, plan);
  EXPECT_EQ(plain.log.fingers[0].u, moved.log.fingers[0].u);
  EXPECT_EQ(plain.log.fingers[1].psi, moved.log.fingers[1].psi);
  EXPECT_EQ(plain.s, moved.s);
}

TEST(FreePart, distances_may_be_different_and_one_may_be_0) {
  const Part part = part_of("exponential");
  for (const double at : {0.0, 3.0, part.perimeter()}) {
    const Roll found = roll_free(part, by_distances(0.1, 1, 2.5, 0.2, at, 0, 0.5));
    EXPECT_NEAR(found.s[0].back() - found.s[0].front(), 2.5, 1e-9);
    EXPECT_EQ(found.s[1].back(), at);
    EXPECT_EQ(found.log.fingers[1].u.back(), found.log.fingers[1].u.front());
    EXPECT_NEAR(found.log.fingers[1].psi.back() - found.log.fingers[1].psi.front(), 0.5,
                1e-12);  // it goes with the part
  }
}

TEST(FreePart, a_duration_stretches_the_times_and_nothing_else) {
  const Part part = part_of("limacon");
  FreePlan plan = by_distances(0.1, 0.3, 2, 0.2, 4, -1, 0.7);
  const Roll plain = roll_free(part, plan);
  plan.duration = 10;
  const Roll timed = roll_free(part, plan);
  EXPECT_EQ(timed.log.time.back(), 10);
  EXPECT_NEAR(timed.s[0][100], plain.s[0][100], 1e-12);
  EXPECT_NEAR(timed.pose[100].heading, plain.pose[100].heading, 1e-12);
  // Without one the faster finger, which is a, turns at 1 rad/s against the part.
  EXPECT_NEAR(plain.log.time.back(), std::abs(plain.log.fingers[0].psi.back() - plain.log.fingers[0].psi.front() - 0.7),
              1e-12);
}

// --- Where a finger can't go, and plans that make no sense.

TEST(FreePart, a_disk_too_big_for_a_concavity_is_named_with_the_place) {
  const Part part = part_of("limacon,a=1.2,b=1");
  const double P = part.perimeter();
  const auto refusal = [&](double ra, double rb) {
    return refusal_of([&] { roll_free(part, by_distances(ra, 0, P, rb, 0.1, P)); });
  };
  EXPECT_THAT(refusal(0.2, 0.01),
              AllOf(StartsWith("finger a: "), HasSubstr("too big"), HasSubstr("radius below 0.05")));
  EXPECT_THAT(refusal(0.01, 0.2), AllOf(StartsWith("finger b: "), HasSubstr("too big"), HasSubstr("(-0.2, ")));
  FreePlan turning = by_profiles(0.01, 0, 0.2, P / 2 - 1);
  turning.fingers[1].omega = [](double) { return 200.0; };
  EXPECT_THAT(refusal_of([&] { roll_free(part, turning); }), AllOf(StartsWith("finger b: "), HasSubstr("too big")));
}

TEST(FreePart, a_concave_corner_is_named_with_the_place) {
  const Part part(outline_through({{0, 0}, {4, 0}, {4, 3}, {2, 1}, {0, 3}}, "notched", {}));
  EXPECT_THAT(refusal_of([&] { roll_free(part, by_distances(0.1, 1, 1, 0.1, 8, 4)); }),
              AllOf(StartsWith("finger b: "), HasSubstr("concave corner at s = 9.8284"), HasSubstr("(2, 1)")));
}

TEST(FreePart, running_off_an_open_end_is_refused) {
  const Part part = part_of("exponential");
  EXPECT_THAT(refusal_of([&] { roll_free(part, by_distances(0.1, 9, 5, 0.1, 1, 1)); }),
              AllOf(StartsWith("finger a: "), HasSubstr("runs off the end")));
}

TEST(FreePart, plans_that_make_no_sense_are_refused) {
  const Part part = part_of("ellipse");
  const auto refusal = [&](const FreePlan& plan) { return refusal_of([&] { roll_free(part, plan); }); };
  const FreePlan distances = by_distances(0.1, 0, 1, 0.1, 2, 1);
  const FreePlan profiles = by_profiles(0.1, 0, 0.1, 2);
  EXPECT_THAT(refusal({}), HasSubstr("found 0 distances and 0 angular velocities"));
  FreePlan mixed = distances;
  mixed.fingers[1] = profiles.fingers[1];
  EXPECT_THAT(refusal(mixed), HasSubstr("found 1 distances and 1 angular velocities"));
  FreePlan still = by_distances(0.1, 0, 0, 0.1, 2, 0);
  EXPECT_THAT(refusal(still), HasSubstr("distance other than 0"));
  FreePlan endless = profiles;
  endless.duration.reset();
  EXPECT_THAT(refusal(endless), HasSubstr("expected a duration"));
  endless.duration = -1;
  EXPECT_THAT(refusal(endless), HasSubstr("duration of a roll above 0, found -1"));
  FreePlan torn = distances;
  torn.velocity_a = torn.velocity_part = [](double) { return Vec2(0, 0); };
  EXPECT_THAT(refusal(torn), HasSubstr("found both"));
  FreePlan turned = profiles;
  turned.part_rotation = 1;
  EXPECT_THAT(refusal(turned), HasSubstr("a rotation, which goes with distances"));
  FreePlan spun = distances;
  spun.omega_part = [](double) { return 1.0; };
  EXPECT_THAT(refusal(spun), HasSubstr("expected the part's rotation"));
  FreePlan slow = distances;
  slow.speed = 0;
  EXPECT_THAT(refusal(slow), HasSubstr("speed of a roll above 0"));
  FreePlan lost = distances;
  lost.pose.heading = NAN;
  EXPECT_THAT(refusal(lost), HasSubstr("finite pose"));
  FreePlan dizzy = distances;
  dizzy.part_rotation = INFINITY;
  EXPECT_THAT(refusal(dizzy), HasSubstr("finite rotation"));
  FreePlan thin = distances;
  thin.fingers[1].finger = 0.0;
  EXPECT_THAT(refusal(thin), AllOf(StartsWith("finger b: "), HasSubstr("radius")));
  FreePlan brief = distances;
  brief.rows = 1;
  EXPECT_THAT(refusal(brief), HasSubstr("at least 2 rows"));
}

TEST(FreePart, too_few_rows_to_tell_wrapped_angles_apart_are_refused) {
  FreePlan plan = by_distances(0.5, 0, 1.6, 0.5, 2, 0.1);
  plan.rows = 2;
  EXPECT_THAT(refusal_of([&] { roll_free(part_of("circle"), plan); }),
              AllOf(StartsWith("finger a: "), HasSubstr("take more rows")));
}

}  // namespace
}  // namespace rollfix::free_part_test
