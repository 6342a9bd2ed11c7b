// From a simulated roll through its log back to the place where it started.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

#include "cli.hpp"

namespace cli_log_test {
namespace {

using cli::Json;
using cli::run;

/// The distance from s to the nearest start that was found, round the part.
double distance_to_nearest_start(const Json& found, double s) {
  const double P = found["part"]["perimeter"];
  double least = P;
  for (const Json& placement : found["placements"]) {
    const double gap = std::abs(std::remainder(placement["start"][0].get<double>() - s, P));
    least = std::min(least, gap);
  }
  return least;
}

/// One roll, there and back: simulated into a log, located from it.
struct RoundTrip {
  std::string part;
  double radius;
  double start;
  double length;
};

std::ostream& operator<<(std::ostream& out, const RoundTrip& trip) {
  return out << fmt::format("{} r={} start={} length={}", trip.part, trip.radius, trip.start, trip.length);
}

class LogRoundTrip : public testing::TestWithParam<RoundTrip> {};

}  // namespace

TEST_P(LogRoundTrip, finds_the_true_start_among_the_placements) {
  const cli::Folder folder;
  const RoundTrip& trip = GetParam();
  const std::string finger = fmt::format("{} --finger disk,r={}", trip.part, trip.radius);
  const cli::Ran rolled =
      run(fmt::format("simulate {} --start {} --length {} -o roll.csv", finger, trip.start, trip.length));
  ASSERT_EQ(rolled.code, 0) << rolled.err;
  const cli::Ran ran = run("locate " + finger + " --log roll.csv --json");
  ASSERT_EQ(ran.code, 0) << ran.err << ran.out;
  const Json found = ran.json();
  EXPECT_NEAR(found["readings"][0]["length"][0], trip.length, 1e-9);
  EXPECT_LT(distance_to_nearest_start(found, trip.start), 1e-7 * found["part"]["perimeter"].get<double>());
}

INSTANTIATE_TEST_SUITE_P(
    Rolls, LogRoundTrip,
    testing::Values(RoundTrip{"gallery:ellipse", 0.3, 1, 1.5}, RoundTrip{"gallery:ellipse", 0.3, 1, -1.5},
                    RoundTrip{"gallery:ellipse", 2.5, 9, 4}, RoundTrip{"gallery:limacon", 0.2, 3, 2},
                    RoundTrip{"gallery:spline,seed=3", 0.1, 0.7, 3}, RoundTrip{"gallery:spline,seed=3", 0.1, 0.7, -3},
                    RoundTrip{"gallery:spline,seed=3", 0.1, 0.7, 12},  // more than once around
                    RoundTrip{"gallery:cam", 0.5, 2, 1}, RoundTrip{"gallery:superellipse", 0.2, 1.2, 0.9},
                    RoundTrip{"gallery:gear", 0.02, 1, 0.3}, RoundTrip{"gallery:exponential", 0.4, 1, 6},
                    RoundTrip{"gallery:exponential", 0.4, 9, -6}, RoundTrip{"gallery:log-spiral", 0.1, 2, 5}));

TEST(CliLog, several_instants_of_a_log_leave_fewer_placements) {
  const cli::Folder folder;
  run("simulate gallery:spline,seed=3 --finger disk,r=0.1 --start 0.7 --length 3 --samples 31 -o roll.csv");
  const std::string locate = "locate gallery:spline,seed=3 --finger disk,r=0.1 --log roll.csv --json";
  const Json log_end = run(locate).json();
  const double last = log_end["readings"][0]["time"];
  const Json both = run(locate + fmt::format(" --at {},{}", last / 2, last)).json();
  EXPECT_EQ(both["readings"].size(), 2U);
  EXPECT_EQ(both["readings"][1], log_end["readings"][0]);
  EXPECT_EQ(both["verdict"], "unique");
  EXPECT_NEAR(both["placements"][0]["start"][0], 0.7, 1e-7);
}

TEST(CliLog, of_a_reversed_outline_counts_lengths_as_the_user_does) {
  // A right triangle, given clockwise: from (0, 0) up to (0, 3), then down the hypotenuse.
  const cli::Folder folder;
  folder.write("triangle.csv", "0 0\n0 3\n4 0\n");
  folder.write("wheel.csv", "length,turn\n3.5,-1.8\n");
  const cli::Ran ran = run("locate triangle.csv --log wheel.csv --json");
  EXPECT_EQ(ran.json()["part"]["reversed"], true);
  EXPECT_EQ(ran.json()["readings"][0]["length"][0], -3.5);
  EXPECT_EQ(ran.json()["readings"][0]["turn"], -1.8);
  EXPECT_THAT(ran.err, testing::HasSubstr("triangle.csv runs clockwise"));
  EXPECT_THAT(ran.err, testing::HasSubstr("lengths changed their signs"));
}

TEST(CliLog, is_rounded_like_its_digits) {
  const cli::Folder folder;
  folder.write("wheel.csv", "length,turn\n1.50,1.200\n");
  const Json found = run("locate gallery:ellipse,a=2,b=1 --log wheel.csv --json").json();
  EXPECT_DOUBLE_EQ(found["tolerance"], 0.0005 + 0.005 * 2);
}

TEST(CliLog, simulate_and_locate_work_in_a_pipe) {
  const std::string part = "gallery:cam --finger disk,r=0.2";
  const cli::Ran ran =
      cli::shell("rollfix simulate " + part + " --start 2 --length 1 | rollfix locate " + part + " --log - --json");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_LT(distance_to_nearest_start(ran.json(), 2), 1e-7);
}

TEST(CliLog, a_part_can_come_through_a_pipe) {
  const cli::Ran ran = cli::shell("printf '0 0\\n4 0\\n0 3\\n' | rollfix inspect - --json");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.json()["part"]["name"], "standard input");
  EXPECT_DOUBLE_EQ(ran.json()["part"]["perimeter"], 12);
  EXPECT_EQ(ran.json()["part"]["corners"], 3);
}

