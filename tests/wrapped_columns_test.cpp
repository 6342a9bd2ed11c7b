// Columns of angles whose rows are far apart: whether they are wrapped is asked, never guessed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "cli.hpp"
#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace rollfix::wrapped_columns_test {
namespace {

using testing::HasSubstr;

constexpr double kTurn = 2 * std::numbers::pi;

const Part& spline() {
  static const Part part(gallery("spline,n=9,seed=7,wobble=0.2"));
  return part;
}

/// What a disk of radius 0.3 feels at these distances from its first contact.
Log felt(const std::vector<double>& distances, double start = 1) {
  Log log;
  log.name = "far apart";
  for (const double distance : distances) {
    const double u = -distance / 0.3;
    log.fingers[0].u.push_back(u);
    log.fingers[0].psi.push_back(spline().turning().angle(start + distance) - spline().turning().angle(start) - u);
  }
  return log;
}

double wrapped(double angle) { return std::remainder(angle, kTurn); }

Log wrapped(Log log) {
  for (double& u : log.fingers[0].u) u = wrapped(u);
  for (double& psi : log.fingers[0].psi) psi = wrapped(psi);
  return log;
}

std::string refusal(const Log& log) {
  try {
    readings_as_given(log, {disk(0.3)});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void expect_same_readings(const Log& one, const Log& other) {
  const std::vector<Reading> a = readings_as_given(one, {disk(0.3)});
  const std::vector<Reading> b = readings_as_given(other, {disk(0.3)});
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_NEAR(a[k].length[0], b[k].length[0], 1e-12) << k;
    EXPECT_NEAR(a[k].turn, b[k].turn, 1e-12) << k;
  }
}

TEST(WrappedColumns, a_step_of_more_than_half_a_turn_is_asked_about) {
  const std::string told = refusal(felt({0, 1.2, 1.5}));  // u goes by 4 rad, then by 1
  EXPECT_THAT(told, HasSubstr("far apart, row 2: u goes from -0 to -4 in one row"));
  EXPECT_THAT(told, HasSubstr("say it with `wrapped` no, or `wrapped` yes"));
}

TEST(WrappedColumns, two_rows_more_than_half_a_turn_apart_are_asked_about) {
  EXPECT_THAT(refusal(felt({0, 1.2})), HasSubstr("can't be told"));
  EXPECT_EQ(refusal(felt({0, 0.9})), "");  // 3 rad: the nearer way
}

TEST(WrappedColumns, what_is_said_is_done) {
  Log log = felt({0, 1.2, 1.5});
  log.fingers[0].u_wrapped = log.fingers[0].psi_wrapped = false;
  const std::vector<Reading> as_written = readings_as_given(log, {disk(0.3)});
  EXPECT_NEAR(as_written.back().length[0], 1.5, 1e-12);
  log.fingers[0].u_wrapped = log.fingers[0].psi_wrapped = true;
  const std::vector<Reading> taken_back = readings_as_given(log, {disk(0.3)});
  EXPECT_NEAR(taken_back[1].length[0], 1.2 - kTurn * 0.3, 1e-12);
}

TEST(WrappedColumns, a_roll_one_way_through_less_than_a_turn_is_never_taken_back_in_silence) {
  std::mt19937_64 generator = test_generator(71);
  std::exponential_distribution<double> step(0.7);
  for (int k = 0; k < test_count(2000); ++k) {
    std::vector<double> distances{0};
    while (distances.size() < 7 && distances.back() < 0.3 * kTurn)
      distances.push_back(distances.back() + 0.3 * step(generator));
    const Log log = felt(distances);
    if (!refusal(log).empty()) continue;
    EXPECT_NEAR(readings_as_given(log, {disk(0.3)}).back().length[0], distances.back(), 1e-12);
  }
}

TEST(WrappedColumns, rows_that_are_near_together_show_by_themselves_where_they_are_wrapped) {
  std::mt19937_64 generator = test_generator(72);
  std::uniform_real_distribution<double> length(0.5, 6);
  for (int k = 0; k < test_count(200); ++k) {
    const double whole = (k % 2 == 0 ? 1 : -1) * length(generator);
    std::vector<double> distances;
    for (int row = 0; row <= 60; ++row) {
      const double way = row / 60.0;
      distances.push_back(whole * (k % 3 == 0 ? std::sin(std::numbers::pi * way) : way));
    }
    const Log log = felt(distances, 0.1 * k);
    expect_same_readings(wrapped(log), log);
  }
}

TEST(WrappedColumns, among_many_rows_near_together_a_step_to_and_fro_leaves_no_doubt) {
  std::vector<double> angles;
  for (int row = 0; row < 156; ++row) angles.push_back(0.02 * row);
  // Back a little, over half a turn by more than any other step, and back a little.
  for (const double angle : {3.12, 3.11, 3.145, 3.142}) angles.push_back(angle);
  std::vector<double> distances;
  for (const double angle : angles) distances.push_back(0.3 * angle);
  const Log log = felt(distances);
  expect_same_readings(wrapped(log), log);
}

TEST(WrappedColumns, columns_say_it_in_the_options) {
  const std::string text = "skin,psi\n0,0\n-4,4.5\n-5,5\n";
  const Log one = parse_log(text, "log", {parse_columns("u=skin:unwrapped,psi=psi:rad:unwrapped")});
  EXPECT_EQ(one.fingers[0].u_wrapped, std::optional<bool>(false));
  EXPECT_EQ(one.fingers[0].psi_wrapped, std::optional<bool>(false));
  const Log degrees = parse_log(text, "log", {parse_columns("u=skin:deg:wrapped")});
  EXPECT_EQ(degrees.fingers[0].u_wrapped, std::optional<bool>(true));
  EXPECT_NEAR(degrees.fingers[0].u[1], -4 * kTurn / 360, 1e-15);
  LogOptions all;
  all.wrapped = false;
  EXPECT_EQ(parse_log("u,psi\n0,0\n1,1\n", "log", all).fingers[0].psi_wrapped, std::optional<bool>(false));
}

TEST(WrappedColumns, the_program_asks_and_takes_the_answer) {
  const cli::Folder folder;
  folder.write("coarse.csv", "u,psi\n0,0\n-4,4.5\n-5,5.7\n");
  const std::string words = "locate gallery:circle,r=2 --log coarse.csv --finger disk,r=0.3";
  const cli::Ran asked = cli::run(words);
  EXPECT_EQ(asked.code, 2);
  EXPECT_THAT(asked.err, HasSubstr("coarse.csv:3: u goes from 0 to -4 in one row"));
  EXPECT_THAT(asked.err, HasSubstr("say it with --wrapped no, or --wrapped yes"));
  EXPECT_THAT(cli::run(words + " --wrapped no").err, testing::Not(HasSubstr("can't be told")));
  EXPECT_THAT(cli::run(words + " --wrapped perhaps").err, HasSubstr("--wrapped perhaps: expected yes or no"));
}

}  // namespace
}  // namespace rollfix::wrapped_columns_test
