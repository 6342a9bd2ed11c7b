// Two fingers' logs: from rows to readings, and which rows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "free_roll.hpp"
#include "random.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/log.hpp"

namespace rollfix::pair_log_readings_test {
namespace {

using free_rolls::by_distances;
using free_rolls::by_profiles;
using free_rolls::part_of;
using testing::DoubleNear;
using testing::ElementsAre;
constexpr double kPi = std::numbers::pi;

Log pair_of(const std::string& text) { return parse_log(text, "both.csv"); }
Log pair_of(const std::string& a, const std::string& b) { return paired(parse_log(a, "a.csv"), parse_log(b, "b.csv")); }

TEST(PairLogReadings, lengths_and_turn_follow_from_both_fingers) {
  const Log log = pair_of("time,u_a,psi_a,u_b,psi_b\n0,1,0.5,2,0.25\n1,0.5,2.5,2.75,-1.25\n");
  const std::vector<Reading> all = readings_as_given(log, {DiskFinger{2}, {DiskFinger{4}}});
  EXPECT_EQ(all[0].turn, 0);
  EXPECT_DOUBLE_EQ(all[1].length[0], 1);                     // -2 (0.5 - 1)
  EXPECT_DOUBLE_EQ(all[1].length[1], -3);                    // -4 (2.75 - 2)
  EXPECT_DOUBLE_EQ(all[1].turn, (-0.5 + 2) - (0.75 - 1.5));  // of a less that of b
  EXPECT_NEAR(*facing(log), 1.5 - 2.25, 1e-15);
}

TEST(PairLogReadings, columns_may_stand_in_any_order_among_others) {
  const Log log =
      pair_of("x_b,psi_b,force_a,u_a,y_b,time,u_b,psi_a,x_a,y_a\n8,4,99,1,9,0,3,2,6,7\n8,4,99,1,9,1,3,2,6,7\n");
  EXPECT_EQ(log.fingers[0].u[0], 1);
  EXPECT_EQ(log.fingers[0].psi[0], 2);
  EXPECT_EQ(log.fingers[1].u[0], 3);
  EXPECT_EQ(log.fingers[1].psi[0], 4);
  EXPECT_THAT(log.time, ElementsAre(0, 1));
  EXPECT_EQ(log.fingers[0].x[0], 6);
  EXPECT_EQ(log.fingers[1].y[1], 9);
}

TEST(PairLogReadings, two_files_say_the_same_as_one) {
  const Log one = pair_of("time,u_a,psi_a,u_b,psi_b\n0,1,0.5,2,0.25\n1,0.5,2.5,2.75,-1.25\n");
  const Log two = pair_of("time,u,psi\n0,1,0.5\n1,0.5,2.5\n", "psi;time;u\n0.25;0;2\n-1.25;1;2.75\n");
  const std::vector<Finger> fingers{DiskFinger{2}, DiskFinger{4}};
  EXPECT_EQ(readings_as_given(one, fingers)[1].turn, readings_as_given(two, fingers)[1].turn);
  EXPECT_EQ(readings_as_given(one, fingers)[1].length[1], readings_as_given(two, fingers)[1].length[1]);
  EXPECT_EQ(facing(one), facing(two));
}

TEST(PairLogReadings, angles_as_read_may_be_wrapped_each_in_its_own_way) {
  const Part part = part_of("limacon");
  const FreePlan plan = by_distances(0.1, 0.3, 3, 0.05, 4, -2, 1);
  const Roll roll = roll_free(part, plan);
  Log wrapped = roll.log;
  for (double& u : wrapped.fingers[0].u) u = std::remainder(u, 2 * kPi);
  for (double& psi : wrapped.fingers[1].psi)
    psi = std::remainder(psi, 2 * kPi) + kPi;  // a reader can't know this constant
  const std::vector<Finger> fingers{plan.fingers[0].finger, plan.fingers[1].finger};
  const std::vector<Reading> expected = readings(roll.log, part, fingers);
  const std::vector<Reading> found = readings(wrapped, part, fingers);
  ASSERT_EQ(found.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(found[k].length[0], expected[k].length[0], 1e-12);
    EXPECT_NEAR(found[k].length[1], expected[k].length[1], 1e-12);
    EXPECT_NEAR(found[k].turn, expected[k].turn, 1e-12);
  }
  wrapped.fingers[1].psi = roll.log.fingers[1].psi;
  EXPECT_NEAR(std::remainder(*facing(wrapped) - *facing(roll.log), 2 * kPi), 0, 1e-12);
  EXPECT_LE(std::abs(*facing(wrapped)), kPi);
}

TEST(PairLogReadings, of_a_roll_are_the_total_curvatures_of_the_part) {
  std::mt19937_64 generator = test_generator(71);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < test_count(10); ++k) {
    const Part part = part_of("spline,n=12,wobble=0.1,seed=" + std::to_string(generator() % 100000));
    const double s = share(generator) * part.perimeter();
    const double t = share(generator) * part.perimeter();
    const double La = 4 * share(generator) - 2;
    const double Lb = 4 * share(generator) - 2;
    const FreePlan plan = by_distances(0.05, s, La, 0.03, t, Lb, share(generator));
    const Roll roll = roll_free(part, plan);
    const Reading last = readings(roll.log, part, {plan.fingers[0].finger, plan.fingers[1].finger}).back();
    const auto angle = [&](double at) { return part.turning().angle(at); };
    EXPECT_NEAR(last.length[0], La, 1e-11);
    EXPECT_NEAR(last.length[1], Lb, 1e-11);
    EXPECT_NEAR(last.turn, (angle(s + La) - angle(s)) - (angle(t + Lb) - angle(t)), 1e-9)  // eq. (8)
        << part.name() << " s=" << s << " La=" << La << " t=" << t << " Lb=" << Lb;
    EXPECT_NEAR(std::remainder(*facing(roll.log) - (angle(s) - angle(t)), 2 * kPi), 0, 1e-9) << part.name();
  }
}

TEST(PairLogReadings, of_lengths_and_turns_have_no_facing) {
  const Log log = pair_of("time,length,turn\n1,0.5,0.75\n2,1,2\n", "time,length,turn\n1,-1,0.5\n2,-3,73deg\n");
  const std::vector<Reading> all = readings_as_given(log, {});
  EXPECT_EQ(all[1].length[0], 1);
  EXPECT_EQ(all[1].length[1], -3);
  EXPECT_DOUBLE_EQ(all[1].turn, 2 - 73 * kPi / 180);
  EXPECT_EQ(facing(log), std::nullopt);
  EXPECT_EQ(facing(pair_of("0.1,0.2\n0.1,0.3\n", "0.1,0.2\n0.1,0.3\n")), std::nullopt);
}

TEST(PairLogReadings, lengths_and_turns_may_stand_in_one_file) {
  const Log log = pair_of("length_a,turn_a,length_b,turn_b\n1,2,3,4\n");
  EXPECT_EQ(readings_as_given(log, {})[0].length[1], 3);
  EXPECT_EQ(readings_as_given(log, {})[0].turn, -2);
}

TEST(PairLogReadings, of_increments_are_sums) {
  const Log log = pair_of("0.5,1\n0.25,2\n", "1,0.5\n-2,0.25\n");
  EXPECT_EQ(readings_as_given(log, {})[1].length[0], 0.75);
  EXPECT_EQ(readings_as_given(log, {})[1].length[1], -1);
  EXPECT_EQ(readings_as_given(log, {})[1].turn, 3 - 0.75);
}

TEST(PairLogReadings, follow_a_reversed_outline_where_they_were_measured_along_it) {
  Outline clockwise{"clockwise", {}, true};
  clockwise.curves = {Line({0, 0}, {0, 3}), Line({0, 3}, {4, 0}), Line({4, 0}, {0, 0})};
  const Part part(clockwise);
  ASSERT_TRUE(part.reversed());
  const std::vector<Reading> travelled = readings(pair_of("length,turn\n1,2\n", "length,turn\n-3,0.5\n"), part, {});
  EXPECT_EQ(travelled[0].length[0], -1);
  EXPECT_EQ(travelled[0].length[1], 3);
  EXPECT_EQ(travelled[0].turn, 1.5);
  const Log felt = pair_of("u_a,psi_a,u_b,psi_b\n0,0,0,0\n-1,0,2,0\n");
  EXPECT_EQ(readings(felt, part, {DiskFinger{1}, DiskFinger{1}})[0].length[0], 1);
}

// --- Which rows.

TEST(PairLogReadings, the_middle_row_and_the_last_are_used_by_default) {
  const auto rows_of = [](std::size_t count, LogKind kind) {
    Log log;
    log.kind = kind;
    log.fingers.resize(2);
    for (FingerRows& rows : log.fingers) rows.u = rows.psi = rows.length = rows.turn = std::vector<double>(count);
    return rows_at(log, {});
  };
  EXPECT_THAT(rows_of(101, LogKind::contact), ElementsAre(50, 100));
  EXPECT_THAT(rows_of(4, LogKind::contact), ElementsAre(1, 3));
  EXPECT_THAT(rows_of(3, LogKind::contact), ElementsAre(1, 2));
  EXPECT_THAT(rows_of(2, LogKind::contact), ElementsAre(1));  // row 0 is the first contact
  EXPECT_THAT(rows_of(2, LogKind::travelled), ElementsAre(0, 1));
  EXPECT_THAT(rows_of(1, LogKind::increments), ElementsAre(0));
}

TEST(PairLogReadings, other_instants_are_chosen_by_time) {
  const Roll roll = roll_free(part_of("ellipse"), by_profiles(0.3, 1, 0.2, 5));
  EXPECT_THAT(rows_at(roll.log, {0.25, 0.7501, 1}), ElementsAre(50, 150, 200));
}

TEST(PairLogReadings, only_rows_in_which_both_fingers_touch_count) {
  const Log log = pair_of(
      "time,u_a,psi_a,contact_a,u_b,psi_b,contact_b\n"
      "0,,,0,,,0\n1,7,7,1,,,0\n2,1,0,1,2,0,1\n3,2,0,1,4,0,1\n4,5,5,0,6,6,1\n");
  EXPECT_THAT(log.time, ElementsAre(2, 3));
  EXPECT_THAT(log.fingers[0].u, ElementsAre(1, 2));
  EXPECT_THAT(log.fingers[1].u, ElementsAre(2, 4));
}

TEST(PairLogReadings, one_contact_column_may_speak_for_both) {
  const Log log = pair_of("u_a,psi_a,u_b,psi_b,contact\nx,x,x,x,0\n1,0,2,0,1\n2,0,4,0,1\n");
  EXPECT_THAT(log.fingers[1].u, ElementsAre(2, 4));
}

TEST(PairLogReadings, of_two_files_only_the_time_of_common_contact_counts) {
  const Log log = pair_of("time,u,psi,contact\n0,0,0,1\n1,1,0,1\n2,2,0,1\n3,3,0,0\n",
                          "time,u,psi,contact\n0,0,0,0\n1,5,0,1\n2,6,0,1\n3,7,0,1\n");
  EXPECT_THAT(log.time, ElementsAre(1, 2));
  EXPECT_THAT(log.fingers[0].u, ElementsAre(1, 2));
  EXPECT_THAT(log.fingers[1].u, ElementsAre(5, 6));
  EXPECT_THAT(log.fingers[1].line, ElementsAre(3, 4));
}

TEST(PairLogReadings, clocks_may_differ_by_rounding) {
  const Log log = pair_of("time,u,psi\n0,0,0\n0.1,1,0\n", "time,u,psi\n0,0,0\n0.10000000000000001,1,0\n");
  EXPECT_EQ(log.rows(), 2U);
}

// --- Digits.

TEST(PairLogReadings, are_rounded_like_the_digits_of_both) {
  const Log log = pair_of("u_a,psi_a,u_b,psi_b\n1.25,0.5,2.125,0.5\n1.20,0.7,2.225,0.7\n");
  const Rounding rounding = rounding_of(log, {DiskFinger{2}, DiskFinger{10}});
  EXPECT_NEAR(rounding.length, 2 * 2 * 0.005 + 2 * 10 * 0.0005, 1e-15);
  EXPECT_NEAR(rounding.turn, 2 * (0.005 + 0.05) + 2 * (0.0005 + 0.05), 1e-15);
}

TEST(PairLogReadings, rounding_bounds_what_written_digits_can_do) {
  const Part part = part_of("limacon");
  const FreePlan plan = by_distances(0.1, 0.3, 3, 0.05, 4, -2, 1);
  const Roll roll = roll_free(part, plan);
  const std::vector<Finger> fingers{plan.fingers[0].finger, plan.fingers[1].finger};
  Log rounded = roll.log;
  for (FingerRows& rows : rounded.fingers) {
    for (double& u : rows.u) u = std::round(u * 1e3) / 1e3;
    for (double& psi : rows.psi) psi = std::round(psi * 1e2) / 1e2;
    rows.place_rounding = 5e-4;
    rows.angle_rounding = 5e-3;
  }
  const Rounding bound = rounding_of(rounded, fingers);
  const std::vector<Reading> exact = readings_as_given(roll.log, fingers);
  const std::vector<Reading> found = readings_as_given(rounded, fingers);
  double most = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    most = std::max(most, std::abs(found[k].turn - exact[k].turn));
    EXPECT_LE(std::abs(found[k].length[0] - exact[k].length[0]) + std::abs(found[k].length[1] - exact[k].length[1]),
              bound.length + 1e-12);
  }
  EXPECT_LE(most, bound.turn + 1e-12);
  EXPECT_GT(most, bound.turn / 10);  // it is not a bound for its own sake
}

}  // namespace
}  // namespace rollfix::pair_log_readings_test
