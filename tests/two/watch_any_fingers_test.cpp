// Fingers with corners, and a jaw beside a wheel without skin, watched while their logs grow.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "../cli.hpp"

namespace watch_any_fingers_test {
namespace {

using cli::Json;
using cli::Ran;
using cli::run;
using testing::HasSubstr;
using testing::Not;

using Lines = std::vector<std::string>;

Lines lines_of(const std::string& file) {
  Lines lines;
  std::istringstream text(cli::read(file));
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

void write(const std::string& file, const Lines& lines) {
  std::ofstream out(file);
  for (const std::string& line : lines) out << line << '\n';
}

/// Rows `from` to before `to` of a log, under its header.
void cut(const std::string& file, std::size_t from, std::size_t to) {
  Lines lines = lines_of(file);
  lines.resize(to + 1);
  lines.erase(lines.begin() + 1, lines.begin() + 1 + static_cast<long>(from));
  write(file, lines);
}

std::vector<Json> events(const Ran& ran) {
  std::vector<Json> all;
  std::istringstream lines(ran.out);
  for (std::string line; std::getline(lines, line);) all.push_back(Json::parse(line));
  return all;
}

Json last(const Ran& ran, const std::string& name) {
  Json found;
  for (const Json& one : events(ran)) {
    if (one["event"] == name) found = one;
  }
  return found;
}

Ran watch(const std::string& asked) { return run("watch gallery:cam --once --every 20 --jsonl " + asked); }

/// The last answer is, to the bit, what `locate` says of the same logs.
void expect_as_located(const std::string& asked) {
  const Ran watched = watch(asked);
  ASSERT_EQ(watched.code, 0) << watched.err;
  const Json over = last(watched, "over");
  const Json located = run("locate gallery:cam --json " + asked).json();
  EXPECT_EQ(over["verdict"], located["verdict"]);
  ASSERT_EQ(over["placements"].size(), located["placements"].size());
  for (std::size_t k = 0; k < over["placements"].size(); ++k) {
    for (const auto& [field, value] : over["placements"][k].items()) {
      EXPECT_EQ(value, located["placements"][k][field]) << field;
    }
  }
}

const std::string kTip = "--finger tip.csv,polygon ";
const std::string kNoise = "--noise contact=0.003,angle=0.1deg ";
const std::string kOne = kTip + kNoise + "--log one.csv";
const std::string kTwo = kTip + "--finger disk,r=0.3 " + kNoise + "--log a.csv --log b.csv";

/// one.csv: a fingertip over its corners, on one of which it is in rows 3 to 19.
void roll_tip(std::size_t samples = 61, const std::string& noise = kNoise) {
  write("tip.csv", {"0 0", "0.2 0", "0.2 0.4", "-0.2 0.4", "-0.2 0"});
  ASSERT_EQ(run(fmt::format("simulate gallery:cam {}--start 2 --length 1.2 --samples {} {}-o one.csv", kTip, samples,
                            noise.empty() ? "" : noise + "--seed 1 "))
                .code,
            0);
}

void roll_tip_and_disk() {
  roll_tip();
  ASSERT_EQ(run("simulate gallery:cam " + kTip + "--finger disk,r=0.3 --start 2 --start 5.5 --length 1.2 --length -1 " +
                "--samples 61 " + kNoise + "--seed 1 -o a.csv -o b.csv")
                .code,
            0);
}

const std::string kRigNoise = "--noise contact=0.01,angle=0.3deg,position=0.01 ";
const std::string kJawAndPin = "--finger jaw --finger wheel,r=0.4 " + kRigNoise + "--log jaw.csv --log pin.csv";

/// jaw.csv and pin.csv of the rig of docs/rig.md.
void roll_rig(const std::string& wheel = "pin", const std::string& more = "") {
  ASSERT_EQ(run("simulate gallery:cam --finger jaw --finger wheel,r=0.4 --start 3.9 --start 2 --pin 0.25,-0.1 "
                "--jaw-rotation 30deg --samples 15 --seed 3 --wheel " +
                wheel + " " + kRigNoise + more + " --force -o jaw.csv -o pin.csv")
                .code,
            0);
}

/// contact 0 in these rows.
void lose_contact(const std::string& file, std::size_t from, std::size_t to) {
  Lines lines = lines_of(file);
  lines[0] += ",contact";
  for (std::size_t k = 1; k < lines.size(); ++k) lines[k] += k > from && k <= to ? ",0" : ",1";
  write(file, lines);
}

}  // namespace

TEST(WatchAnyFingers, a_fingertip_with_corners_ends_as_locate_says) {
  const cli::Folder folder;
  roll_tip();
  expect_as_located(kOne);
}

TEST(WatchAnyFingers, a_roll_that_begins_or_ends_on_a_corner_ends_as_locate_says) {
  const cli::Folder folder;
  roll_tip();
  cut("one.csv", 15, 56);
  expect_as_located(kOne);
  expect_as_located(kOne + " --prior 2.5,0.5");
}

TEST(WatchAnyFingers, a_fingertip_beside_a_disk_ends_as_locate_says) {
  const cli::Folder folder;
  roll_tip_and_disk();
  expect_as_located(kTwo);
  for (const std::string file : {"a.csv", "b.csv"}) cut(file, 15, 56);
  expect_as_located(kTwo);
}

TEST(WatchAnyFingers, digits_coarser_than_the_noise_leave_more_rows_on_corners_as_in_locate) {
  const cli::Folder folder;
  roll_tip(61, "");
  Lines lines = lines_of("one.csv");
  for (std::size_t k = 1; k < lines.size(); ++k) {
    std::istringstream cells(lines[k]);
    std::vector<double> number;
    for (std::string cell; std::getline(cells, cell, ',');) number.push_back(std::stod(cell));
    lines[k] = fmt::format("{:.6f},{:.2f},{:.6f}", number[0], number[1], number[2]);
  }
  write("one.csv", lines);
  Lines header = lines_of("one.csv");
  header[0] = "time,u,psi";
  write("one.csv", header);
  expect_as_located(kTip + "--noise contact=0.0005,angle=1deg --log one.csv");
}

TEST(WatchAnyFingers, before_the_first_row_off_the_corners_every_place_fits) {
  const cli::Folder folder;
  roll_tip();
  cut("one.csv", 5, 18);
  const Json over = last(watch(kOne), "over");
  EXPECT_EQ(over["verdict"], "unobservable");
  EXPECT_TRUE(over["reading"].contains("pivot"));
}

// Of a roll of more than 4,096 rows all are weighed as they come, and none of them again.
TEST(WatchAnyFingers, a_long_roll_that_begins_and_ends_on_corners_is_told_from_end_to_end) {
  const cli::Folder folder;
  roll_tip(6001, "--noise contact=0.01,angle=0.5deg ");
  cut("one.csv", 1000, 5600);
  const std::string asked = kTip + "--noise contact=0.01,angle=0.5deg --log one.csv";
  const Json watched = last(watch(asked), "over")["placements"][0];
  const Json located = run("locate gallery:cam --json " + asked).json()["placements"][0];
  const double sd = located["sd"][0];
  for (const char* field : {"start", "mean", "end_mean"}) {
    EXPECT_NEAR(watched[field][0].get<double>(), located[field][0].get<double>(), 0.1 * sd) << field;
  }
  for (const char* field : {"sd", "end_sd"}) {
    EXPECT_NEAR(watched[field][0].get<double>(), located[field][0].get<double>(), 0.1 * sd) << field;
  }
}

TEST(WatchAnyFingers, a_jaw_beside_a_wheel_ends_as_locate_says) {
  const cli::Folder folder;
  roll_rig();
  expect_as_located(kJawAndPin);
  roll_rig("encoder");
  expect_as_located(kJawAndPin);
}

TEST(WatchAnyFingers, a_squeezed_rig_and_a_part_face_down_end_as_locate_says) {
  const cli::Folder folder;
  roll_rig();
  expect_as_located(kJawAndPin + " --squeezed=60deg");
  roll_rig("pin", "--mirror");
  expect_as_located(kJawAndPin + " --mirror");
}

TEST(WatchAnyFingers, people_read_the_places_of_both_and_the_parts_pose) {
  const cli::Folder folder;
  roll_rig();
  const Ran text = run("watch gallery:cam --once --every 10 " + kJawAndPin);
  EXPECT_THAT(text.out, HasSubstr("start a     start b"));
  EXPECT_THAT(text.out, HasSubstr("at the last at x = "));
  EXPECT_THAT(text.out, Not(HasSubstr("nan")));
}

TEST(WatchAnyFingers, contact_that_both_lose_and_find_makes_two_rolls_beside_a_wheel) {
  const cli::Folder folder;
  roll_rig();
  for (const std::string file : {"jaw.csv", "pin.csv"}) lose_contact(file, 7, 8);
  const Ran watched = watch(kJawAndPin);
  EXPECT_EQ(last(watched, "end")["counts"]["rolls"], 2);
  EXPECT_EQ(last(watched, "over")["samples"], 7);
}

TEST(WatchAnyFingers, what_is_not_taken_beside_a_wheel_is_refused_before_a_row_comes) {
  const cli::Folder folder;
  roll_rig();
  const auto refusal = [](const std::string& asked) {
    const Ran ran = run("watch gallery:cam --once " + asked);
    EXPECT_EQ(ran.code, 2);
    EXPECT_EQ(ran.out, "");
    return ran.err;
  };
  EXPECT_THAT(refusal(kJawAndPin + " --prior 1,0.1"), HasSubstr("prior is not taken beside a wheel"));
  EXPECT_THAT(refusal(kJawAndPin + " --robust"), HasSubstr("robust is not taken beside a wheel"));
  EXPECT_THAT(refusal("--finger jaw --finger wheel,r=0.4 --log jaw.csv " + kRigNoise), HasSubstr("with a log of each"));
  EXPECT_THAT(refusal("--finger wheel,r=0.4 --log pin.csv " + kRigNoise), HasSubstr("one finger with skin"));
  EXPECT_THAT(refusal("--finger jaw --finger wheel,r=0.4 --log jaw.csv --log pin.csv --noise contact=0.01,angle=0.01"),
              HasSubstr("position=SD beside a wheel"));
  EXPECT_THAT(refusal("--finger jaw --log jaw.csv --squeezed " + kRigNoise), HasSubstr("--squeezed"));
}

TEST(WatchAnyFingers, a_jaw_of_which_it_is_not_known_where_it_is_says_nothing_beside_a_wheel) {
  const cli::Folder folder;
  roll_rig();
  Lines lines = lines_of("jaw.csv");
  for (std::string& line : lines) line = line.substr(0, line.rfind(',', line.rfind(',') - 1));
  write("jaw.csv", lines);
  const Ran watched = watch(kJawAndPin);
  EXPECT_EQ(watched.code, 2);
  EXPECT_THAT(watched.err, HasSubstr("any place on the part fits"));
}

}  // namespace watch_any_fingers_test
