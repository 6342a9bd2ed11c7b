// The checks that every log has to pass, of one finger and of each of two, as a file, as lines and as numbers: no jump,
// no place off the end of an open finger, times that grow.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "free_roll.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::log_checks_test {
namespace {

using free_rolls::by_distances;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const std::vector<Finger> kFingers{DiskFinger{0.2}, DiskFinger{0.3}};

const Part& egg() {
  static const Part part(gallery("ellipse"));
  return part;
}

std::vector<Finger> fingers_of(const Log& log) {
  return {kFingers.begin(), kFingers.begin() + static_cast<std::ptrdiff_t>(log.fingers.size())};
}

/// A roll of one finger, or of two on a part that turns meanwhile.
Log roll_of(std::size_t fingers) {
  if (fingers == 2) return roll_free(egg(), by_distances(0.2, 1, 4, 0.3, 6, -3, 1.5)).log;
  RollPlan plan;
  plan.start = 1;
  plan.distance = 4;
  plan.rows = 201;
  return roll(egg(), kFingers[0], plan).log;
}

/// Line by line, as text.
std::vector<LogLine> streamed(const Log& log, const Part& part = egg()) {
  LogStream stream("live", part, fingers_of(log));
  std::vector<LogLine> lines;
  std::string text = format_log(log);
  while (!text.empty()) {
    const std::size_t end = text.find('\n') + 1;
    lines.push_back(stream.push(text.substr(0, end)));
    text.erase(0, end);
  }
  lines.erase(lines.begin());  // the header
  return lines;
}

PerFinger<Touch> touch_of(const Log& log, std::size_t row) {
  auto touch = PerFinger<Touch>::of(log.fingers.size());
  for (std::size_t k = 0; k < touch.size(); ++k) {
    const FingerRows& rows = log.fingers[k];
    touch[k] = {rows.u[row], rows.psi[row], rows.x[row], rows.y[row]};
  }
  return touch;
}

/// Row by row, as numbers.
std::vector<LogLine> pushed(const Log& log) {
  LogStream stream("live", egg(), fingers_of(log));
  std::vector<LogLine> lines;
  for (std::size_t row = 0; row < log.rows(); ++row) lines.push_back(stream.push(log.time[row], touch_of(log, row)));
  return lines;
}

std::string refusal_of_file(const Log& log, const std::vector<Finger>& fingers, const Part& part = egg()) {
  return refusal_of([&] { readings(parse_log(format_log(log), "run.csv"), part, fingers); });
}

/// What is wrong in a row is found wherever the rows come from.
void expect_jump(const Log& log, std::size_t row, const std::string& whose) {
  const std::string since = fmt::format("since line {}", row + 1);
  EXPECT_THAT(refusal_of_file(log, fingers_of(log)),
              AllOf(StartsWith(fmt::format("run.csv:{}: expected a roll that goes on, found a jump: ", row + 2)),
                    HasSubstr("the length" + whose + " changes by"), HasSubstr(since), HasSubstr("split the log")));
  const LogLine line = streamed(log)[row];
  EXPECT_EQ(line.kind, LineKind::jump);
  EXPECT_THAT(line.message, AllOf(StartsWith(fmt::format("live:{}: ", row + 2)), HasSubstr("the length" + whose)));
  EXPECT_EQ(line.sample.reading.length[0], 0);
  EXPECT_EQ(pushed(log)[row].kind, LineKind::jump);
}

std::string whose(std::size_t fingers, std::size_t finger) {
  return fingers == 1 ? "" : finger == 0 ? " of finger a" : " of finger b";
}

TEST(LogChecks, a_place_far_off_is_a_jump_of_each_finger) {
  for (const std::size_t fingers : {1U, 2U}) {
    for (std::size_t k = 0; k < fingers; ++k) {
      Log log = roll_of(fingers);
      log.fingers[k].u[100] += 4;
      expect_jump(log, 100, whose(fingers, k));
    }
  }
}

TEST(LogChecks, a_stray_row_is_left_out_of_every_column) {
  std::string rows = "time,distance,dturn\n0,0,0\n";
  for (int k = 1; k <= 12; ++k) rows += fmt::format("{},0.1,{}\n", k, k == 6 ? 30.05 : k == 7 ? -29.95 : 0.05);
  const Log log = parse_log(rows, "steps.csv");
  std::vector<std::size_t> lines;
  const Log left = without_strays(log, egg(), {}, Noise{0.01, 0.01}, &lines);
  ASSERT_THAT(lines, testing::ElementsAre(8U));
  for (const auto* column : {&left.time, &left.fingers[0].length, &left.fingers[0].turn, &left.fingers[0].distance,
                             &left.fingers[0].dturn}) {
    EXPECT_EQ(column->size(), 12U);
  }
}

TEST(LogChecks, an_orientation_far_off_is_a_jump_of_each_finger) {
  for (const std::size_t fingers : {1U, 2U}) {
    for (std::size_t k = 0; k < fingers; ++k) {
      Log log = roll_of(fingers);
      log.fingers[k].psi[100] -= 2;
      expect_jump(log, 100, whose(fingers, k));
    }
  }
}

TEST(LogChecks, a_contact_that_is_off_turns_a_small_disks_normal_with_it_and_is_no_jump) {
  RollPlan plan;
  plan.start = 1;
  plan.distance = 0.002;
  plan.rows = 20;
  const double radius = 0.05;
  Log log = roll(egg(), disk(radius), plan).log;
  log.fingers[0].u[15] += 1;
  const auto refusal = [&](double contact) {
    return refusal_of([&] { readings(log, egg(), {disk(radius)}, {}, Noise{contact, 0.001}); });
  };
  EXPECT_EQ(refusal(radius / 7), "nothing was thrown");  // it is seven deviations off
  EXPECT_THAT(refusal(radius / 100), HasSubstr("found a jump"));
}

TEST(LogChecks, of_two_files_the_one_that_jumps_is_named) {
  for (std::size_t k = 0; k < 2; ++k) {
    Log log = roll_of(2);
    log.fingers[k].u[100] += 4;
    const Log read = paired(parse_log(format_log(one_finger(log, 0)), "a.csv"),
                            parse_log("# of b\n" + format_log(one_finger(log, 1)), "b.csv"));
    EXPECT_THAT(refusal_of([&] { readings(read, egg(), kFingers); }),
                AllOf(StartsWith(k == 0 ? "a.csv:102: " : "b.csv:103: "),
                      HasSubstr(k == 0 ? "since line 101" : "since line 102")));
  }
}

TEST(LogChecks, a_part_may_turn_under_two_fingers_as_it_likes) {
  Log log = roll_of(2);
  for (FingerRows& rows : log.fingers) {
    for (std::size_t row = 100; row < log.rows(); ++row) rows.psi[row] += 2.5;
  }
  EXPECT_EQ(refusal_of_file(log, kFingers), "nothing was thrown");
  for (const LogLine& line : streamed(log)) EXPECT_NE(line.kind, LineKind::jump) << line.message;
}

TEST(LogChecks, no_finger_turns_by_more_than_a_lap_against_the_part) {
  const auto refusal = [](const std::string& text) {
    return refusal_of([&] { readings(parse_log(text, "run.csv"), egg(), {}); });
  };
  EXPECT_THAT(refusal("length,turn\n0,0\n0.1,8\n"), HasSubstr("turns by at most 417.296 deg"));
  EXPECT_THAT(refusal("length_a,turn_a,length_b,turn_b\n0,0,0,0\n0.1,15.5,0.2,0.5\n"),
              AllOf(StartsWith("run.csv:3: "), HasSubstr("of finger a"),
                    HasSubstr("of the other finger by 28.6479 deg"), HasSubstr("834.592 deg over both lengths")));
  EXPECT_THAT(refusal("length_a,turn_a,length_b,turn_b\n0,0,0,0\n0.1,0,0.2,-15\n"), HasSubstr("of finger b"));
  EXPECT_EQ(refusal("length_a,turn_a,length_b,turn_b\n0,0,0,0\n0.1,15,0.2,14\n"), "nothing was thrown");
}

TEST(LogChecks, no_finger_goes_farther_than_an_open_part_is_long) {
  const Part open(Outline{"open", {Line({0, 0}, {2, 0})}, false});
  const auto refusal = [&](const std::string& text) {
    return refusal_of([&] { readings(parse_log(text, "run.csv"), open, {}); });
  };
  EXPECT_THAT(refusal("length,turn\n0,0\n2.5,0\n"), HasSubstr("only 2 long"));
  EXPECT_THAT(refusal("length_a,turn_a,length_b,turn_b\n0,0,0,0\n2.5,0,1,0\n"),
              AllOf(HasSubstr("the length of finger a"), HasSubstr("only 2 long")));
  EXPECT_THAT(refusal("length_a,turn_a,length_b,turn_b\n0,0,0,0\n1,0,-2.5,0\n"), HasSubstr("the length of finger b"));
}

/// An arc of radius 1 and of length 2, as a finger.
const Finger& open_finger() {
  static const Finger finger = Finger::outlined(Outline{"pad", {Arc({0, 0}, 1, 0, 2)}, false});
  return finger;
}

TEST(LogChecks, no_finger_touches_beyond_its_end) {
  const auto refusal = [&](const std::string& text, const std::vector<Finger>& fingers) {
    return refusal_of([&] { readings(parse_log(text, "run.csv"), egg(), fingers); });
  };
  EXPECT_THAT(refusal("u,psi\n0.5,0\n2.5,0\n", {open_finger()}),
              AllOf(StartsWith("run.csv:3: u is 2.5"), HasSubstr("pad goes from 0 to 2 along")));
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b\n0.5,0,0,0\n2.5,0,1,0\n", {open_finger()}),
              StartsWith("run.csv:3: u_a is 2.5"));
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b\n0.5,0,0,0\n1,0,-0.5,0\n", {open_finger()}),
              StartsWith("run.csv:3: u_b is -0.5"));
  EXPECT_THAT(refusal("u_a,psi_a,u_b,psi_b\n0.5,0,0,0\n2.5,0,0,0\n", {DiskFinger{1}, open_finger()}),
              "nothing was thrown")
      << "a is a disk";
}