TEST(CliSimulate, turns_the_finger_by_the_rotation_asked_for) {
  // A disk of radius r that turns by psi on a circle of radius R travels psi / (1/r + 1/R).
  const cli::Folder folder;
  const std::string finger = "gallery:circle,r=3 --finger disk,r=1";
  run("simulate " + finger + " --start 0 --rotation 2 -o roll.csv");
  const Json found = run("locate " + finger + " --log roll.csv --json").json();
  EXPECT_NEAR(found["readings"][0]["length"][0], 2 / (1 + 1.0 / 3), 1e-10);
}

TEST(CliSimulate, starts_at_the_contact_angle_asked_for) {
  const cli::Ran ran =
      run("simulate gallery:ellipse --finger disk,r=0.3 --start 1 --length 1 --contact-angle 30deg --samples 5");
  std::istringstream lines(ran.out);
  std::string header;
  double time = 0;
  double u = 0;
  char comma = 0;
  std::getline(lines, header);
  lines >> time >> comma >> u;
  EXPECT_EQ(header, "time,u,psi,x,y");
  EXPECT_NEAR(u, 0.52359877559829887, 1e-12);
}

// --- A log of several rolls.

namespace {

/// Two rolls with the finger off the part in between, and the ground truth of where each starts.
void write_two_rolls(const cli::Folder& folder) {
  const std::string roll = "simulate gallery:spline,seed=3 --finger disk,r=0.1 --samples 40 ";
  std::string text = "u,psi,contact\n";
  for (const char* start : {"0.7", "3.5"}) {
    std::istringstream rows(run(roll + "--length 2 --start " + start).out);
    std::string row;
    std::getline(rows, row);
    while (std::getline(rows, row)) {
      const std::size_t u = row.find(',') + 1;
      const std::size_t end = row.find(',', row.find(',', u) + 1);
      text += row.substr(u, end - u) + ",1\n";
    }
    text += "0,0,0\n";
  }
  folder.write("rolls.csv", text);
}

}  // namespace

TEST(CliRolls, the_last_roll_is_taken_and_said_so) {
  const cli::Folder folder;
  write_two_rolls(folder);
  const cli::Ran ran = run("locate gallery:spline,seed=3 --finger disk,r=0.1 --log rolls.csv --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_LT(distance_to_nearest_start(ran.json(), 3.5), 1e-6);
  EXPECT_GT(distance_to_nearest_start(ran.json(), 0.7), 1e-3);
  EXPECT_THAT(ran.err, testing::HasSubstr("rolls.csv, lines 43 to 82: roll 2 of 2; --roll N takes another"));
}

TEST(CliRolls, another_is_chosen) {
  const cli::Folder folder;
  write_two_rolls(folder);
  const cli::Ran ran = run("locate gallery:spline,seed=3 --finger disk,r=0.1 --log rolls.csv --json --roll 1");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_LT(distance_to_nearest_start(ran.json(), 0.7), 1e-6);
  EXPECT_GT(distance_to_nearest_start(ran.json(), 3.5), 1e-3);
}

TEST(CliRolls, a_number_beyond_them_is_refused) {
  const cli::Folder folder;
  write_two_rolls(folder);
  const cli::Ran ran = run("locate gallery:cam --finger disk,r=0.1 --log rolls.csv --roll 3");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, testing::HasSubstr("--roll 3: rolls.csv holds 2 rolls, expected a number from 1 to 2"));
}

}  // namespace cli_log_test
