// Fingers of any convex shape: rolling without slip, seen from outside; both ways of computing it; what can't be.
#include "rollfix/finger.hpp"
#include "integrated_rolls.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "shapes.hpp"

namespace rollfix::finger_test {
namespace {

using integrated_rolls::integrated_roll;
using shapes::kPi;
using testing::AllOf;
using testing::HasSubstr;

Finger finger_from(const std::string& shape) { return Finger::outlined(gallery(shape)); }

/// What a disk of this radius is as an outline.
Finger circle_finger(double radius) { return finger_from(fmt::format("circle,r={}", radius)); }

RollPlan plan_over(double start, double distance, std::size_t rows = 101, double u = 0) {
  RollPlan plan;
  plan.start = start;
  plan.distance = distance;
  plan.rows = rows;
  plan.u = u;
  return plan;
}

/// A point of the finger in the world.
Vec2 in_world(const Log& log, std::size_t row, const Vec2& on_finger) {
  const double c = std::cos(log.fingers[0].psi[row]);
  const double s = std::sin(log.fingers[0].psi[row]);
  return {log.fingers[0].x[row] + c * on_finger.x() - s * on_finger.y(),
          log.fingers[0].y[row] + s * on_finger.x() + c * on_finger.y()};
}

/// Finger and part share the contact, and their tangents there, by differences of their points, are opposite.
void expect_touching(const Part& part, const Finger& finger, const Roll& roll) {
  for (std::size_t row = 0; row < roll.s[0].size(); ++row) {
    const double h = 1e-6 * part.perimeter();
    const double u = roll.log.fingers[0].u[row];
    EXPECT_LT((in_world(roll.log, row, finger.point(u)) - part.point(roll.s[0][row])).norm(), 1e-9 * part.perimeter());
    const Vec2 along = part.point(roll.s[0][row] + h) - part.point(roll.s[0][row] - h);
    const Vec2 against = in_world(roll.log, row, finger.point(u + h)) - in_world(roll.log, row, finger.point(u - h));
    EXPECT_LT((along.normalized() + against.normalized()).norm(), 1e-4);
  }
}

/// The finger's material point that touches is at rest: between the rows before and after, it moves by third order.
void expect_no_slip(const Part& part, const Finger& finger, const Roll& roll) {
  double most = 0;
  double longest = 0;
  for (std::size_t row = 1; row + 1 < roll.s[0].size(); ++row) {
    const Vec2 material = finger.point(roll.log.fingers[0].u[row]);
    const Vec2 moved = in_world(roll.log, row + 1, material) - in_world(roll.log, row - 1, material);
    const double step = std::abs(roll.s[0][row + 1] - roll.s[0][row - 1]);
    most = std::max(most, moved.norm() / step);
    longest = std::max(longest, step);
  }
  EXPECT_LT(most, 2e-3) << part.name() << " " << finger.name() << " steps of " << longest;
}

// --- Shapes.

TEST(Finger, normals_points_and_curvatures_belong_together) {
  for (const Finger& finger : {rollfix::disk(0.3), rollfix::jaw(), finger_from("ellipse,a=0.4,b=0.2"),
                               finger_from("limacon,a=0.5,b=0.2"), finger_from("log-spiral")}) {
    const double middle = finger.ends().hi < 1e300 ? finger.ends().middle() : 0;
    for (const double du : {-0.3, 0.05, 0.4}) {
      const double u = middle + du;
      const double h = 1e-5;
      const Vec2 tangent = (finger.point(u + h) - finger.point(u - h)).normalized();
      const Vec2 normal(std::cos(finger.normal(u)), std::sin(finger.normal(u)));
      EXPECT_LT((normal - Vec2(tangent.y(), -tangent.x())).norm(), 1e-6) << finger.name() << ": outwards, body left";
      const double rate = (finger.normal(u + h) - finger.normal(u - h)) / (2 * h) / finger.length_per_u();
      EXPECT_NEAR(finger.curvature(u), rate, 1e-6 * (1 + rate)) << finger.name();
    }
  }
}

TEST(Finger, turns_by_no_more_along_itself_than_where_it_is_sharpest) {
  EXPECT_NEAR(finger_from("ellipse,a=0.4,b=0.2").turn_per_u(), 0.4 / (0.2 * 0.2), 1e-9);
  EXPECT_EQ(rollfix::disk(0.3).turn_per_u(), 1);  // its u is an angle
  EXPECT_EQ(rollfix::jaw().turn_per_u(), 0);
}

TEST(Finger, a_clockwise_outline_is_the_same_finger) {
  const Finger finger = Finger::outlined(reversed(gallery("ellipse,a=0.4,b=0.2")));
  EXPECT_NEAR(finger.normal(finger.period()) - finger.normal(0), 2 * kPi, 1e-9);
  EXPECT_GT(finger.curvature(0.1), 0);
}

TEST(Finger, what_is_not_convex_is_refused) {
  EXPECT_THAT(refusal_of([] { finger_from("limacon,a=1,b=0.9"); }), HasSubstr("a curvature of -"));
  EXPECT_THAT(refusal_of([] { finger_from("gear"); }), HasSubstr("convex"));
}

TEST(Finger, a_contact_after_a_reading_gives_that_reading_back) {
  for (const Finger& finger : {rollfix::disk(0.3), rollfix::jaw(), finger_from("ellipse,a=0.4,b=0.2")}) {
    const Contact first{0.4, 1.2};
    const Reading reading = reading_between(finger, first, contact_after(finger, first, {-0.7, 1.9}));
    EXPECT_NEAR(reading.length[0], -0.7, 1e-14);
    EXPECT_NEAR(reading.turn, 1.9, 1e-14);
  }
}

// --- Rolling.

TEST(Finger, a_circle_as_an_outline_rolls_like_a_disk) {
  const Part part(gallery("spline,seed=3"));
  const Finger outline = circle_finger(0.1);
  RollPlan plan = plan_over(0.7, 3);
  const Roll expected = roll(part, outline, plan);
  plan.psi = expected.log.fingers[0].psi[0];
  plan.u.reset();
  const Roll found = roll(part, 0.1, plan);
  for (std::size_t row = 0; row < found.s[0].size(); ++row) {
    EXPECT_NEAR(found.s[0][row], expected.s[0][row], 1e-9);
    EXPECT_NEAR(found.log.fingers[0].psi[row], expected.log.fingers[0].psi[row], 1e-9);
    EXPECT_NEAR(0.1 * found.log.fingers[0].u[row], expected.log.fingers[0].u[row] + 0.1 * found.log.fingers[0].u[0],
                1e-9);
    EXPECT_NEAR(found.log.fingers[0].x[row], expected.log.fingers[0].x[row], 1e-9);
  }
}

TEST(Finger, a_jaw_turns_with_the_tangent_and_its_contact_runs_along_it) {
  const Part part(gallery("ellipse"));
  const Roll found = roll(part, rollfix::jaw(), plan_over(1, 7, 300));
  for (std::size_t row = 0; row < found.s[0].size(); ++row) {
    const double turned = part.turning().angle(found.s[0][row]) - part.turning().angle(1);
    EXPECT_NEAR(found.log.fingers[0].psi[row] - found.log.fingers[0].psi[0], turned, 1e-9);
    EXPECT_NEAR(found.log.fingers[0].u[row], -(found.s[0][row] - 1), 1e-9);
  }
  expect_touching(part, rollfix::jaw(), found);
  expect_no_slip(part, rollfix::jaw(), roll(part, rollfix::jaw(), plan_over(1, 7, 4000)));
}

/// Fingers and parts that roll on each other.
struct Pairing {
  Part part;
  Finger finger;
  RollPlan plan;
};

Pairing random_pairing(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> share(0, 1);
  const std::vector<std::string> parts = {"ellipse", "cam",        "naca", "spline,seed=3", "spline,n=14,seed=3",
                                          "stadium", "exponential"};
  const double size = std::pow(10, -1 + share(generator));
  const std::vector<std::string> fingers = {fmt::format("ellipse,a={},b={}", size, size * (0.4 + share(generator))),
                                            fmt::format("limacon,a={},b={}", size, 0.45 * size * share(generator)),
                                            fmt::format("circle,r={}", size)};
  Part part(gallery(parts[generator() % parts.size()]));
  const Finger finger = share(generator) < 0.2 ? rollfix::jaw() : finger_from(fingers[generator() % fingers.size()]);
  const double P = part.perimeter();
  const bool open = !part.closed();
  const double start = P * share(generator);
  const double distance = open ? P * share(generator) - start : 3 * P * (share(generator) - 0.5);
  return {part, finger, plan_over(start, distance, 400, 10 * (share(generator) - 0.5))};
}

double difference(const Roll& a, const Roll& b) {
  double most = 0;
  for (std::size_t row = 0; row < a.s[0].size(); ++row) {
    most = std::max({most, std::abs(a.s[0][row] - b.s[0][row]), std::abs(a.angle[0][row] - b.angle[0][row]),
                     std::abs(a.log.fingers[0].u[row] - b.log.fingers[0].u[row]),
                     std::abs(a.log.fingers[0].psi[row] - b.log.fingers[0].psi[row])});
  }
  return most;
}

TEST(Finger, both_ways_of_rolling_agree_on_random_shapes) {
  auto generator = test_generator(31);
  int rolled = 0;
  for (int k = 0; k < test_count(60); ++k) {
    const Pairing pairing = random_pairing(generator);
    Roll exact;
    try {
      exact = roll(pairing.part, pairing.finger, pairing.plan);
    } catch (const InputError& error) {  // then the other way refuses it as well
      EXPECT_EQ(refusal_of([&] { integrated_roll(pairing.part, pairing.finger, pairing.plan); }), error.what());
      continue;
    }
    ++rolled;
    const Roll integrated = integrated_roll(pairing.part, pairing.finger, pairing.plan);
    EXPECT_LT(difference(exact, integrated), 3e-8) << pairing.part.name() << " " << pairing.finger.name();
    EXPECT_NEAR(exact.s[0].back() - exact.s[0].front(), *pairing.plan.distance, 1e-9);
    const Reading last = readings(exact.log, pairing.part, {pairing.finger}).back();
    EXPECT_NEAR(last.length[0], exact.s[0].back() - exact.s[0].front(), 1e-9);
    EXPECT_NEAR(last.turn, exact.angle[0].back() - exact.angle[0].front(), 1e-8);
  }
  EXPECT_GT(rolled, test_count(60) / 4);
}

TEST(Finger, nothing_slips_and_everything_touches) {
  for (const char* part_name : {"ellipse", "spline,seed=3"}) {
    const Part part(gallery(part_name));
    for (const Finger& finger : {finger_from("ellipse,a=0.1,b=0.06"), finger_from("limacon,a=0.08,b=0.03")}) {
      for (const double distance : {2.0, -1.5}) {
        const Roll found = roll(part, finger, plan_over(1.1, distance, 4000, 0.2));
        expect_touching(part, finger, found);
        expect_no_slip(part, finger, found);
      }
    }
  }
}

TEST(Finger, at_a_corner_of_the_part_it_pivots) {
  const Part square = shapes::unit_square();
  const Finger finger = finger_from("ellipse,a=0.3,b=0.2");
  const Roll found = roll(square, finger, plan_over(0.5, 1, 2001));
  EXPECT_NEAR(found.angle[0].back() - found.angle[0].front(), kPi / 2, 1e-12);
  const auto on_corner = std::count(found.s[0].begin(), found.s[0].end(), 1.0);
  EXPECT_GT(on_corner, 100) << "rows in the pivot";
  EXPECT_LT(difference(found, integrated_roll(square, finger, plan_over(0.5, 1, 2001))), 1e-8);
}

TEST(Finger, a_stadium_rolls_over_its_own_joints) {
  const Part part(gallery("ellipse"));
  const Finger finger = finger_from("stadium,r=0.2,length=0.5");
  const Roll found = integrated_roll(part, finger, plan_over(0.3, 9, 500));
  EXPECT_LT(difference(found, roll(part, finger, plan_over(0.3, 9, 500))), 1e-8);
  expect_touching(part, finger, found);
}

TEST(Finger, the_part_is_found_where_it_is) {
  const Part part(gallery("cam"));
  for (const Finger& finger : {rollfix::jaw(), finger_from("ellipse,a=0.3,b=0.2")}) {
    const Roll found = roll(part, finger, plan_over(2, 1.5, 100, 0.3));
    const Poses at = *poses(part, {finger}, found.log, 2, {0, 50, 99});
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(at.pose[k].x, 0, 1e-9) << finger.name();
      EXPECT_NEAR(at.pose[k].y, 0, 1e-9);
      EXPECT_LT(at.residual[k], 1e-9);
    }
  }
}

// --- Where it can't go.

TEST(Finger, a_jaw_on_a_flat_side_is_refused) {
  EXPECT_THAT(refusal_of([] { roll(shapes::unit_square(), rollfix::jaw(), plan_over(0.5, 0.2)); }),
              AllOf(HasSubstr("flat jaw"), HasSubstr("curvature is 0")));
  EXPECT_THAT(refusal_of([] { roll(Part(gallery("limacon")), rollfix::jaw(), plan_over(1, 6)); }),
              HasSubstr("flat jaw"));
}

TEST(Finger, an_open_finger_ends) {
  const Part part(gallery("ellipse"));
  const Finger finger = finger_from("log-spiral");
  const double half = finger.ends().hi / 2;
  EXPECT_THAT(refusal_of([&] { roll(part, finger, plan_over(1, half + 0.01, 300, half)); }),
              HasSubstr("runs off the end of the finger"));
  EXPECT_NEAR(roll(part, finger, plan_over(1, half - 0.01, 300, half)).log.fingers[0].u.back(), 0.01, 1e-9);
  EXPECT_THAT(refusal_of([&] { roll(part, finger, plan_over(1, 0.1, 300, 3 * half)); }), HasSubstr("expected a first"));
}

/// The first place on a grid where the finger's curvature does not make up for the part's.
double first_tight(const Part& part, const Finger& finger, double start, double u) {
  for (double way = 0; way < part.perimeter(); way += 1e-4) {
    if (part.turning().curvature(start + way) + finger.curvature(u - way) <= 0) return start + way;
  }
  return -1;
}

TEST(Finger, it_sticks_where_it_does_not_fit_any_more) {
  const Part part(gallery("limacon"));
  const Finger finger = finger_from("ellipse,a=0.9,b=0.3");
  const double start = 2;
  const double place = first_tight(part, finger, start, 0.2);
  ASSERT_GT(place, start);
  RollPlan plan = plan_over(start, place - start + 1e-3, 300, 0.2);
  EXPECT_THAT(refusal_of([&] { roll(part, finger, plan); }),
              AllOf(HasSubstr("curved inwards"), HasSubstr(fmt::format("s = {:.3f}", place).substr(0, 7))));
  plan.distance = place - start - 1e-3;
  EXPECT_NEAR(roll(part, finger, plan).s[0].back(), place - 1e-3, 1e-8);
}

// --- Logs.

TEST(Finger, logs_of_a_jaw_and_of_outlines_are_read_back) {
  const Part part(gallery("ellipse"));
  for (const Finger& finger : {rollfix::jaw(), finger_from("ellipse,a=0.3,b=0.2")}) {
    const Roll found = roll(part, finger, plan_over(1, 8, 200));
    const Log log = parse_log(format_log(found.log), "run.csv");
    const std::vector<Reading> all = readings_as_given(log, {finger});
    LogStream stream("live", part, {finger});
    stream.push("u,psi");
    for (std::size_t row = 0; row < all.size(); ++row) {
      EXPECT_NEAR(all[row].length[0], found.s[0][row] - 1, 1e-9);
      const LogLine line = stream.push(fmt::format("{:.17g},{:.17g}", log.fingers[0].u[row], log.fingers[0].psi[row]));
      ASSERT_EQ(line.kind, row == 0 ? LineKind::first : LineKind::sample) << line.message;
      EXPECT_EQ(line.sample.reading.length[0], all[row].length[0]);
      EXPECT_EQ(line.sample.reading.turn, all[row].turn);
      EXPECT_EQ(line.sample.finger_curvature[0], finger.curvature(log.fingers[0].u[row]));
    }
  }
}

TEST(Finger, u_of_a_closed_outline_may_be_wrapped_at_its_length) {
  const Part part(gallery("ellipse"));
  const Finger finger = finger_from("ellipse,a=0.3,b=0.2");
  Log log = roll(part, finger, plan_over(1, 8, 200)).log;
  const double whole = readings(log, part, {finger}).back().length[0];
  for (double& u : log.fingers[0].u) u -= finger.period() * std::floor(u / finger.period());
  EXPECT_NEAR(readings(log, part, {finger}).back().length[0], whole, 1e-9);
}

TEST(Finger, a_row_off_the_end_of_an_open_finger_is_refused_or_skipped) {
  const Part part(gallery("ellipse"));
  const Finger finger = finger_from("log-spiral");
  const double end = finger.ends().hi;
  const std::string off = fmt::format("{},0.1", end + 0.01);
  LogStream stream("live", part, {finger});
  EXPECT_EQ(stream.push("u,psi").kind, LineKind::nothing);
  EXPECT_EQ(stream.push("0.5,0").kind, LineKind::first);
  const LogLine line = stream.push(off);
  EXPECT_EQ(line.kind, LineKind::malformed);
  EXPECT_THAT(line.message, HasSubstr("live:3: u is"));
  const Log log = parse_log("u,psi\n0.5,0\n" + off + "\n", "run.csv");
  EXPECT_THAT(refusal_of([&] { readings(log, part, {finger}); }), HasSubstr("run.csv:3: u is"));
}

}  // namespace
}  // namespace rollfix::finger_test