TEST(LogChecks, a_stream_skips_what_is_off_an_end) {
  LogStream lines("live", egg(), {DiskFinger{1}, open_finger()});
  LogStream numbers("live", egg(), {DiskFinger{1}, open_finger()});
  lines.push("u_a,psi_a,u_b,psi_b");
  for (LogLine line : {lines.push("0,0,1,0"), numbers.push({}, {{0, 0}, {1, 0}})}) {
    EXPECT_EQ(line.kind, LineKind::first);
  }
  for (const LogLine& line : {lines.push("0,0,2.5,0"), numbers.push({}, {{0, 0}, {2.5, 0}})}) {
    EXPECT_EQ(line.kind, LineKind::malformed);
    EXPECT_THAT(line.message, HasSubstr("u_b is 2.5, but the finger pad"));
  }
  EXPECT_EQ(numbers.malformed(), 1U);
  EXPECT_EQ(numbers.push({}, {{3, 0}, {1.5, 0}}).kind, LineKind::sample);
}

TEST(LogChecks, a_stream_of_two_fingers_has_the_bits_of_the_file) {
  const Log log = roll_of(2);
  const std::vector<LogLine> lines = streamed(log);
  for (const std::size_t row : {1U, 7U, 100U, 200U}) {
    Log so_far = log;
    so_far.time.resize(row + 1);
    for (FingerRows& rows : so_far.fingers) {
      for (std::vector<double>* column : {&rows.u, &rows.psi, &rows.x, &rows.y}) column->resize(row + 1);
    }
    const Reading expected = readings(parse_log(format_log(so_far), "file"), egg(), kFingers).back();
    const Sample& found = lines[row].sample;
    EXPECT_EQ(lines[row].kind, LineKind::sample);
    EXPECT_EQ(found.reading.length, expected.length);
    EXPECT_EQ(found.reading.turn, expected.turn);
    EXPECT_EQ((*found.contact)[1].psi, log.fingers[1].psi[row]);
    EXPECT_EQ((*found.centre)[1].y(), log.fingers[1].y[row]);
    EXPECT_EQ(found.finger_curvature, PerFinger<double>(5, 1 / 0.3));
  }
}

