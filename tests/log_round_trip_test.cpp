// What is written is what is read: bit for bit.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "free_roll.hpp"
#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"

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
  ASSERT_EQ(a.fingers.size(), b.fingers.size());
  for (std::size_t k = 0; k < a.fingers.size(); ++k) {
    for (const auto& column :
         {&FingerRows::u, &FingerRows::psi, &FingerRows::length, &FingerRows::turn, &FingerRows::x, &FingerRows::y}) {
      EXPECT_EQ(bits_of(a.fingers[k].*column), bits_of(b.fingers[k].*column));
    }
  }
}

Log limacon_log() {
  RollPlan plan;
  plan.start = 0.3;
  plan.distance = -7;
  return roll(Part(gallery("limacon")), {0.1}, plan).log;
}

Log limacon_log_of_two() {
  return roll_free(free_rolls::part_of("limacon"), free_rolls::by_distances(0.1, 0.3, 3, 0.05, 4, -2, 1)).log;
}

std::string in_test_folder(const char* name) { return (std::filesystem::path(testing::TempDir()) / name).string(); }

TEST(LogRoundTrip, a_roll_of_one_finger_or_two_comes_back_bit_for_bit) {
  for (const Log& log : {limacon_log(), limacon_log_of_two()}) {
    const std::string text = format_log(log);
    EXPECT_THAT(text,
                StartsWith(log.fingers.size() == 1 ? "time,u,psi,x,y\n0.0000000000000000,"
                                                   : "time,u_a,psi_a,x_a,y_a,u_b,psi_b,x_b,y_b\n0.0000000000000000,"));
    expect_same(parse_log(text, "again"), log);
    EXPECT_EQ(format_log(parse_log(text, "again")), text);
  }
}

TEST(LogRoundTrip, random_numbers_of_any_size_come_back_bit_for_bit) {
  std::mt19937_64 generator = test_generator(41);
  std::normal_distribution<double> mantissa;
  std::uniform_int_distribution<int> exponent(-280, 280);
  for (const std::size_t fingers : {1U, 2U}) {
    Log log;
    log.kind = LogKind::travelled;
    log.fingers.resize(fingers);
    for (int k = 0; k < test_count(2000); ++k) {
      for (FingerRows& rows : log.fingers) {
        rows.length.push_back(std::ldexp(mantissa(generator), exponent(generator)));
        rows.turn.push_back(mantissa(generator));
      }
    }
    const std::string text = format_log(log);
    EXPECT_THAT(text, StartsWith(fingers == 1 ? "length,turn\n" : "length_a,turn_a,length_b,turn_b\n"));
    expect_same(parse_log(text, "again"), log);
  }
}

/// Steps to and fro, so that sums come close to 0 and need more digits than a step has.
std::string written_steps(std::size_t fingers, int rows) {
  std::mt19937_64 generator = test_generator(42);
  std::normal_distribution<double> step;
  std::string text = fingers == 1 ? "distance,dturn\n" : "distance_a,dturn_a,distance_b,dturn_b\n";
  for (int row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < 2 * fingers; ++k) {
      text += fmt::format("{}{:#.17g}", k == 0 ? "" : ",", step(generator));
    }
    text += '\n';
  }
  return text;
}

TEST(LogRoundTrip, increments_stay_increments_and_keep_their_bits) {
  for (const std::size_t fingers : {1U, 2U}) {
    const std::string text = written_steps(fingers, 500);
    const Log log = parse_log(text, "steps");
    EXPECT_EQ(format_log(log), text);
    const Log again = parse_log(format_log(log), "again");
    EXPECT_EQ(again.kind, LogKind::increments);
    expect_same(again, log);
  }
}

TEST(LogRoundTrip, a_wheel_and_a_gyroscope_come_back_bit_for_bit) {
  const Noise noise{.contact = 0.01, .angle = 0.01};
  const Log log = noisy_increments(Part(gallery("ellipse")), 1, 3, 300, noise, 5).log;
  const Log again = parse_log(format_log(log), "again");
  EXPECT_EQ(again.kind, LogKind::increments);
  expect_same(again, log);
}

