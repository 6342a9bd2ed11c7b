// A roll that is followed row by row through the library, without the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "catalogs.hpp"
#include "free_roll.hpp"
#include "log/mirrored.hpp"
#include "paths.hpp"
#include "refusal.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/tracker.hpp"
#include "rollfix/turning_function.hpp"
#include "watch_logs.hpp"

namespace watch_tracker_test {
namespace {

using rollfix::FingerRows;
using rollfix::LineKind;
using rollfix::Log;
using rollfix::LogKind;
using rollfix::Mode;
using rollfix::Placement;
using rollfix::RollEnd;
using rollfix::Touch;
using rollfix::Tracked;
using rollfix::Tracker;
using rollfix::TrackOptions;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using watching::cam;

Log noisy(double start, double length, std::size_t count) {
  return rollfix::parse_log(watching::noisy_log(start, length, count), "roll.csv");
}

Tracker on_cam(const TrackOptions& options = {}) { return {cam(), {watching::kFinger}, watching::kNoise, options}; }

Touch touch(const FingerRows& rows, std::size_t row) { return {rows.u[row], rows.psi[row]}; }

/// What is told of these rows of a log of one finger or of two, as numbers.
std::vector<Tracked> told(Tracker& tracker, const Log& log, std::size_t from = 0, std::size_t to = SIZE_MAX) {
  std::vector<Tracked> all;
  for (std::size_t row = from; row < std::min(to, log.rows()); ++row) {
    const rollfix::PerFinger<Touch> touches =
        log.fingers.size() == 1 ? rollfix::PerFinger<Touch>(touch(log.fingers[0], row))
                                : rollfix::PerFinger<Touch>(touch(log.fingers[0], row), touch(log.fingers[1], row));
    for (const Tracked& now : tracker.push(log.time[row], touches)) all.push_back(now);
  }
  return all;
}

/// To the bit.
void expect_as_solved(const Tracked& last, const rollfix::Answer& solved) {
  EXPECT_EQ(last.verdict.text(), solved.verdict.text());
  EXPECT_EQ(last.rest, solved.weighing->rest);
  ASSERT_THAT(last.modes, SizeIs(solved.placements.size()));
  for (std::size_t k = 0; k < last.modes.size(); ++k) {
    EXPECT_EQ(last.modes[k].probability, solved.placements[k].probability);
    for (std::size_t finger = 0; finger < last.modes[k].mean.size(); ++finger) {
      EXPECT_EQ(last.modes[k].mean[finger], solved.placements[k].mean[finger]);
      EXPECT_EQ(last.modes[k].end_sd[finger], solved.placements[k].end_sd[finger]);
    }
  }
}

/// Two fingers on a part that is free, from s and t.
rollfix::NoisyRoll pair_roll(const rollfix::Part& part, double s, double length_a, double t, double length_b) {
  rollfix::FreePlan plan = free_rolls::by_distances(0.1, s, length_a, 0.1, t, length_b, 0.3);
  plan.rows = 40;
  return rollfix::noisy_roll_free(part, plan, watching::kNoise, 1);
}

/// The later log as if the fingers had never let go: disks that are turned so that u goes on, and a later clock.
Log going_on(const Log& before, Log later) {
  for (std::size_t which = 0; which < later.fingers.size(); ++which) {
    FingerRows& rows = later.fingers[which];
    const double further = before.fingers[which].u.back() - rows.u.front();
    for (double& u : rows.u) u += further;
    for (double& psi : rows.psi) psi -= further;
  }
  for (double& time : later.time) time += before.time.back() + 1;
  return later;
}

std::vector<std::string> lines_of(const std::string& file) {
  std::ifstream text(checked_out("examples/" + file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST(Tracker, says_where_the_finger_is_in_five_standard_deviations) {
  Tracker tracker = on_cam();
  told(tracker, noisy(2, 3, 400));
  const Mode& best = tracker.now().modes.front();
  EXPECT_EQ(tracker.now().verdict.name, rollfix::Verdict::unique);
  EXPECT_LT(best.end_sd[0], 0.02);
  EXPECT_NEAR(best.end_mean[0], 5, 5 * best.end_sd[0]);
}

TEST(Tracker, tells_the_first_contact_then_news_and_the_end) {
  Tracker tracker = on_cam();
  const std::vector<Tracked> all = told(tracker, noisy(2, 3, 400));
  EXPECT_EQ(all.front().samples, 1U);
  for (std::size_t k = 1; k < all.size(); ++k) EXPECT_TRUE(is_news(all[k - 1], all[k], cam()));
  EXPECT_THAT(all, SizeIs(testing::AllOf(testing::Gt(3U), testing::Lt(40U))));
  EXPECT_EQ(tracker.finish().front().over, RollEnd::ended);
}

TEST(Tracker, says_at_any_row_what_a_belief_of_these_rows_says) {
  const Log log = noisy(2, 3, 400);
  Tracker tracker = on_cam();
  rollfix::LogStream stream("roll", cam(), {watching::kFinger}, watching::kNoise);
  rollfix::Belief belief(cam(), LogKind::contact, {watching::kNoise}, {{1 / 0.2}, {}, {watching::kFinger}});
  for (const std::size_t row : {80U, 81U, 300U}) {
    told(tracker, log, tracker.last().sample.line, row);
    for (std::size_t k = stream.lines(); k < row; ++k) {
      belief.add(stream.push(log.time[k], log.fingers[0].u[k], log.fingers[0].psi[k]).sample);
    }
    ASSERT_THAT(tracker.now().modes, SizeIs(belief.modes().size()));
    EXPECT_EQ(tracker.now().samples, row);
    // It was looked at more often, on a grid of its own.
    EXPECT_NEAR(tracker.now().modes.front().mean[0], belief.modes().front().mean[0], 1e-5);
  }
}

TEST(Tracker, says_at_the_end_what_solve_says_of_the_same_rows) {
  const Log log = noisy(2, 0.6, 80);
  Tracker tracker = on_cam();
  told(tracker, log);
  expect_as_solved(tracker.finish().front(),
                   solve(rollfix::Problem{cam(), log, {watching::kFinger}, watching::kNoise}));
}

TEST(Tracker, follows_two_fingers_on_a_part_that_is_free) {
  const rollfix::Part part = free_rolls::part_of("spline,n=9,seed=4,wobble=0.25");
  const Log log = pair_roll(part, 1, 1.3, 4.2, -0.9).log;
  Tracker tracker(part, {rollfix::disk(0.1)}, watching::kNoise, {.every = 1000});
  told(tracker, log);
  const Tracked last = tracker.finish().front();
  expect_as_solved(last, solve(rollfix::Problem{part, log, {rollfix::disk(0.1)}, watching::kNoise}));
  EXPECT_NEAR(last.modes.front().mean[0], 1, 5 * last.modes.front().sd[0]);
  EXPECT_NEAR(last.modes.front().mean[1], 4.2, 5 * last.modes.front().sd[1]);
}

TEST(Tracker, follows_a_jaw_beside_a_wheel_by_the_lines_of_their_logs) {
  const std::vector<std::string> jaw = lines_of("rig-jaw.csv");
  const std::vector<std::string> pin = lines_of("rig-pin.csv");
  const rollfix::Noise noise{.contact = 0.01, .angle = 0.005, .position = 0.01};
  Tracker tracker(cam(), {rollfix::jaw()}, noise, {.every = 1000, .wheel = 0.4});
  const std::size_t count = 16;
  for (std::size_t k = 0; k < count; ++k) {
    tracker.push(jaw[k], 0);
    tracker.push(pin[k], 1);
  }
  const Tracked last = tracker.finish().front();
  const auto text = [&](const std::vector<std::string>& lines) {
    return watching::text_of({lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(count)});
  };
  const rollfix::HoldAnswer solved =
      solve(rollfix::HoldProblem{.part = cam(),
                                 .logs = {rollfix::parse_log(text(jaw), "jaw")},
                                 .fingers = {rollfix::jaw()},
                                 .noise = noise,
                                 .wheels = {{rollfix::parse_pin_log(text(pin), "pin"), 0.4}}});
  EXPECT_EQ(last.held->verdict_text(), solved.verdict_text());
  ASSERT_THAT(last.modes, SizeIs(solved.placements.size()));
  for (const std::size_t which : {0U, 1U}) {
    EXPECT_EQ(last.modes.front().mean[which], solved.placements.front().contacts[which].mean);
  }
}

TEST(Tracker, says_which_part_of_a_catalog_it_is_as_identify_says) {
  const cli::Folder folder;
  const auto catalog = std::make_shared<const rollfix::Catalog>(catalogs::of({"ellipse,a=2,b=1", "cam", "limacon"}));
  const Log log = noisy(2, 3, 60);
  Tracker tracker = track(catalog, {watching::kFinger}, watching::kNoise);
  told(tracker, log);
  const Tracked last = tracker.finish().front();
  const rollfix::Identified asked = identify(*catalog, {catalog->part(0), log, {watching::kFinger}, watching::kNoise});
  EXPECT_EQ(last.parts->verdict, asked.verdict);
  EXPECT_EQ(last.parts->parts.front().probability, asked.parts.front().probability);
  EXPECT_EQ(catalog->entry(last.parts->parts.front().weight.part).name, "cam");
  EXPECT_EQ(last.verdict.text(), "unique");
}

TEST(Tracker, says_that_rows_contradict_the_noise_on_every_part_of_a_catalog) {
  const cli::Folder folder;
  const auto catalog = std::make_shared<const rollfix::Catalog>(catalogs::of({"ellipse,a=2,b=1", "cam"}));
  rollfix::Noise understated = watching::kNoise;
  understated.contact /= 2;
  understated.angle /= 2;
  Tracker tracker = track(catalog, {watching::kFinger}, understated);
  told(tracker, noisy(2, 3, 60));
  const Tracked last = tracker.finish().front();
  EXPECT_TRUE(last.parts->parts.front().answer.verdict.fits_badly);
  EXPECT_TRUE(last.verdict.fits_badly);
}

TEST(Tracker, ends_a_roll_where_contact_is_lost_and_begins_another) {
  Tracker tracker = on_cam();
  told(tracker, noisy(2, 3, 400));
  EXPECT_EQ(tracker.push_off(900).front().over, RollEnd::lost);
  EXPECT_THAT(tracker.push_off(901), IsEmpty());
  const Tracked first = tracker.push(902, 0.5, 0.1).front();
  EXPECT_EQ(first.roll, 2U);
  EXPECT_EQ(first.samples, 1U);
}

TEST(Tracker, tells_the_end_of_a_roll_before_the_first_contact_of_the_next_and_why) {
  Tracker tracker = on_cam();
  told(tracker, noisy(2, 3, 400));
  const std::vector<Tracked> both = tracker.push(900, 80, 0);
  ASSERT_THAT(both, SizeIs(2));
  EXPECT_EQ(both[0].over, RollEnd::jump);
  EXPECT_EQ(both[1].roll, 2U);
  EXPECT_THAT(tracker.messages(), ElementsAre(HasSubstr("the log")));
}

TEST(Tracker, leaves_out_a_row_that_is_no_number_and_says_so) {
  Tracker tracker = on_cam();
  told(tracker, noisy(2, 3, 40));
  EXPECT_THAT(tracker.push(900, std::nan(""), 0), IsEmpty());
  EXPECT_THAT(tracker.messages(), ElementsAre(HasSubstr("u is nan")));
  EXPECT_EQ(tracker.now().samples, 40U);
}

TEST(Tracker, keeps_news_back_until_it_can_be_told) {
  bool ready = false;
  Tracker tracker = on_cam({.is_ready = [&] { return ready; }});
  EXPECT_THAT(told(tracker, noisy(2, 3, 400)), SizeIs(1));
  EXPECT_THAT(tracker.catch_up(), IsEmpty());
  ready = tracker.is_behind();
  EXPECT_EQ(tracker.catch_up().front().samples, 400U);
  EXPECT_FALSE(tracker.is_behind());
}

TEST(Tracker, of_a_circle_stays_unobservable) {
  const rollfix::Part circle(rollfix::gallery("circle,r=1"));
  Tracker tracker(circle, {rollfix::disk(0.2)}, watching::kNoise);
  for (int row = 0; row < 50; ++row) tracker.push(row, 0.1 * row, -0.12 * row);
  EXPECT_EQ(tracker.now().verdict.name, rollfix::Verdict::unobservable);
}

TEST(Tracker, of_two_fingers_finds_them_where_they_were_carried) {
  const rollfix::Part part = free_rolls::part_of("spline,n=9,seed=4,wobble=0.25");
  const Log before = pair_roll(part, 1, 1.3, 4.2, -0.9).log;
  const rollfix::NoisyRoll after = pair_roll(part, 3, 1.2, 0.2, 1.3);
  Tracker tracker(part, {rollfix::disk(0.1)}, watching::kNoise, {.again = true, .every = 20});
  told(tracker, before);
  told(tracker, going_on(before, after.log));
  const std::size_t begins = after.log.rows() - tracker.now().samples;
  ASSERT_EQ(tracker.now().roll, 2U);
  for (const std::size_t which : {0U, 1U}) {
    const Mode& best = tracker.now().modes.front();
    EXPECT_NEAR(best.mean[which], after.truth.s[which][begins], 5 * best.sd[which]);
  }
}

TEST(Tracker, of_a_part_that_lies_face_down_turns_the_outline_of_the_finger_over_as_solve_does) {
  const rollfix::Finger tip = rollfix::Finger::outlined(rollfix::gallery("spline,n=7,seed=2,wobble=0.3"));
  const rollfix::Finger seen = mirrored(tip);
  rollfix::RollPlan plan;
  plan.start = 2;
  plan.distance = 2;
  Log log = rollfix::roll(cam(), seen, plan).log;
  mirror(log.fingers[0], &seen);
  Tracker tracker(cam(), {tip}, watching::kNoise, {.mirrored = true});
  told(tracker, log);
  rollfix::Problem problem{cam(), log, {tip}, watching::kNoise};
  problem.mirrored = true;
  const Mode best = tracker.finish().front().modes.at(0);
  EXPECT_NEAR(best.mean[0], solve(problem).placements.at(0).mean[0], 1e-9);  // u and psi are turned over and back again
  EXPECT_NEAR(best.mean[0], 2, 5 * best.sd[0]);
}

TEST(Tracker, refuses_what_cannot_be_before_a_row_comes) {
  const auto refusal = [](const rollfix::Noise& noise, const TrackOptions& options) {
    return refusal_of([&] { Tracker(cam(), {rollfix::jaw()}, noise, options); });
  };
  EXPECT_THAT(refusal({}, {}), HasSubstr("noise"));
  EXPECT_THAT(refusal(watching::kNoise, {.wheel = 0.4}), HasSubstr("position=SD"));
  EXPECT_THAT(refusal({.contact = 0.01, .angle = 0.01, .position = 0.01}, {.mirrored = true}), HasSubstr("mirror"));
  EXPECT_THAT(refusal({.contact = 0.01, .angle = 0.01, .position = 0.01}, {.robust = true, .wheel = 0.4}),
              HasSubstr("robust"));
}

TEST(Tracker, of_two_logs_takes_their_lines_alone) {
  Tracker tracker(cam(), {rollfix::jaw()}, {.contact = 0.01, .angle = 0.01, .position = 0.01}, {.wheel = 0.4});
  EXPECT_THAT(refusal_of([&] { tracker.push(0, 0, 0); }), HasSubstr("expected the lines of two logs"));
}

}  // namespace watch_tracker_test