TEST(LogChecks, rows_as_numbers_say_what_lines_of_text_say) {
  for (const std::size_t fingers : {1U, 2U}) {
    const Log log = roll_of(fingers);
    const std::vector<LogLine> lines = streamed(log);
    const std::vector<LogLine> numbers = pushed(log);
    ASSERT_EQ(lines.size(), numbers.size());
    for (std::size_t row = 0; row < lines.size(); ++row) {
      ASSERT_EQ(numbers[row].kind, lines[row].kind) << numbers[row].message;
      EXPECT_EQ(numbers[row].sample.time, lines[row].sample.time);
      EXPECT_EQ(numbers[row].sample.reading.length, lines[row].sample.reading.length);
      EXPECT_EQ(numbers[row].sample.reading.turn, lines[row].sample.reading.turn);
      EXPECT_EQ((*numbers[row].sample.centre)[0], (*lines[row].sample.centre)[0]);
    }
  }
}

TEST(LogChecks, rows_as_numbers_pass_the_same_checks) {
  LogStream stream("live", egg(), {kFingers[0]});
  EXPECT_EQ(stream.push_off(0.0).kind, LineKind::nothing) << "no contact yet";
  EXPECT_EQ(stream.push(1, 0, 0).kind, LineKind::first);
  EXPECT_THAT(stream.push(2, kNan, 0).message, StartsWith("live:3: u is nan, expected a finite number"));
  EXPECT_THAT(stream.push(2, 0, kNan).message, HasSubstr("psi is nan"));
  EXPECT_THAT(stream.push(kNan, 0, 0).message, HasSubstr("time is nan"));
  EXPECT_THAT(stream.push(1, -1, 1.2).message,
              HasSubstr("time is '1', expected more than 1 in line 2: time must grow"));
  EXPECT_THAT(stream.push({}, -1, 1.2).message, HasSubstr("found a row without time"));
  EXPECT_THAT(stream.push(2, -1, 1.2, 0, 0).message, HasSubstr("as the first row"));
  EXPECT_THAT(stream.push(2, -1, 1.2, 0).message, HasSubstr("only one of x and y"));
  EXPECT_THAT(stream.push(2, {{0, 0}, {0, 0}}).message, HasSubstr("as many fingers"));
  EXPECT_EQ(stream.malformed(), 8U);
  const LogLine sample = stream.push(2, -1, 1.2);
  EXPECT_EQ(sample.kind, LineKind::sample);
  EXPECT_DOUBLE_EQ(sample.sample.reading.length[0], 0.2);
  EXPECT_EQ(sample.sample.line, 11U);
  EXPECT_EQ(stream.push_off(3).kind, LineKind::lost);
  EXPECT_EQ(stream.push(4, 7, 7).kind, LineKind::first);
  EXPECT_EQ(stream.fingers(), 1U);
  EXPECT_THAT(stream.push("5,8,8").message, HasSubstr("rows came as numbers so far"));
  EXPECT_THAT(refusal_of([&] { LogStream("live", egg(), {}).push({}, 0, 0); }), HasSubstr("finger's shape"));
}

