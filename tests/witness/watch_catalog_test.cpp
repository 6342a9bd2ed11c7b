// rollfix watch --catalog: which part a finger rolls on, while it rolls.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <sstream>

#include "catalogs.hpp"

namespace watch_catalog_test {
namespace {

using cli::Json;
using cli::run;
using testing::HasSubstr;

const std::string kRoll = " --finger disk,r=0.1 --noise contact=0.001,angle=0.1deg";

class WatchCatalog : public testing::Test {
 protected:
  WatchCatalog() {
    catalogs::of(catalogs::mixed_shapes(27));
    roll_on("gallery:spline,n=9,wobble=0.2,seed=7");
  }

  static void roll_on(const std::string& part) {
    run("simulate " + part + " --start 0.8 --length 2.5 --samples 120 --seed 5 --force -o roll.csv" + kRoll);
  }
  /// What was printed while it was read once.
  static std::vector<Json> events(const std::string& options = "") {
    std::vector<Json> all;
    std::istringstream lines(run("watch --catalog parts.db --log roll.csv --once --jsonl" + kRoll + options).out);
    for (std::string line; std::getline(lines, line);) all.push_back(Json::parse(line));
    return all;
  }
  static std::vector<Json> named(const char* name, const std::vector<Json>& events) {
    std::vector<Json> some;
    for (const Json& event : events) {
      if (event["event"] == name) some.push_back(event);
    }
    return some;
  }

  cli::Folder folder_;
};

TEST_F(WatchCatalog, ends_with_the_part_that_was_rolled_on) {
  const Json over = named("over", events()).at(0);
  EXPECT_EQ(over["verdict"], "unique part, unique place");
  EXPECT_EQ(over["parts"][0]["name"], "spline,n=9,wobble=0.2,seed=7");
  EXPECT_NEAR(over["parts"][0]["placements"][0]["start"][0].get<double>(), 0.8, 0.02);
}

TEST_F(WatchCatalog, says_in_the_end_what_identify_says) {
  const Json over = named("over", events()).at(0);
  const Json found = run("identify parts.db --json --log roll.csv" + kRoll).json();
  EXPECT_EQ(over["parts"].size(), found["parts"].size());
  EXPECT_NEAR(over["parts"][0]["probability"].get<double>(), found["parts"][0]["probability"].get<double>(), 1e-9);
}

TEST_F(WatchCatalog, tells_of_fewer_and_fewer_parts) {
  std::vector<std::size_t> left;
  for (const Json& event : named("placements", events())) left.push_back(event["left"].get<std::size_t>());
  ASSERT_GT(left.size(), 2U);
  EXPECT_TRUE(std::is_sorted(left.rbegin(), left.rend()));
  EXPECT_LT(left.back(), left.front());
}

TEST_F(WatchCatalog, takes_a_pivot_in_a_corner_for_no_jump_whatever_part_comes_first) {
  std::ofstream log("roll.csv");
  log << "length,turn\n";
  for (int k = 0; k <= 250; ++k) log << 0.01 * k << "," << (k < 61 ? 0 : k < 202 ? 0.5 : 1) * std::numbers::pi << "\n";
  log.close();
  const Json over = named("over", events()).at(0);
  EXPECT_EQ(over["why"], "ended");
  EXPECT_EQ(over["parts"][0]["name"], "polygon,n=4");
}

TEST_F(WatchCatalog, of_none_that_fits_says_so_by_its_exit_code) {
  roll_on("gallery:spline,n=12,wobble=0.3,seed=99");
  EXPECT_EQ(run("watch --catalog parts.db --log roll.csv --once" + kRoll).code, 1);
}

TEST_F(WatchCatalog, prints_a_table_for_people) {
  const std::string text = run("watch --catalog parts.db --log roll.csv --once" + kRoll).out;
  EXPECT_THAT(text, HasSubstr("catalog  parts.db, 40 parts"));
  EXPECT_THAT(text, HasSubstr("roll 1 was on spline,n=9,wobble=0.2,seed=7, from s = 0."));
}

TEST_F(WatchCatalog, asks_one_question) {
  EXPECT_THAT(run("watch gallery:cam --catalog parts.db --log roll.csv" + kRoll).err, HasSubstr("found both"));
  EXPECT_THAT(run("watch --log roll.csv" + kRoll).err, HasSubstr("found neither"));
  EXPECT_THAT(run("watch --catalog parts.db --log roll.csv --prior 1,0.1" + kRoll).err, HasSubstr("--prior"));
  EXPECT_THAT(run("watch --catalog parts.db --unit mm --log roll.csv" + kRoll).err, HasSubstr("leave --corner-angle"));
}

}  // namespace
}  // namespace watch_catalog_test
