// Two fingers' logs: what is written is what is read, bit for bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "free_roll.hpp"
#include "random.hpp"
#include "rollfix/contact/pair_log.hpp"

namespace rollfix::pair_log_round_trip_test {
namespace {

using testing::StartsWith;

std::vector<std::uint64_t> bits_of(const std::vector<double>& values) {
  std::vector<std::uint64_t> bits;
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  return bits;
}

void expect_same(const PairLog& one, const PairLog& two) {
  for (const auto& log : {&PairLog::a, &PairLog::b}) {
    for (const auto& column : {&Log::time, &Log::u, &Log::psi, &Log::length, &Log::turn, &Log::x, &Log::y}) {
      EXPECT_EQ(bits_of(one.*log.*column), bits_of(two.*log.*column));
    }
  }
}

PairLog limacon_log() {
  return roll_free(free_rolls::part_of("limacon"), free_rolls::by_distances(0.1, 0.3, 3, 0.05, 4, -2, 1)).log;
}

std::string in_test_folder(const char* name) { return (std::filesystem::path(testing::TempDir()) / name).string(); }

TEST(PairLogRoundTrip, one_file_comes_back_bit_for_bit) {
  const PairLog log = limacon_log();
  const std::string text = format_pair_log(log);
  EXPECT_THAT(text, StartsWith("time,u_a,psi_a,x_a,y_a,u_b,psi_b,x_b,y_b\n0.0000000000000000,"));
  expect_same(parse_pair_log(text, "again"), log);
  EXPECT_EQ(format_pair_log(parse_pair_log(text, "again")), text);
}

TEST(PairLogRoundTrip, through_one_file_and_through_two) {
  const PairLog log = limacon_log();
  const std::string both = in_test_folder("rollfix_pair_both.csv");
  const std::string a = in_test_folder("rollfix_pair_a.csv");
  const std::string b = in_test_folder("rollfix_pair_b.csv");
  write_pair_log(both, log);
  write_log(a, log.a);
  write_log(b, log.b);
  expect_same(read_pair_log(both), log);
  expect_same(read_pair_log(a, b), log);
  for (const std::string& path : {both, a, b}) std::filesystem::remove(path);
}

TEST(PairLogRoundTrip, random_lengths_and_turns_come_back_bit_for_bit) {
  std::mt19937_64 generator = test_generator(72);
  std::normal_distribution<double> number;
  PairLog log;
  for (Log* one : {&log.a, &log.b}) {
    one->kind = LogKind::travelled;
    for (int k = 0; k < test_count(500); ++k) {
      one->length.push_back(number(generator));
      one->turn.push_back(number(generator));
    }
  }
  const std::string text = format_pair_log(log);
  EXPECT_THAT(text, StartsWith("length_a,turn_a,length_b,turn_b\n"));
  expect_same(parse_pair_log(text, "again"), log);
}

TEST(PairLogRoundTrip, a_reader_finds_out_how_many_fingers_a_file_is_of) {
  const PairLog log = limacon_log();
  EXPECT_EQ(parse_logs(format_pair_log(log), "both").size(), 2U);
  EXPECT_EQ(parse_logs(format_log(log.b), "one").size(), 1U);
  EXPECT_EQ(parse_logs("u,psi,u_b\n0,0,x\n1,1,x\n", "one with a stranger").size(), 1U);
}

}  // namespace
}  // namespace rollfix::pair_log_round_trip_test