TEST(LogChecks, no_honest_log_of_two_fingers_has_a_jump_however_its_rows_lie) {
  auto generator = test_generator(12);
  std::uniform_real_distribution<double> share(0, 1);
  const std::vector<std::string> shapes_to_try = {"ellipse", "cam", "stadium", "reuleaux", "spline,n=14,seed=3"};
  for (int k = 0; k < test_count(60); ++k) {
    const Part part(gallery(shapes_to_try[generator() % shapes_to_try.size()]));
    const double P = part.perimeter();
    const auto way = [&] { return P * (1.2 * share(generator) - 0.6); };
    FreePlan plan =
        by_distances(0.02, P * share(generator), way(), 0.03, P * share(generator), way(), 8 * share(generator) - 4);
    plan.rows = 4000;
    const Log whole = roll_free(part, plan).log;
    // Few rows or many, with gaps, as they are written, and what was turned only by the part.
    Log log = whole;
    log.time.clear();
    for (FingerRows& rows : log.fingers) rows.u.clear(), rows.psi.clear(), rows.x.clear(), rows.y.clear();
    const double usual = std::pow(10, 2.5 * share(generator));
    for (double at = 0; at < 4000; at += 1 + usual * share(generator) * (share(generator) < 0.1 ? 20 : 1)) {
      const auto row = static_cast<std::size_t>(at);
      log.time.push_back(whole.time[row]);
      for (const std::size_t finger : {0U, 1U}) {
        log.fingers[finger].u.push_back(whole.fingers[finger].u[row]);
        log.fingers[finger].psi.push_back(whole.fingers[finger].psi[row]);
      }
    }
    if (log.rows() < 3) continue;
    if (share(generator) < 0.5) log.time.clear();
    EXPECT_EQ(refusal_of([&] {
                readings(log, part, {DiskFinger{0.02}, DiskFinger{0.03}});
              }),
              "nothing was thrown")
        << part.name();
  }
}

}  // namespace
}  // namespace rollfix::log_checks_test
