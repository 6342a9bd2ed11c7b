// Two fingers on a part that is free to move, watched while their log grows: in one log or in two.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli.hpp"

namespace watch_two_fingers_test {
namespace {

using cli::Json;
using cli::read;
using cli::run;
using testing::HasSubstr;

const std::string kPart = "gallery:spline,n=9,seed=4,wobble=0.25 ";
const std::string kHow = "--finger disk,r=0.1 --noise contact=0.003,angle=0.1deg";
const std::string kBoth = "--log both.csv " + kHow;
const std::string kTwo = "--log a.csv --log b.csv " + kHow;

/// Logs a.csv and b.csv of both fingers, and both.csv with the columns of both.
void simulate(const std::string& more = "") {
  const std::string roll = "simulate " + kPart +
                           "--finger disk,r=0.1 --start 1 --start 4.2 --length 1.3 --length -0.9 --part-rotation 20deg "
                           "--samples 40 --noise contact=0.003,angle=0.1deg --seed 1 " +
                           more;
  ASSERT_EQ(run(roll + "-o a.csv -o b.csv").code, 0);
  ASSERT_EQ(run(roll + "-o both.csv").code, 0);
}

std::vector<Json> events(const cli::Ran& ran) {
  std::vector<Json> all;
  std::istringstream lines(ran.out);
  for (std::string line; std::getline(lines, line);) all.push_back(Json::parse(line));
  return all;
}

Json event(const cli::Ran& ran, const std::string& name) {
  for (const Json& one : events(ran)) {
    if (one["event"] == name) return one;
  }
  return nullptr;
}

cli::Ran watch(const std::string& asked) { return run("watch " + kPart + "--once --every 20 --jsonl " + asked); }

/// The last answer is, to the bit, what `locate` says of the same log.
void expect_as_located(const cli::Ran& watched, const std::string& asked) {
  const Json over = event(watched, "over");
  const Json located = run("locate " + kPart + "--json " + asked).json();
  EXPECT_EQ(over["verdict"], located["verdict"]);
  ASSERT_EQ(over["placements"].size(), located["placements"].size());
  for (std::size_t k = 0; k < over["placements"].size(); ++k) {
    for (const auto& [field, value] : over["placements"][k].items()) {
      EXPECT_EQ(value, located["placements"][k][field]) << field;
    }
  }
}

std::vector<std::string> lines_of(const std::string& file) {
  std::vector<std::string> lines;
  std::istringstream text(read(file));
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

void write(const std::string& file, const std::vector<std::string>& lines) {
  std::ofstream out(file);
  for (const std::string& line : lines) out << line << '\n';
}

}  // namespace

TEST(WatchTwoFingers, says_at_the_end_what_locate_says) {
  const cli::Folder folder;
  simulate();
  expect_as_located(watch(kBoth), kBoth);
  expect_as_located(watch(kTwo), kTwo);
}

TEST(WatchTwoFingers, says_it_of_a_prior_of_centres_of_a_mirrored_part_and_robustly) {
  const cli::Folder folder;
  simulate();
  for (const std::string more : {" --prior 1,0.3", ",position=0.02", " --mirror", " --robust", " --heading 0,0.1"}) {
    expect_as_located(watch(kBoth + more), kBoth + more);
  }
}

TEST(WatchTwoFingers, tells_the_places_of_both_as_the_log_grows) {
  const cli::Folder folder;
  simulate();
  const cli::Ran watched = watch(kTwo);
  EXPECT_EQ(event(watched, "begin")["log"], Json::parse(R"(["a.csv", "b.csv"])"));
  std::size_t changes = 0;
  for (const Json& one : events(watched)) {
    if (one["event"] != "placements") continue;
    ++changes;
    EXPECT_EQ(one["reading"]["length"].size(), 2U);
    for (const Json& placement : one["placements"]) {
      EXPECT_EQ(placement["start"].size(), 2U);
      EXPECT_EQ(placement["covariance"].size(), 2U);
    }
  }
  EXPECT_EQ(changes, 2U);
  const Json best = event(watched, "over")["placements"][0];
  EXPECT_NEAR(best["mean"][0], 1, 5 * best["sd"][0].get<double>());
  EXPECT_NEAR(best["mean"][1], 4.2, 5 * best["sd"][1].get<double>());
}

TEST(WatchTwoFingers, two_logs_are_the_same_as_one_with_the_columns_of_both) {
  const cli::Folder folder;
  simulate();
  std::vector<Json> one = events(watch(kBoth));
  std::vector<Json> two = events(watch(kTwo));
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t k = 1; k + 1 < one.size(); ++k) EXPECT_EQ(one[k], two[k]);
}

TEST(WatchTwoFingers, people_read_both_places) {
  const cli::Folder folder;
  simulate();
  for (const std::string& asked : {kBoth, kTwo}) {
    const cli::Ran text = run("watch " + kPart + "--once --every 20 " + asked);
    EXPECT_THAT(text.out, HasSubstr("start a     start b"));
    EXPECT_THAT(text.out, HasSubstr("(finger a) and s = "));
  }
}

TEST(WatchTwoFingers, a_row_without_partner_is_left_out_and_told) {
  const cli::Folder folder;
  simulate();
  std::vector<std::string> b = lines_of("b.csv");
  b.erase(b.begin() + 15);
  b[25] = "not,a,row";
  write("b.csv", b);
  const cli::Ran watched = watch(kTwo);
  EXPECT_THAT(watched.err, HasSubstr("a.csv:16: b.csv has no row at the time"));
  EXPECT_EQ(event(watched, "end")["counts"]["malformed"], 3);  // and the partner of the one that can't be read
  EXPECT_EQ(event(watched, "over")["samples"], 38);
}

TEST(WatchTwoFingers, two_logs_without_times_go_together_row_by_row) {
  const cli::Folder folder;
  simulate();
  for (const std::string file : {"a.csv", "b.csv"}) {
    std::vector<std::string> lines = lines_of(file);
    for (std::string& line : lines) line = line.substr(line.find(',') + 1);
    write(file, lines);
  }
  expect_as_located(watch(kTwo), kTwo);
}

TEST(WatchTwoFingers, what_can_not_be_two_logs_is_refused) {
  const cli::Folder folder;
  simulate();
  EXPECT_THAT(watch("--log a.csv --log a.csv " + kHow).err, HasSubstr("is given twice"));
  EXPECT_THAT(watch(kTwo + " --log both.csv").err, HasSubstr("3 times"));
  EXPECT_THAT(watch("--log a.csv --log both.csv " + kHow).err, HasSubstr("both.csv: this log is of two fingers"));
  EXPECT_THAT(watch("--log a.csv --finger disk,r=0.2 " + kHow).err, HasSubstr("found the shapes of 2"));
}

}  // namespace watch_two_fingers_test
