// Parts taught by rolling around them.
#include "rollfix/teach.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "outline/turn.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"
#include "shapes.hpp"

namespace teach_test {
namespace {

using rollfix::Closing;
using rollfix::Log;
using rollfix::LogKind;
using rollfix::Noise;
using rollfix::parse_log;
using rollfix::Part;
using rollfix::Taught;
using rollfix::teach;
using rollfix::TeachOptions;
using rollfix::Vec2;
using shapes::kPi;
using testing::HasSubstr;

/// What an odometer and a gyroscope say of a drive along a part, from s, over this length, in equal steps.
Log drive(const Part& part, double from, double length, int steps) {
  Log log;
  log.name = "drive.csv";
  log.kind = LogKind::travelled;
  for (int k = 1; k <= steps; ++k) {
    const double travelled = length * k / steps;
    log.fingers[0].length.push_back(travelled);
    log.fingers[0].turn.push_back(part.turning().angle(from + travelled) - part.turning().angle(from));
  }
  return log;
}

Log lap(const Part& part, int steps) { return drive(part, 0, part.perimeter(), steps); }

/// A finger's log of a roll from s, simulated.
Log finger_log(const Part& part, double radius, double from, double length, std::size_t rows) {
  rollfix::RollPlan plan;
  plan.start = from;
  plan.distance = length;
  plan.rows = rows;
  return rollfix::roll(part, {radius}, plan).log;
}

TeachOptions with_finger(double radius) {
  TeachOptions options;
  options.finger = rollfix::disk(radius);
  return options;
}

TeachOptions with_noise(const Noise& noise) {
  TeachOptions options;
  options.noise = noise;
  return options;
}

Part shape(const std::string& name) { return Part(rollfix::gallery(name)); }

/// The largest distance between equal arc lengths of two parts, the second moved so that its start lies on the first's.
double difference(const Part& truth, const Part& taught, double from = 0) {
  const double turn = truth.tangent(from) - taught.tangent(0);
  const Vec2 along(std::cos(turn), std::sin(turn));
  double worst = 0;
  for (int k = 0; k < 500; ++k) {
    const double share = k / 500.0;
    const Vec2 moved = taught.point(share * taught.perimeter()) - taught.point(0);
    const Vec2 there = truth.point(from) + Vec2(along.x() * moved.x() - along.y() * moved.y(),
                                                along.y() * moved.x() + along.x() * moved.y());
    worst = std::max(worst, (there - truth.point(from + share * truth.perimeter())).norm());
  }
  return worst;
}

std::string message_of(const Log& log, const TeachOptions& options = {}) {
  try {
    teach(log, options);
  } catch (const rollfix::InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string all_notes(const Taught& taught) {
  std::string text;
  for (const std::string& note : taught.notes) text += note + "\n";
  return text;
}

// ---- Exact logs.

class TeachSmooth : public testing::TestWithParam<std::string> {};

TEST_P(TeachSmooth, exact_lap_gives_the_shape_back) {
  const Part truth = shape(GetParam());
  const Taught taught = teach(lap(truth, 800));
  EXPECT_EQ(taught.closing, Closing::spread) << all_notes(taught);
  EXPECT_EQ(taught.turns, 1);
  const Part part(taught.outline);
  EXPECT_NEAR(part.perimeter(), truth.perimeter(), 1e-12 * truth.perimeter());
  EXPECT_LT(difference(truth, part), 2e-6 * truth.perimeter());
}

TEST_P(TeachSmooth, error_falls_with_a_high_power_of_the_rows_distance) {
  const Part truth = shape(GetParam());
  const double coarse = difference(truth, Part(teach(lap(truth, 200)).outline));
  const double fine = difference(truth, Part(teach(lap(truth, 400)).outline));
  // The fourth where the shape is analytic, the third where its curvature has a kink (the spline's knots).
  EXPECT_LT(fine, coarse / (GetParam() == "spline,seed=3" ? 6 : 12)) << coarse << " " << fine;
}

INSTANTIATE_TEST_SUITE_P(Gallery, TeachSmooth, testing::Values("ellipse", "limacon", "cam", "spline,seed=3"),
                         shapes::as_identifier);

TEST(TeachFinger, roll_around_an_ellipse_gives_it_back_where_it_is) {
  const Part truth = shape("ellipse,a=2,b=1");
  const Taught taught = teach(finger_log(truth, 0.2, 1, truth.perimeter(), 600), with_finger(0.2));
  const Part part(taught.outline);
  EXPECT_FALSE(part.reversed());
  for (const double s : {0.0, 2.0, 5.0}) EXPECT_LT((part.point(s) - truth.point(1 + s)).norm(), 1e-5);
}

TEST(TeachFinger, roll_that_runs_clockwise_around_gives_the_same_part) {
  const Part truth = shape("limacon");
  const Taught taught = teach(finger_log(truth, 0.2, 1, -truth.perimeter(), 800), with_finger(0.2));
  const Part part(taught.outline);
  EXPECT_EQ(taught.turns, 1);
  EXPECT_FALSE(part.reversed());
  for (const double s : {0.0, 2.0, 5.0}) EXPECT_LT((part.point(s) - truth.point(1 + s)).norm(), 1e-4);
}

TEST(TeachFinger, roll_inside_a_hole_gives_a_hole) {
  rollfix::Outline outline{"hole", {rollfix::Arc({0, 0}, 2, 0, 2 * kPi)}, true};
  outline.hole = true;
  const Part truth(outline);
  const Taught taught = teach(finger_log(truth, 0.3, 0, truth.perimeter(), 400), with_finger(0.3));
  EXPECT_EQ(taught.turns, -1);
  EXPECT_TRUE(taught.outline.hole);
  const Part part(taught.outline);
  EXPECT_FALSE(part.reversed());
  EXPECT_NEAR(part.total_turn(), -2 * kPi, 1e-9);
  for (const double s : {0.0, 1.0, 7.0}) EXPECT_LT((part.point(s) - truth.point(s)).norm(), 1e-6);
}

TEST(TeachFinger, pivots_become_corners) {
  const Part truth = shapes::unit_square();
  for (const std::size_t rows : {60U, 200U, 1000U}) {
    const Taught taught = teach(finger_log(truth, 0.1, 0.4, 4, rows), with_finger(0.1));
    EXPECT_EQ(taught.closing, Closing::spread) << all_notes(taught);
    const Part part(taught.outline);
    ASSERT_EQ(part.corners().size(), 4U) << rows;
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(part.corners()[k].turn, kPi / 2, 1e-6);
      EXPECT_NEAR(part.corners()[k].s, 0.6 + static_cast<double>(k), rows == 60 ? 0.1 : 1e-6);
    }
  }
}

TEST(TeachFinger, reuleaux_triangle_and_stadium_keep_corners_and_arcs) {
  const Part reuleaux = shape("reuleaux");
  const Part from_reuleaux(teach(finger_log(reuleaux, 0.1, 0.3, reuleaux.perimeter(), 800), with_finger(0.1)).outline);
  ASSERT_EQ(from_reuleaux.corners().size(), reuleaux.corners().size());
  for (const rollfix::Corner& corner : from_reuleaux.corners())
    EXPECT_NEAR(corner.turn, reuleaux.corners()[0].turn, 1e-5);
  EXPECT_TRUE(from_reuleaux.inflections().empty());

  const Part stadium = shape("stadium");
  const Part from_stadium(teach(finger_log(stadium, 0.1, 0.3, stadium.perimeter(), 800), with_finger(0.1)).outline);
  EXPECT_TRUE(from_stadium.corners().empty());
  EXPECT_LT(difference(stadium, from_stadium, 0.3), 1e-3 * stadium.perimeter());
  EXPECT_GE(from_stadium.turning().at(0.05).curvature, -1e-9);
}

TEST(Teach, later_roll_is_located_on_the_taught_part) {
  const Part truth = shape("cam");
  const Part part(teach(lap(truth, 1000)).outline);
  const rollfix::Reading reading = shapes::reading_from(truth, 1.7, 0.9);
  rollfix::LocateOptions options;
  options.tolerance = 1e-4;
  EXPECT_TRUE(shapes::holds(part, rollfix::locate(part, {reading}, options), 1.7, 1e-3));
}

// ---- Direction.

TEST(Teach, clockwise_course_keeps_its_direction) {
  const Part forward = shape("cam");
  const double whole = forward.perimeter();
  Log log = lap(forward, 1000);
  std::vector<double> length;
  std::vector<double> turn;
  for (std::size_t k = 0; k < 1000; ++k) {  // the same course driven the other way
    const double s = whole - whole * static_cast<double>(k + 1) / 1000;
    length.push_back(whole - s);
    turn.push_back(forward.turning().angle(s) - forward.turning().angle(whole));
  }
  log.fingers[0].length = length;
  log.fingers[0].turn = turn;
  const Taught taught = teach(log);
  EXPECT_EQ(taught.turns, -1);
  EXPECT_THAT(all_notes(taught), HasSubstr("clockwise"));
  const Part part(taught.outline);
  EXPECT_TRUE(part.reversed());

  // A later drive along 0.9 of it, 1.2 after its start: it is driven like the course, so its lengths are above 0.
  Log later = log;
  later.fingers[0].length = {0.9};
  later.fingers[0].turn = {forward.turning().angle(whole - 2.1) - forward.turning().angle(whole - 1.2)};
  rollfix::LocateOptions options;
  options.tolerance = 1e-4;
  const rollfix::Search found = rollfix::locate(part, rollfix::readings(later, part, {}), options);
  // Reversed with the same first point: the stored s of the course's place 1.2 is P - 1.2.
  EXPECT_TRUE(shapes::holds(part, found, part.perimeter() - 1.2, 1e-3));
}

TEST(Teach, course_that_crosses_itself_needs_leave_and_has_no_turn) {
  const auto eight = [](double u) -> Vec2 { return {std::sin(u), 0.5 * std::sin(2 * u)}; };
  std::vector<Vec2> points;
  for (int k = 0; k < 400; ++k) points.push_back(eight(2 * kPi * k / 400));
  rollfix::Outline outline{"eight", rollfix::spline_through(points, true), true};
  const Part truth(outline, {true});
  const Taught taught = teach(lap(truth, 2000));
  EXPECT_EQ(taught.closing, Closing::spread) << all_notes(taught);
  EXPECT_EQ(taught.turns, 0);
  EXPECT_THROW(Part(taught.outline), rollfix::InputError);
  EXPECT_LT(std::abs(Part(taught.outline, {true}).perimeter() - truth.perimeter()), 1e-9);
}

// ---- Drift.

Log drifted(Log log, double bias, double slip, double noise) {
  auto generator = test_generator();
  std::normal_distribution<double> error(0, 1);
  const double whole = log.fingers[0].length.back();
  for (std::size_t k = 0; k < log.fingers[0].length.size(); ++k) {
    const double share = log.fingers[0].length[k] / whole;
    log.fingers[0].turn[k] += bias * share + noise * error(generator);
    log.fingers[0].length[k] += slip * whole * std::sin(kPi * share) * std::sin(kPi * share);
  }
  return log;
}

TEST(Teach, drift_within_the_noise_is_spread_and_the_shape_found) {
  const Part truth = shape("limacon");
  const Log log = drifted(lap(truth, 1500), 0.02, 0.002, 0);
  EXPECT_EQ(teach(log).closing, Closing::kept_open);
  const Taught taught = teach(log, with_noise({0, 0.01, 0.002, 0}));
  EXPECT_EQ(taught.closing, Closing::spread) << all_notes(taught);
  EXPECT_NEAR(taught.turn_gap, 0.02, 2e-3);
  const Part part(taught.outline);
  EXPECT_NEAR(part.total_turn(), 2 * kPi, 1e-9);
  EXPECT_LT(difference(truth, part), 0.02 * truth.perimeter());
  const rollfix::Reading reading = shapes::reading_from(truth, 2, 1.5);
  rollfix::LocateOptions options;
  options.tolerance = 0.03;
  EXPECT_TRUE(shapes::holds(part, rollfix::locate(part, {reading}, options), 2, 0.05));
}

TEST(Teach, noise_of_every_row_does_not_become_bends) {
  const Part truth = shape("ellipse,a=2,b=1");
  const Taught taught = teach(drifted(lap(truth, 1500), 0, 0, 0.005), with_noise({0, 0.005, 0.001, 0}));
  const Part part(taught.outline);
  EXPECT_EQ(taught.closing, Closing::spread) << all_notes(taught);
  EXPECT_TRUE(part.inflections().empty());
  EXPECT_LT(part.turning().spirals().size(), 60U);
  EXPECT_LT(taught.deviation, 4.6 * 0.005);
}

TEST(Teach, noise_of_contacts_does_not_become_corners) {
  const Part ellipse = shape("ellipse");
  const Noise noise{.contact = 0.012, .angle = 0.005};
  for (int k = 0; k < test_count(4); ++k) {
    rollfix::RollPlan plan;
    plan.distance = 14;
    plan.rows = 1000;
    const rollfix::NoisyRoll roll =
        rollfix::noisy_roll(ellipse, rollfix::disk(0.6), plan, noise, static_cast<std::uint64_t>(k));
    rollfix::TeachOptions options;
    options.finger = rollfix::disk(0.6);
    options.noise = noise;
    const Taught taught = teach(roll.log, options);
    const Part part(taught.outline);
    EXPECT_TRUE(part.corners().empty()) << k;
    EXPECT_NEAR(part.perimeter() / ellipse.perimeter(), 1, 0.005) << k;
  }
}

TEST(Teach, gap_beyond_the_drift_is_never_spread) {
  const Part truth = shape("ellipse,a=2,b=1");
  const Log log = drive(truth, 0, 0.9 * truth.perimeter(), 600);
  const Taught open = teach(log, with_noise({0, 0.001, 0.001, 0}));
  EXPECT_EQ(open.closing, Closing::kept_open);
  EXPECT_FALSE(open.outline.closed);
  EXPECT_THAT(all_notes(open), HasSubstr("`bridge`"));
  const Part part(open.outline);
  EXPECT_NEAR(part.total_turn(), log.fingers[0].turn.back(), 0.01);
}

TEST(Teach, a_bridge_that_is_asked_for_is_built_even_where_drift_would_explain_the_gap) {
  const Part truth = shape("cam");
  TeachOptions options;
  options.bridge = true;
  options.noise = Noise{0.001, 0.002, 0.2, 0};  // a fifth of the lap may be slip
  const Taught taught = teach(drive(truth, 0.5, 0.9 * truth.perimeter(), 600), options);
  EXPECT_EQ(taught.closing, Closing::bridged);
  EXPECT_GT(taught.gap_allowed, taught.gap);
  EXPECT_NEAR(taught.bridge, 0.1 * truth.perimeter(), 0.03 * truth.perimeter());
}

TEST(Teach, a_roll_beyond_its_start_has_no_gap_to_bridge) {
  TeachOptions options;
  options.bridge = true;
  const Log beyond = drive(shape("cam"), 0.5, 1.1 * shape("cam").perimeter(), 600);
  EXPECT_THAT(refusal_of([&] { teach(beyond, options); }), HasSubstr("comes back"));
}

TEST(Teach, gap_is_bridged_where_asked_for) {
  const Part truth = shape("ellipse,a=2,b=1");
  TeachOptions options;
  options.bridge = true;
  const Taught taught = teach(drive(truth, 0, 0.9 * truth.perimeter(), 600), options);
  EXPECT_EQ(taught.closing, Closing::bridged);
  EXPECT_NEAR(taught.bridge, 0.1 * truth.perimeter(), 0.02 * truth.perimeter());
  const Part part(taught.outline);
  EXPECT_TRUE(part.closed());
  EXPECT_NEAR(part.total_turn(), 2 * kPi, 1e-9);
  EXPECT_NEAR(part.perimeter(), 0.9 * truth.perimeter() + taught.bridge, 1e-4);
  EXPECT_LT((part.point(3) - part.point(0)).norm() - (truth.point(3) - truth.point(0)).norm(), 1e-6);
}

TEST(Teach, lap_ends_where_the_roll_is_back_and_the_rest_is_left_out) {
  const Part truth = shape("cam");
  for (const double laps : {1.02, 1.4, 2.0, 2.7}) {
    const Taught taught = teach(drive(truth, 0.5, laps * truth.perimeter(), 3001));
    EXPECT_EQ(taught.closing, Closing::spread) << all_notes(taught);
    EXPECT_NEAR(taught.lap, truth.perimeter(), 1e-6);
    EXPECT_NEAR(taught.overlap, (laps - 1) * truth.perimeter(), 1e-6);
    EXPECT_LT(difference(truth, Part(taught.outline), 0.5), 1e-5 * truth.perimeter());
  }
}

TEST(Teach, open_curve_stays_open_when_said_so) {
  const Part truth = shape("log-spiral");
  TeachOptions options;
  options.open = true;
  const Taught taught = teach(drive(truth, 0, truth.perimeter(), 500), options);
  EXPECT_EQ(taught.closing, Closing::not_asked);
  const Part part(taught.outline);
  EXPECT_FALSE(part.closed());
  EXPECT_NEAR(part.total_turn(), truth.total_turn(), 1e-6);
}

TEST(Teach, written_digits_say_how_much_drift_there_is) {
  const Part truth = shape("ellipse,a=2,b=1");
  std::string text = "distance,dturn\n";
  double last_s = 0;
  double last_turn = truth.turning().angle(0);
  for (int k = 1; k <= 400; ++k) {
    const double s = truth.perimeter() * k / 400;
    text += fmt::format("{:.6f},{:.6f}\n", s - last_s, truth.turning().angle(s) - last_turn);
    last_s = s;
    last_turn = truth.turning().angle(s);
  }
  const Taught taught = teach(parse_log(text, "lap.csv"));
  EXPECT_EQ(taught.closing, Closing::spread) << all_notes(taught);
  EXPECT_LT(difference(truth, Part(taught.outline)), 1e-3);
}

// ---- Silly logs.

TEST(BadTeach, rolls_that_are_none_are_refused) {
  EXPECT_THAT(message_of(parse_log("length,turn\n0,0\n", "log.csv")),
              HasSubstr("log.csv: expected a roll around a part"));
  EXPECT_THAT(message_of(parse_log("length,turn\n0,1\n0,2\n", "log.csv")), HasSubstr("expected a roll around a part"));
  EXPECT_THAT(message_of(parse_log("length,turn\n1,0\n3,1\n2,2\n4,3\n", "log.csv")),
              HasSubstr("goes back from length 3 to 2"));
}

TEST(BadTeach, turn_that_no_part_has_is_refused) {
  EXPECT_THAT(message_of(parse_log("length,turn\n1,0\n2,1e9\n", "log.csv")), HasSubstr("degrees are written 73deg"));
}

TEST(BadTeach, single_row_is_a_straight_open_curve_or_refused) {
  const Taught taught = teach(parse_log("length,turn\n1,0.5\n", "log.csv"));
  EXPECT_EQ(taught.closing, Closing::kept_open);
}

TEST(BadTeach, contact_log_without_a_finger_and_bad_noise_are_refused) {
  const Log log = finger_log(shape("ellipse"), 0.1, 0, 1, 20);
  EXPECT_THAT(message_of(log), HasSubstr("`finger`"));
  TeachOptions flat;
  flat.finger = rollfix::jaw();
  EXPECT_THAT(message_of(log, flat), HasSubstr("expected a disk's log, and the finger is jaw"));
  TeachOptions options = with_finger(0.1);
  options.noise = Noise{-1, 0, 0, 0};
  EXPECT_THAT(message_of(log, options), HasSubstr("noise of -1"));
}

// ---- The curve.

TEST(TurningSpan, derivatives_and_closure_pass_the_check_of_curves) {
  const rollfix::Outline outline{"span", {rollfix::TurningSpan({1, 2}, {0.3, 0.2, -0.1, 0.05}, 1.7)}, false};
  EXPECT_THAT(rollfix::check(outline), testing::IsEmpty());
}

TEST(TurningSpan, constant_curvature_gives_an_arc_of_a_circle) {
  const rollfix::TurningSpan arc({0, 0}, {0, 0.5, 0, 0}, 1.6);
  for (const double s : {0.4, 1.0, 1.6}) {
    EXPECT_LT((arc.jet(s).position - Vec2(2 * std::sin(s / 2), 2 - 2 * std::cos(s / 2))).norm(), 1e-15);
  }
}

TEST(TurningSpan, turn_that_its_quadrature_is_not_exact_for_is_refused) {
  EXPECT_THROW(rollfix::TurningSpan({0, 0}, {0, 2, 0, 0}, 1), rollfix::InputError);
  EXPECT_THROW(rollfix::TurningSpan({0, 0}, {0, 1, 0, 0}, 0), rollfix::InputError);
  EXPECT_THROW(rollfix::TurningSpan({0, std::nan("")}, {0, 1, 0, 0}, 1), rollfix::InputError);
}

}  // namespace
}  // namespace teach_test
