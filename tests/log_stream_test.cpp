// A log that grows: its samples are those of the file that ends there, and what breaks a file is survived.
#include "rollfix/log.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "log/log_rows.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "shapes.hpp"

namespace rollfix::log_stream_test {

std::ostream& operator<<(std::ostream& out, LineKind kind) {
  constexpr std::array<const char*, 6> kNames = {"nothing", "first", "sample", "lost", "malformed", "jump"};
  return out << kNames[static_cast<std::size_t>(kind)];
}

namespace {

using shapes::kPi;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using enum LineKind;

const Part& egg() {
  static const Part part(gallery("ellipse"));
  return part;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t start = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', start)) {
    lines.push_back(text.substr(start, end + 1 - start));
    start = end + 1;
  }
  if (start < text.size()) lines.push_back(text.substr(start));
  return lines;
}

LogStream stream_on(const Part& part, const Noise& noise = {}) { return {"live", part, {DiskFinger{0.2}}, noise}; }

/// What a stream on the ellipse makes of each line.
struct Streamed {
  std::vector<LogLine> lines;
  std::vector<LineKind> kinds;
  std::size_t malformed = 0;
};

Streamed streamed(const std::string& text, const Part& part = egg()) {
  LogStream stream = stream_on(part);
  Streamed result;
  for (const std::string& line : lines_of(text)) {
    result.lines.push_back(stream.push(line));
    result.kinds.push_back(result.lines.back().kind);
  }
  result.malformed = stream.malformed();
  return result;
}

void expect_equal_bits(const Reading& found, const Reading& expected, std::size_t line) {
  EXPECT_EQ(found.length, expected.length) << "line " << line;
  EXPECT_EQ(found.turn, expected.turn) << "line " << line;
}

/// Each sample against the last reading of the file that ends there.
void expect_samples_of_files(const std::string& text, const Part& part = egg()) {
  const std::vector<std::string> lines = lines_of(text);
  const Streamed found = streamed(text, part);
  std::string so_far = lines[0];
  for (std::size_t k = 1; k < lines.size(); ++k) {
    so_far += lines[k];
    if (found.kinds[k] != sample) continue;
    const Reading expected = readings(parse_log(so_far, "file"), part, {DiskFinger{0.2}}).back();
    expect_equal_bits(found.lines[k].sample.reading, expected, k + 1);
  }
}

std::string roll_text(const Part& part, double start, double distance, std::size_t rows) {
  RollPlan plan;
  plan.start = start;
  plan.distance = distance;
  plan.rows = rows;
  return format_log(roll(part, DiskFinger{0.2}, plan).log);
}

// --- What it says of clean logs.

TEST(LogStream, samples_have_the_bits_of_the_file) {
  expect_samples_of_files(roll_text(egg(), 1, 12.5, 201));
  expect_samples_of_files("length,turn\n0.5,0.1\n0.7,0.25\n1.1,40deg\n");
  expect_samples_of_files("0.1,0.01\n0.1,0.02\n-0.3,0.1\n1e-3,0\n");
}

TEST(LogStream, the_whole_of_a_clean_log_is_one_roll) {
  const Streamed found = streamed(roll_text(egg(), 1, -5, 50));
  EXPECT_EQ(found.kinds[0], nothing);
  EXPECT_EQ(found.kinds[1], first);
  for (std::size_t k = 2; k < found.kinds.size(); ++k) EXPECT_EQ(found.kinds[k], sample) << found.lines[k].message;
}

TEST(LogStream, wrapped_angles_have_the_bits_of_the_file) {
  RollPlan plan;
  plan.distance = 20;
  plan.rows = 400;
  const Log log = roll(egg(), DiskFinger{0.2}, plan).log;
  std::string text = "u,psi\n";
  for (std::size_t k = 0; k < log.rows(); ++k) {
    text += fmt::format("{:.17g},{:.17g}\n", std::remainder(log.fingers[0].u[k], 2 * kPi),
                        log.fingers[0].psi[k] - 2 * kPi * std::floor(log.fingers[0].psi[k] / (2 * kPi)));
  }
  expect_samples_of_files(text);
  EXPECT_NEAR(streamed(text).lines.back().sample.reading.length[0], 20, 1e-9);
}

TEST(LogStream, a_column_that_leaves_a_full_turn_was_never_wrapped) {
  const std::string text = "u,psi\n0,0\n-1,1\n-2,2\n3.3,3\n4,4\n4.6,5\n";
  expect_samples_of_files(text, Part(gallery("circle,r=3")));
  EXPECT_EQ((*streamed(text).lines.back().sample.contact)[0].u, 4.6);
}

TEST(LogStream, a_roll_begins_anew_where_it_cannot_be_told_whether_an_angle_is_wrapped) {
  const Streamed found = streamed("u,psi\n0,0\n-0.5,4\n-0.6,4.1\n");
  EXPECT_THAT(found.kinds, ElementsAre(nothing, first, jump, sample));
  EXPECT_THAT(found.lines[2].message, HasSubstr("psi is wrapped can't be told"));
}

TEST(LogStream, a_sample_has_all_that_its_row_has) {
  const LogLine row = streamed("time,u,psi,x,y\n0.5,1,2,3,4\n").lines.back();
  EXPECT_EQ(row.sample.line, 2U);
  EXPECT_EQ(row.sample.time, 0.5);
  EXPECT_EQ((*row.sample.contact)[0].u, 1);
  EXPECT_EQ((*row.sample.contact)[0].psi, 2);
  EXPECT_EQ((*row.sample.centre)[0], Vec2(3, 4));
  EXPECT_EQ(row.sample.finger_curvature[0], 5);
}

TEST(LogStream, lengths_follow_the_outline_as_it_was_given) {
  const Part hole_way(reversed(gallery("ellipse")));
  ASSERT_FALSE(hole_way.reversed());  // toggled twice
  Outline outline = reversed(gallery("ellipse"));
  outline.reversed = false;
  const Part clockwise(outline);
  ASSERT_TRUE(clockwise.reversed());
  LogStream stream("live", clockwise, {});
  stream.push("length,turn");
  EXPECT_EQ(stream.push("0.5,0.1").sample.reading.length[0], -0.5);
}

// --- Contact.

TEST(LogStream, contact_0_ends_a_roll_and_the_next_contact_starts_one) {
  const Streamed found = streamed("u,psi,contact\nnan,,0\n0,0,1\n-1,1.2,1\n-1,1.2,0\n9,9,0\n-3,0.1,1\n-4,1.5,1\n");
  EXPECT_THAT(found.kinds, ElementsAre(nothing, nothing, first, sample, lost, nothing, first, sample));
  EXPECT_EQ(found.lines[6].sample.reading.length[0], 0);
  EXPECT_DOUBLE_EQ(found.lines[7].sample.reading.length[0], 0.2);
  EXPECT_DOUBLE_EQ(found.lines[7].sample.reading.turn, 0.4);
}

TEST(LogStream, later_rolls_are_those_of_read_rolls) {
  for (const char* header : {"length,turn,contact\n", "distance,dturn,contact\n"}) {
    const std::string text = header + std::string("0.5,0.1,1\n0.7,0.2,1\n9,9,0\n1.5,0.3,1\n1.75,0.5,1\n0,0,0\n");
    const Streamed found = streamed(text);
    const std::vector<Log> rolls = parse_rolls(text, "file");
    ASSERT_EQ(rolls.size(), 2U);
    EXPECT_THAT(found.kinds, ElementsAre(nothing, first, sample, lost, first, sample, lost));
    for (std::size_t k = 0; k < 4; ++k) {
      const Log& log = rolls[k / 2];
      expect_equal_bits(found.lines[k < 2 ? k + 1 : k + 2].sample.reading,
                        {log.fingers[0].length[k % 2], log.fingers[0].turn[k % 2]}, k);
    }
  }
}

// --- What can't be read.

TEST(LogStream, lines_that_cannot_be_read_are_skipped_and_counted) {
  const Streamed found = streamed(
      "time,u,psi\n0,0,0\n1,-1\n1,garbage,1\n\x01\x02\xff\n1,nan,1\n1,inf,1\n1,1e999,0\n1,-1,1.2\n1,0,0\n0.5,0,0\n"
      "2,-1.5,1.8,7\n2,-1.5,1.8\n");
  EXPECT_THAT(found.kinds, ElementsAre(nothing, first, malformed, malformed, malformed, malformed, malformed, malformed,
                                       sample, malformed, malformed, malformed, sample));
  EXPECT_EQ(found.malformed, 9U);
  EXPECT_THAT(found.lines[3].message, StartsWith("live:4: u is 'garbage', expected a number"));
  EXPECT_THAT(found.lines[9].message, HasSubstr("time must grow"));
  EXPECT_DOUBLE_EQ(found.lines.back().sample.reading.length[0], 0.3);
}

TEST(LogStream, a_line_that_cannot_be_read_leaves_no_trace) {
  const std::string clean = roll_text(egg(), 2, 3, 60);
  const std::vector<std::string> lines = lines_of(clean);
  auto generator = test_generator(11);
  LogStream undisturbed = stream_on(egg());
  LogStream disturbed = stream_on(egg());
  undisturbed.push(lines[0]);
  disturbed.push(lines[0]);
  for (std::size_t k = 1; k < lines.size(); ++k) {
    disturbed.push(lines[k].substr(0, lines[k].find(',', 40) + 1));  // torn off
    const LogLine expected = undisturbed.push(lines[k]);
    const LogLine found = disturbed.push(lines[k]);
    ASSERT_EQ(found.kind, expected.kind);
    expect_equal_bits(found.sample.reading, expected.sample.reading, k);
    std::string noise(1 + generator() % 30, ' ');
    for (char& c : noise) c = static_cast<char>(generator() % 256);
    if (disturbed.push("#" + noise).kind == malformed) ADD_FAILURE() << "a comment";
    EXPECT_NE(disturbed.push("x" + noise).kind, sample);
  }
  EXPECT_GT(disturbed.malformed(), 2 * (lines.size() - 2));
}

TEST(LogStream, what_can_never_be_read_is_refused) {
  EXPECT_THAT(refusal_of([] { stream_on(egg()).push("zeit,winkel"); }), HasSubstr("live:1: the header"));
  EXPECT_THAT(refusal_of([] { LogStream("live", egg(), {}).push("u,psi"); }), HasSubstr("finger's shape"));
  EXPECT_THAT(refusal_of([] {
                LogStream("live", egg(), {DiskFinger{1}, DiskFinger{1}}).push("u,psi");
              }),
              HasSubstr("is of one finger"));
  EXPECT_THAT(refusal_of([] { stream_on(egg()).push(std::string("\xFF\xFEt\0", 4)); }), HasSubstr("UTF-16"));
  EXPECT_THAT(refusal_of([] { stream_on(egg()).push("1,2,3"); }), HasSubstr("3 numbers without a header"));
  EXPECT_THAT(refusal_of([] { LogStream("live", egg(), {DiskFinger{-1}}); }), HasSubstr("above 0"));
}

// --- A connection that dropped.

TEST(LogStream, after_a_dropped_connection_a_header_may_come_again) {
  LogStream stream = stream_on(egg());
  for (const char* line : {"time,u,psi", "0,0,0", "1,-1,1.2"}) stream.push(line);
  stream.resume();
  EXPECT_EQ(stream.push("psi;u;time").kind, nothing);
  const LogLine row = stream.push("2.0;-1.5;0.5");
  EXPECT_EQ(row.kind, sample) << "the clock was set anew";
  EXPECT_DOUBLE_EQ(row.sample.reading.length[0], 0.3);
  EXPECT_EQ(stream.malformed(), 0U);
}

TEST(LogStream, after_a_dropped_connection_a_roll_goes_on_without_a_header) {
  LogStream stream = stream_on(egg());
  for (const char* line : {"time,u,psi", "0,0,0", "1,-1,1.2"}) stream.push(line);
  stream.resume();
  EXPECT_EQ(stream.push("-1.1,0").kind, malformed) << "the end of a torn line";
  EXPECT_EQ(stream.push("1,-1,1.2").kind, malformed) << "sent twice";
  EXPECT_EQ(stream.push("8,-2,2.4").kind, sample);
}

/// The logs of a wheel without skin, of its pin.
TEST(LogStream, after_a_dropped_connection_a_pins_header_may_come_again_with_another_clock) {
  RowReader reader("pin", {}, true);
  LogRow row;
  for (const char* line : {"time,x,y", "5,1,2"}) reader.read(line, row);
  reader.accept(row);
  reader.resume();
  EXPECT_EQ(reader.read("y,x,time", row), RowKind::none);
  EXPECT_EQ(reader.read("2,1,0.5", row), RowKind::touching) << "the clock was set anew";
  EXPECT_EQ(row.fingers[0].x, 1);
}

TEST(LogStream, a_header_in_between_is_a_line_that_cannot_be_read) {
  EXPECT_EQ(streamed("u,psi\n0,0\nu,psi\n-1,1.2\n").kinds, (std::vector<LineKind>{nothing, first, malformed, sample}));
}

// --- Jumps.

/// A log with one row's u and psi changed.
Streamed with_glitch(double du, double dpsi, std::size_t row, const Part& part = egg()) {
  RollPlan plan;
  plan.distance = 4;
  plan.rows = 200;
  Log log = roll(part, DiskFinger{0.2}, plan).log;
  log.fingers[0].u[row] += du;
  log.fingers[0].psi[row] += dpsi;
  return streamed(format_log(log), part);
}

TEST(LogStream, a_row_far_off_is_a_jump_there_and_back) {
  for (const double du : {4.0, -4.0}) {
    const Streamed found = with_glitch(du, 0.3, 100);
    EXPECT_EQ(found.kinds[101], jump);
    EXPECT_EQ(found.kinds[102], jump) << "the row after it has nothing to do with it";
    EXPECT_EQ(std::count(found.kinds.begin(), found.kinds.end(), jump), 2);
    EXPECT_THAT(found.lines[101].message, AllOf(StartsWith("live:102: expected a roll that goes on, found a jump"),
                                                HasSubstr("since line 101"), HasSubstr("50 times")));
    EXPECT_EQ(found.lines[102].sample.reading.length[0], 0);
    EXPECT_GT(found.lines[103].sample.reading.length[0], 0);
  }
}

TEST(LogStream, a_turn_that_no_lap_has_is_a_jump_at_once) {
  const Streamed found = streamed("length,turn\n0,0\n0.1,8\n");
  EXPECT_EQ(found.kinds.back(), jump);
  EXPECT_THAT(found.lines.back().message, HasSubstr("turns by at most 417.296 deg"));
  EXPECT_EQ(streamed("length,turn\n0,0\n0.1,7\n").kinds.back(), sample) << "barely";
}

TEST(LogStream, nothing_goes_farther_than_an_open_part_is_long) {
  const Part open(shapes::polygon({{0, 0}, {1, 0}, {2, 0.1}}, false));
  const Streamed found = streamed("length,turn\n0,0\n2.5,0\n", open);
  EXPECT_EQ(found.kinds.back(), jump);
  EXPECT_THAT(found.lines.back().message, HasSubstr("only 2.00499 long"));
}

TEST(LogStream, a_file_with_a_jump_is_refused_with_its_line) {
  RollPlan plan;
  plan.distance = 4;
  plan.rows = 200;
  Log log = roll(egg(), DiskFinger{0.2}, plan).log;
  log.fingers[0].u[100] += 4;
  const Log read = parse_log(format_log(log), "run.csv");
  EXPECT_THAT(refusal_of([&] { readings(read, egg(), {DiskFinger{0.2}}); }),
              AllOf(StartsWith("run.csv:102: expected a roll that goes on"), HasSubstr("split the log")));
}

/// Rows that a robot may take: few or many, with rests, in bursts, there and back.
std::vector<double> uneven_times(std::mt19937_64& generator, double duration) {
  std::uniform_real_distribution<double> share(0, 1);
  const double usual = duration * std::pow(10, -3.5 * share(generator));
  std::vector<double> times = {0};
  while (times.back() < duration) {
    const double gap = share(generator) < 0.1 ? std::pow(10, 2 * share(generator)) : 1;
    times.push_back(times.back() + usual * gap * (0.01 + share(generator)));
  }
  return times;
}

TEST(LogStream, no_honest_log_has_a_jump_however_its_rows_lie) {
  auto generator = test_generator(12);
  std::uniform_real_distribution<double> share(0, 1);
  const std::vector<std::string> shapes_to_try = {"ellipse", "cam", "stadium", "gear", "reuleaux", "spline,n=14,seed=3",
                                                  "naca"};
  for (int k = 0; k < test_count(200); ++k) {
    const Part part(gallery(shapes_to_try[generator() % shapes_to_try.size()]));
    const double P = part.perimeter();
    const double start = P * share(generator);
    const double speed = P * (share(generator) - 0.5);
    const double pause = share(generator);
    const bool has_times = share(generator) < 0.5;
    LogStream stream("live", part, {});
    stream.push(has_times ? "time,length,turn" : "length,turn");
    double last = 0;
    for (const double time : uneven_times(generator, 3)) {
      // There, a rest, and back again, with the tangent's angle as it is: the ground truth.
      const double length = time < 1 ? speed * time : time < 1 + pause ? speed : speed * (2 + pause - time);
      if (std::abs(length - last) > P) break;
      last = length;
      const Reading row = shapes::reading_from(part, start, length);
      const LogLine line = stream.push(has_times ? fmt::format("{:.17g},{:.17g},{:.17g}", time, row.length[0], row.turn)
                                                 : fmt::format("{:.17g},{:.17g}", row.length[0], row.turn));
      ASSERT_NE(line.kind, jump) << part.name() << ": " << line.message;
      ASSERT_NE(line.kind, malformed) << part.name() << ": " << line.message;
    }
  }
}

TEST(LogStream, noise_that_is_known_is_no_jump) {
  LogStream unaware = stream_on(egg());
  LogStream aware = stream_on(egg(), {.contact = 0.2, .angle = 0, .slip = 0, .radius = 0});
  const std::vector<std::string> rest = {"u,psi", "0,0", "0,0", "0,0", "0,0", "0,0", "0,0", "0,0", "0,0", "0,0", "0,0"};
  for (const std::string& line : rest) unaware.push(line), aware.push(line);
  EXPECT_EQ(unaware.push("2,0").kind, jump) << "0.4 off and 2 rad";
  EXPECT_EQ(aware.push("2,0").kind, sample) << "one and a half standard deviations";
}

}  // namespace
}  // namespace rollfix::log_stream_test
