// Where a finger with corners is: exact between rows off its corners, an interval where a row is on one.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "corner_fingers.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace rollfix::finger_corners_locate_test {
namespace {

using corner_fingers::Polygon;
using corner_fingers::square;
using shapes::kPi;
using testing::HasSubstr;

Part part_of(const std::string& shape) { return Part(gallery(shape)); }

Log log_of(const Part& part, const Finger& finger, double start, double u, double rotation, std::size_t rows = 61) {
  RollPlan plan;
  plan.start = start;
  plan.u = u;
  plan.rotation = rotation;
  plan.rows = rows;
  return roll(part, finger, plan).log;
}

/// The distance from s to the nearest placement: 0 inside one.
double miss(const Answer& answer, double s) {
  double least = answer.part.perimeter();
  for (const Placement& placement : answer.placements) {
    if (placement.contains(answer.part.boundary(), s)) return 0;
    least = std::min(least, answer.part.distance(placement.start[0], s));
  }
  return least;
}

/// A log that starts or ends in the middle of a pivot: rows of a longer one.
Log rows_between(Log log, std::size_t first, std::size_t last) {
  for (FingerRows& rows : log.fingers) {
    for (auto* column : {&rows.u, &rows.psi, &rows.x, &rows.y}) {
      *column = std::vector<double>(column->begin() + static_cast<long>(first),
                                    column->begin() + static_cast<long>(last) + 1);
    }
  }
  log.time =
      std::vector<double>(log.time.begin() + static_cast<long>(first), log.time.begin() + static_cast<long>(last) + 1);
  return log;
}

/// Of a square of this half size on a cam, rows 0 to 60: on a corner from about 8 on, behind it from about 25 on.
struct Case {
  Part part = part_of("cam");
  Polygon polygon = square(0.3);
  Finger finger = polygon.finger();
  Log log = log_of(part, finger, 2, 0, 4);

