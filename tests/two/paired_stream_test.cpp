// Two logs that grow at different speeds, row by row, as one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"

namespace paired_stream_test {
namespace {

using rollfix::LineKind;
using rollfix::LogLine;
using rollfix::PairedStream;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const rollfix::Part& part() {
  static const rollfix::Part cam(rollfix::gallery("cam"));
  return cam;
}

/// Two streams side by side, with what became of their rows.
struct Streams {
  Streams& push(std::size_t which, const std::string& line) { return keep(stream.push(which, line)); }
  Streams& keep(const std::vector<LogLine>& rows) {
    for (const LogLine& row : rows) {
      kinds.push_back(row.kind);
      if (row.kind == LineKind::malformed) why = row.message;
      if (row.kind == LineKind::first || row.kind == LineKind::sample) times.push_back(row.sample.time.value_or(-1));
    }
    return *this;
  }

  explicit Streams(const rollfix::Finger& finger = rollfix::disk(0.1), bool b_is_pin = false)
      : stream({"a.csv", "b.csv"}, part(), {finger}, {}, {}, false, b_is_pin) {}

  PairedStream stream;
  std::vector<LineKind> kinds;
  std::vector<double> times;  // of those that were taken
  std::string why;            // the last one was skipped
};

Streams with_headers(const std::string& header = "time,u,psi") {
  Streams streams;
  streams.push(0, header).push(1, header);
  return streams;
}

}  // namespace

TEST(PairedStream, a_jaw_goes_with_a_wheels_pin_which_has_no_encoder_or_one) {
  for (const std::string psi : {"", ",psi"}) {
    Streams streams(rollfix::jaw(), true);
    streams.push(0, "time,u,psi,x,y").push(1, "time,x,y" + psi).push(0, "0,0.5,0,1,2");
    const LogLine row = streams.stream.push(1, psi.empty() ? "0,3,4" : "0,3,4,0.7").front();
    EXPECT_EQ(row.kind, LineKind::first);
    EXPECT_EQ((*row.sample.centre)[1], rollfix::Vec2(3, 4));
    EXPECT_EQ(std::isnan((*row.sample.contact)[1].psi), psi.empty());
  }
}

TEST(PairedStream, a_pins_log_goes_on_without_its_header_after_a_dropped_connection) {
  Streams streams(rollfix::jaw(), true);
  streams.push(0, "time,u,psi,x,y").push(1, "time,x,y").push(0, "0,0.5,0,1,2").push(1, "0,3,4");
  streams.stream.resume(1);
  streams.push(0, "1,0.5,0,1,2").push(1, "1,3,4");
  EXPECT_THAT(streams.times, ElementsAre(0, 1));
}

TEST(PairedStream, a_row_is_taken_when_its_partner_comes) {
  Streams streams = with_headers();
  streams.push(0, "0,0,0").push(0, "1,0.1,0");
  EXPECT_THAT(streams.kinds, IsEmpty());
  streams.push(1, "0,0,0").push(1, "1,0.2,0");
  EXPECT_THAT(streams.kinds, ElementsAre(LineKind::first, LineKind::sample));
}

TEST(PairedStream, one_log_can_come_before_the_header_of_the_other) {
  Streams streams;
  streams.push(0, "time,u,psi").push(0, "0,0,0").push(0, "1,0.1,0").push(1, "time,u,psi");
  streams.push(1, "0,0,0").push(1, "1,0.1,0");
  EXPECT_THAT(streams.times, ElementsAre(0, 1));
}

TEST(PairedStream, rows_that_the_other_log_does_not_have_are_skipped) {
  Streams streams = with_headers();
  streams.push(0, "0,0,0").push(0, "1,0.1,0").push(0, "2,0.2,0").push(1, "0,0,0").push(1, "2,0.2,0");
  EXPECT_THAT(streams.times, ElementsAre(0, 2));
  EXPECT_THAT(streams.why, HasSubstr("a.csv:3: b.csv has no row at the time 1"));
}

TEST(PairedStream, clocks_that_round_are_the_same_instant) {
  Streams streams = with_headers();
  for (const char* row : {"0,0,0", "100,0.1,0"}) streams.push(0, row);
  for (const char* row : {"0,0,0", "100.00000001,0.1,0"}) streams.push(1, row);
  EXPECT_THAT(streams.times, ElementsAre(0, 100));
}

TEST(PairedStream, contact_of_both_makes_a_roll) {
  Streams streams = with_headers("time,u,psi,contact");
  for (const char* row : {"0,0,0,1", "1,0,0,1", "2,0.1,0,1", "3,0.2,0,1"}) streams.push(0, row);
  for (const char* row : {"0,0,0,0", "1,0,0,1", "2,0.1,0,1", "3,0.2,0,0"}) streams.push(1, row);
  EXPECT_THAT(streams.kinds, ElementsAre(LineKind::nothing, LineKind::first, LineKind::sample, LineKind::lost));
}

TEST(PairedStream, each_sample_is_that_of_the_rows_side_by_side) {
  Streams streams = with_headers();
  rollfix::LogStream both("both.csv", part(), {rollfix::disk(0.1)});
  both.push("time,u_a,psi_a,u_b,psi_b");
  for (int k = 0; k < 20; ++k) {
    const std::string time = std::to_string(k);
    const std::string a = std::to_string(0.37 * k) + "," + std::to_string(-0.4 * k);
    const std::string b = std::to_string(-0.21 * k) + "," + std::to_string(0.17 * k);
    streams.stream.push(0, time + "," + a);
    const std::vector<LogLine> two = streams.stream.push(1, time + "," + b);
    const LogLine one = both.push(time + "," + a + "," + b);
    ASSERT_EQ(two.size(), 1U);
    EXPECT_EQ(two[0].kind, one.kind);
    EXPECT_EQ(two[0].sample.reading.length, one.sample.reading.length);
    EXPECT_EQ(two[0].sample.reading.turn, one.sample.reading.turn);
  }
}

TEST(PairedStream, a_log_that_begins_anew_waits_for_the_other_one_to_do_so) {
  Streams streams = with_headers();
  streams.push(0, "0,0,0").push(1, "0,0,0").push(1, "50,0.1,0");
  streams.keep(streams.stream.restart(0)).push(0, "time,u,psi").push(0, "1,0,0").push(0, "2,0,0");
  EXPECT_THAT(streams.times, ElementsAre(0));
  streams.keep(streams.stream.restart(1)).push(1, "time,u,psi").push(1, "1,0,0").push(1, "2,0,0");
  EXPECT_THAT(streams.times, ElementsAre(0, 1, 2));
}

TEST(PairedStream, a_log_that_goes_on_with_the_same_clock_goes_with_the_new_one) {
  Streams streams = with_headers();
  streams.push(0, "0,0,0").push(1, "0,0,0").push(1, "1,0.1,0");
  streams.keep(streams.stream.restart(0)).push(0, "time,u,psi").push(0, "1,0,0");
  EXPECT_THAT(streams.times, ElementsAre(0, 1));
}

TEST(PairedStream, without_times_rows_are_counted_and_a_dropped_connection_is_the_end) {
  Streams streams = with_headers("u,psi");
  for (const char* row : {"0,0", "?,0", "0.2,0"}) streams.push(0, row);
  for (const char* row : {"0,0", "0.1,0", "0.2,0"}) streams.push(1, row);
  EXPECT_THAT(streams.kinds, testing::Contains(LineKind::sample).Times(1));
  EXPECT_THROW(streams.stream.resume(0), rollfix::InputError);
}

TEST(PairedStream, says_when_a_log_is_too_far_ahead) {
  Streams streams = with_headers();
  for (std::size_t k = 0; k < PairedStream::kMostWaiting; ++k) streams.push(0, std::to_string(k) + ",0,0");
  EXPECT_TRUE(streams.stream.is_ahead(0));
  streams.push(1, "0,0,0");
  EXPECT_FALSE(streams.stream.is_ahead(0));
}

TEST(PairedStream, logs_of_different_kinds_are_refused) {
  Streams streams;
  streams.push(0, "time,u,psi");
  EXPECT_THROW(streams.push(1, "time,length,turn"), rollfix::InputError);
  Streams times;
  times.push(0, "time,u,psi");
  EXPECT_THROW(times.push(1, "u,psi"), rollfix::InputError);
}

}  // namespace paired_stream_test