TEST(LogRoundTrip, a_later_roll_of_increments_is_measured_from_its_own_first_contact_once_more) {
  const std::vector<Log> rolls =
      parse_rolls("contact,distance,dturn\n1,0.1,0.2\n1,0.3,0.1\n0,5,5\n1,7,7\n1,0.25,0.5\n1,0.1,0.1\n", "two rolls");
  ASSERT_EQ(rolls.size(), 2U);
  EXPECT_EQ(rolls[1].fingers[0].length, (std::vector<double>{0, 0.25, 0.35}));
  expect_same(parse_log(format_log(rolls[1]), "again"), rolls[1]);
}

TEST(LogRoundTrip, sums_that_were_made_without_increments_come_back_to_rounding) {
  Log log;
  log.kind = LogKind::increments;
  log.fingers[0].length = {0.1, 0.3, -1e-3, 1000};
  log.fingers[0].turn = {0.5, -0.2, 0.7, 0.1};
  const Log again = parse_log(format_log(log), "again");
  EXPECT_EQ(again.kind, LogKind::increments);
  for (std::size_t row = 0; row < 4; ++row) {
    EXPECT_NEAR(again.fingers[0].length[row], log.fingers[0].length[row],
                1e-16 + 1e-16 * std::abs(log.fingers[0].length[row]));
    EXPECT_NEAR(again.fingers[0].turn[row], log.fingers[0].turn[row], 2e-16);
  }
}

TEST(LogRoundTrip, two_fingers_through_one_file_and_through_two) {
  const Log log = limacon_log_of_two();
  const std::string both = in_test_folder("rollfix_pair_both.csv");
  const std::string a = in_test_folder("rollfix_pair_a.csv");
  const std::string b = in_test_folder("rollfix_pair_b.csv");
  write_log(both, log);
  write_log(a, one_finger(log, 0));
  write_log(b, one_finger(log, 1));
  expect_same(read_log(both), log);
  expect_same(read_log(a, b), log);
  for (const std::string& path : {both, a, b}) std::filesystem::remove(path);
}

TEST(LogRoundTrip, a_reader_finds_out_how_many_fingers_a_file_is_of) {
  const Log log = limacon_log_of_two();
  EXPECT_EQ(parse_log(format_log(log), "both").fingers.size(), 2U);
  EXPECT_EQ(parse_log(format_log(one_finger(log, 1)), "one").fingers.size(), 1U);
  EXPECT_EQ(parse_log("u,psi,u_b\n0,0,x\n1,1,x\n", "one with a stranger").fingers.size(), 1U);
}

TEST(LogRoundTrip, written_digits_leave_no_rounding_worth_mentioning) {
  const Log log = parse_log("u,psi\n0.5,0\n0.25,1\n", "short");
  EXPECT_GT(log.fingers[0].place_rounding, 1e-3);
  EXPECT_LT(parse_log(format_log(log), "long").fingers[0].place_rounding, 1e-16);
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
  log.fingers[0].u = {3, -1};
  log.fingers[0].psi = {0, 1};
  try {
    format_log(log);
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("coarse: its 2 rows are more than half a turn apart"));
  }
}

TEST(LogRoundTrip, a_million_rows_are_read) {
  std::string text = "force,u,psi,x,y\n";
  for (int k = 0; k < 1000000; ++k) {
    text += "0.10000000000000001,-13.333333333333334,7.1428571428571432,1.3333333333333333,-1.8571428571428572\n";
  }
  const Log log = parse_log(text, "long.csv");
  EXPECT_EQ(log.rows(), 1000000U);
  EXPECT_EQ(log.fingers[0].psi.back(), 7.1428571428571432);
}

}  // namespace
}  // namespace rollfix::log_round_trip_test