  std::vector<bool> on_corners() const { return rows_on_corners(log, {finger}); }
  /// The n-th row on the first corner that the roll comes to.
  std::size_t row_on_corner(std::size_t n) const {
    const std::vector<bool> on = on_corners();
    return static_cast<std::size_t>(std::find(on.begin(), on.end(), true) - on.begin()) + n;
  }
  double start_of(std::size_t row) const { return 2 - (log.fingers[0].u[row] - log.fingers[0].u[0]); }
};

TEST(FingerCornersLocate, a_roll_over_a_corner_is_located_exactly) {
  const Case cam;
  const Answer answer = solve({cam.part, cam.log, {cam.finger}});
  EXPECT_LT(miss(answer, 2), 1e-8);
  EXPECT_GT(answer.corner_rows.count, 5U);
}

TEST(FingerCornersLocate, a_last_row_on_a_corner_is_filled_in_by_the_row_before_the_pivot) {
  const Case cam;
  const std::size_t last = cam.row_on_corner(5);
  const Answer answer = solve({cam.part, rows_between(cam.log, 0, last), {cam.finger}});
  ASSERT_EQ(answer.readings.size(), 2U);
  EXPECT_TRUE(answer.readings[0].is_exact());
  EXPECT_NEAR(answer.readings[1].pivot, kPi / 4, 1e-9);
  EXPECT_LT(miss(answer, 2), 1e-7);
  EXPECT_EQ(answer.placements.front().kind, Kind::crossing);
}

TEST(FingerCornersLocate, a_first_row_on_a_corner_costs_nothing_where_exact_rows_follow) {
  const Case cam;
  const std::size_t first = cam.row_on_corner(3);
  const Answer answer = solve({cam.part, rows_between(cam.log, first, 60), {cam.finger}});
  EXPECT_LT(miss(answer, cam.start_of(first)), 1e-7);
  EXPECT_TRUE(answer.corner_rows.first);
  EXPECT_LT(cam.part.distance(answer.placements.front().start[0], cam.start_of(first)), 1e-7)
      << "what contradicts is last";
  for (const Placement& placement : answer.placements) {
    EXPECT_NEAR(cam.part.boundary().distance(placement.end[0], placement.start[0] + answer.readings.back().length[0]),
                0, 1e-9);
  }
}

TEST(FingerCornersLocate, with_nothing_but_rows_on_corners_the_answer_is_a_stretch_that_holds_the_truth) {
  const Case cam;
  Log log = cam.log;
  const std::vector<bool> on = cam.on_corners();
  const std::size_t first = cam.row_on_corner(4);
  std::size_t last = 60;
  while (!on[last] || cam.log.fingers[0].u[last] == cam.log.fingers[0].u[first]) --last;
  log = rows_between(log, first, last);
  for (auto* column : {&log.fingers[0].u, &log.fingers[0].psi, &log.fingers[0].x, &log.fingers[0].y, &log.time}) {
    *column = {column->front(), column->back()};
  }
  const Answer answer = solve({cam.part, log, {cam.finger}});
  EXPECT_NEAR(answer.readings[0].pivot, kPi / 2, 1e-9) << "both corners'";
  EXPECT_EQ(miss(answer, cam.start_of(first)), 0);
  EXPECT_NE(answer.verdict.name, Verdict::unique);
}

TEST(FingerCornersLocate, an_open_reading_has_all_starts_that_fit_some_turn_of_it_and_no_others) {
  const Part part = part_of("spline,seed=3");
  Reading reading(0.8, 0.3);
  reading.pivot = 0.25;
  const Search search = locate(part, reading);
  for (double s = 0.0005; s < part.perimeter(); s += 0.001) {
    const double turn = part.turning().angle(s + 0.8) - part.turning().angle(s);
    const bool fits = std::abs(turn - 0.3) <= 0.25;
    const double margin = std::abs(std::abs(turn - 0.3) - 0.25);
    const bool is_listed =
        std::any_of(search.placements.begin(), search.placements.end(),
                    [&](const Placement& placement) { return placement.contains(part.boundary(), s); });
    if (margin < 1e-7) continue;
    EXPECT_EQ(is_listed, fits) << s;
  }
  for (const Placement& placement : search.placements) EXPECT_EQ(placement.kind, Kind::stretch);
}

TEST(FingerCornersLocate, an_exact_reading_beside_an_open_one_leaves_its_crossings) {
  const Part part = part_of("spline,seed=3");
  const Reading exact = shapes::reading_from(part, 2, 1.1);
  Reading open = shapes::reading_from(part, 2, 1.5);
  open.turn += 0.2;
  open.pivot = 0.25;
  const Search search = locate(part, {exact, open});
  const Search alone = locate(part, exact);
  EXPECT_TRUE(shapes::holds(part, search, 2, 1e-9));
  EXPECT_LT(search.placements.size(), alone.placements.size());
  EXPECT_EQ(locate(part, {open, exact}).placements.size(), search.placements.size()) << "in any order";
}

/// A random roll on one of the parts, that may start and end in a pivot.
struct RandomRoll {
  Part part;
  Polygon polygon;
  Log log;
  double start = 0;
};

RandomRoll random_roll(std::mt19937_64& generator) {
  const auto uniform = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(generator); };
  static const std::vector<Part> parts{part_of("ellipse"), part_of("cam"), part_of("ellipse,a=1,b=0.8"),
                                       part_of("limacon,a=1,b=0.4")};
  const Part& part = parts[generator() % parts.size()];
  const double size = uniform(0.03, 0.2);
  const std::vector<Polygon> polygons{square(size), corner_fingers::chamfered(size), corner_fingers::triangle(size)};
  const Polygon polygon = polygons[generator() % polygons.size()];
  const double start = uniform(0, part.perimeter());
  const double way = uniform(2, 9) * (generator() % 2 == 0 ? 1 : -1);
  Log log = log_of(part, polygon.finger(), start, uniform(0, polygon.around()), way, 81);
  const std::size_t first = generator() % 30;
  const double at = start - (log.fingers[0].u[first] - log.fingers[0].u[0]);
  return {part, polygon, rows_between(log, first, 50 + generator() % 31), at};
}

