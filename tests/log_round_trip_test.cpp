// What is written is what is read: bit for bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/contact/rolling.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline/gallery.hpp"

namespace rollfix::log_round_trip_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::uint64_t> bits_of(const std::vector<double>& values) {
  std::vector<std::uint64_t> bits;
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  return bits;
}

void expect_same(const Log& a, const Log& b) {
  EXPECT_EQ(bits_of(a.time), bits_of(b.time));
  EXPECT_EQ(bits_of(a.u), bits_of(b.u));
  EXPECT_EQ(bits_of(a.psi), bits_of(b.psi));
  EXPECT_EQ(bits_of(a.length), bits_of(b.length));
  EXPECT_EQ(bits_of(a.turn), bits_of(b.turn));
  EXPECT_EQ(bits_of(a.x), bits_of(b.x));
  EXPECT_EQ(bits_of(a.y), bits_of(b.y));
}

Log limacon_log() {
  RollPlan plan;
  plan.start = 0.3;
  plan.distance = -7;
  return roll(Part(gallery("limacon")), {0.1}, plan).log;
}

TEST(LogRoundTrip, a_roll_comes_back_bit_for_bit) {
  const Log log = limacon_log();
  const std::string text = format_log(log);
  EXPECT_THAT(text, StartsWith("time,u,psi,x,y\n0.0000000000000000,"));
  expect_same(parse_log(text, "again"), log);
  EXPECT_EQ(format_log(parse_log(text, "again")), text);
}

TEST(LogRoundTrip, random_numbers_of_any_size_come_back_bit_for_bit) {
  std::mt19937_64 generator = test_generator(41);
  std::normal_distribution<double> mantissa;
  std::uniform_int_distribution<int> exponent(-280, 280);
  Log log;
  log.kind = LogKind::travelled;
  for (int k = 0; k < test_count(2000); ++k) {
    log.length.push_back(std::ldexp(mantissa(generator), exponent(generator)));
    log.turn.push_back(mantissa(generator));
  }
  const std::string text = format_log(log);
  EXPECT_THAT(text, StartsWith("length,turn\n"));
  expect_same(parse_log(text, "again"), log);
}

TEST(LogRoundTrip, written_digits_leave_no_rounding_worth_mentioning) {
  const Log log = parse_log("u,psi\n0.5,0\n0.25,1\n", "short");
  EXPECT_GT(log.place_rounding, 1e-3);
  EXPECT_LT(parse_log(format_log(log), "long").place_rounding, 1e-16);
}

TEST(LogRoundTrip, through_a_file) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "rollfix_round_trip.csv";
  const Log log = limacon_log();
  write_log(path.string(), log);
  expect_same(read_log(path.string()), log);
  std::filesystem::remove(path);
}

TEST(LogRoundTrip, a_place_that_can_not_be_written_to_is_named) {
  try {
    write_log("no/such/folder/run.csv", limacon_log());
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no/such/folder/run.csv: can't be written"));
  }
}

TEST(LogRoundTrip, angles_that_a_reader_would_take_as_wrapped_are_not_written) {
  Log log;
  log.name = "coarse";
  log.u = {3, -1};
  log.psi = {0, 1};
  try {
    format_log(log);
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("coarse: its 2 rows are more than half a turn apart"));
  }
}

TEST(LogRoundTrip, a_million_rows_take_well_below_two_seconds) {
  std::string text = "force,u,psi,x,y\n";
  for (int k = 0; k < 1000000; ++k) {
    text += "0.10000000000000001,-13.333333333333334,7.1428571428571432,1.3333333333333333,-1.8571428571428572\n";
  }
  const auto start = std::chrono::steady_clock::now();
  const Log log = parse_log(text, "long.csv");
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(log.rows(), 1000000U);
  RecordProperty("milliseconds", static_cast<int>(1000 * seconds.count()));
#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LT(seconds.count(), 2);
#endif
}

}  // namespace
}  // namespace rollfix::log_round_trip_test