TEST(FingerCornersLocate, random_rolls_are_located_and_nothing_is_invented) {
  std::mt19937_64 generator = test_generator(41);
  for (int k = 0; k < test_count(60); ++k) {
    const RandomRoll random = random_roll(generator);
    const Answer answer = solve({random.part, random.log, {random.polygon.finger()}});
    EXPECT_LT(miss(answer, random.start), 1e-6) << k << " " << answer.verdict.text();
    if (answer.verdict.name == Verdict::unique) {
      EXPECT_LT(random.part.distance(answer.placements.front().start[0], random.start), 1e-6) << k;
    }
    for (const Placement& placement : answer.placements) {
      if (placement.is_contradicted || placement.kind == Kind::stretch) continue;
      EXPECT_LT(corner_fingers::disagreement(random.part, random.polygon, random.log, placement.start[0]), 1e-4) << k;
    }
  }
}

TEST(FingerCornersLocate, two_fingers_with_corners_on_a_free_part) {
  const Part part = part_of("cam");
  FreePlan plan;
  plan.fingers[0] = {square(0.2).finger(), 1, 0, 0.9};
  plan.fingers[1] = {disk(0.2), 4, 0, -0.6};
  plan.part_rotation = 0.3;
  const Log log = roll_free(part, plan).log;
  const Answer answer = solve({part, log, {plan.fingers[0].finger, plan.fingers[1].finger}});
  const auto is_true = [&](const Placement& placement) {
    return part.distance(placement.start[0], 1) < 1e-6 && part.distance(placement.start[1], 4) < 1e-6;
  };
  EXPECT_TRUE(std::any_of(answer.placements.begin(), answer.placements.end(), is_true)) << answer.verdict.text();
}

TEST(FingerCornersLocate, noisy_rows_near_a_corner_are_not_weighed) {
  const Case cam;
  RollPlan plan;
  plan.start = 2;
  plan.u = 0;
  plan.rotation = 5;
  plan.rows = 200;
  const Noise noise{.contact = 0.005, .angle = 0.005};
  const NoisyRoll roll = noisy_roll(cam.part, cam.finger, plan, noise, 7);
  const Answer answer = solve({cam.part, roll.log, {cam.finger}, noise});
  EXPECT_LT(cam.part.distance(answer.placements.front().mean[0], 2), 5 * answer.placements.front().sd[0]);
  EXPECT_FALSE(answer.verdict.fits_badly);
  EXPECT_LT(answer.weighing->samples, 200 - 50);
}

TEST(FingerCornersLocate, a_row_of_a_stream_is_the_reading_of_the_log_on_a_corner_or_not) {
  const Case cam;
  const std::vector<Reading> readings = readings_as_given(cam.log, {cam.finger});
  LogStream live("live", cam.part, {cam.finger});
  for (std::size_t row = 0; row < cam.log.rows(); ++row) {
    const Sample sample = live.push(cam.log.time[row], cam.log.fingers[0].u[row], cam.log.fingers[0].psi[row]).sample;
    EXPECT_EQ(sample.reading.length[0], readings[row].length[0]);
    EXPECT_EQ(sample.reading.turn, readings[row].turn);
    EXPECT_EQ(sample.reading.pivot, readings[row].pivot);
    EXPECT_EQ(std::isinf(sample.finger_curvature[0]), cam.on_corners()[row]);
  }
}

TEST(FingerCornersLocate, a_certificate_of_readings_on_a_corner_is_refused) {
  const Case cam;
  Reading open(0.8, 0.3);
  open.pivot = 0.25;
  EXPECT_THAT(refusal_of([&] { certify(cam.part, {open}); }), HasSubstr("on a corner of the finger"));
}

}  // namespace
}  // namespace rollfix::finger_corners_locate_test
