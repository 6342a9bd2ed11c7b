// What is known beforehand of how the part lies, in `locate` and in `watch`: it tells places apart that the roll does
// not. The ellipse looks the same from both ends; of its two poses, half a turn apart, the prior knows which.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

#include "cli.hpp"

namespace cli_pose_prior_test {
namespace {

using cli::Json;
using cli::run;
using testing::HasSubstr;

const std::string kPart = " gallery:ellipse,a=2,b=1 --finger disk,r=0.2 --noise contact=0.002,angle=0.2deg ";

/// A roll from s = 1 on the ellipse, which lies turned by `heading` and moved to (x, y); also face down.
void write_roll(const cli::Folder& folder, double heading, double x, double y, bool face_down = false) {
  ASSERT_EQ(run("simulate gallery:ellipse,a=2,b=1 --finger disk,r=0.2 --start 1 --length 2 -o at-rest.csv" +
                std::string(face_down ? " --mirror" : ""))
                .code,
            0);
  std::istringstream rows(cli::read("at-rest.csv"));
  std::string line;
  std::getline(rows, line);
  ASSERT_THAT(line, HasSubstr("time,u,psi,x,y"));
  std::string moved = "time,u,psi,x,y\n";
  while (std::getline(rows, line)) {
    std::istringstream cells(line);
    double time = 0;
    double u = 0;
    double psi = 0;
    double at_x = 0;
    double at_y = 0;
    char comma = 0;
    cells >> time >> comma >> u >> comma >> psi >> comma >> at_x >> comma >> at_y;
    moved +=
        fmt::format("{},{},{},{},{}\n", time, u, psi + heading, x + std::cos(heading) * at_x - std::sin(heading) * at_y,
                    y + std::sin(heading) * at_x + std::cos(heading) * at_y);
  }
  folder.write("roll.csv", moved);
}

/// The last of what watch says, as JSON.
Json watched(const std::string& options) {
  std::istringstream lines(run("watch" + kPart + "--log roll.csv --once --jsonl " + options).out);
  std::string line;
  Json over;
  while (std::getline(lines, line)) {
    const Json event = Json::parse(line);
    if (event["event"] == "over") over = event;
  }
  return over;
}

TEST(CliPosePrior, watch_tells_the_ends_of_an_ellipse_apart_as_locate_does) {
  const cli::Folder folder;
  write_roll(folder, 0.5, 10, 20);
  EXPECT_EQ(watched("")["verdict"], "ambiguous (2)");
  const double half = run("inspect gallery:ellipse,a=2,b=1 --json").json()["part"]["perimeter"].get<double>() / 2;
  for (const std::string prior : {"--heading 0.5,5deg", "--pose 10,20,0.5,0.1,5deg"}) {
    const Json found = watched(prior);
    EXPECT_EQ(found["verdict"], "unique") << prior;
    EXPECT_NEAR(found["placements"][0]["start"][0], 1, 0.02) << prior;
    const Json located = run("locate" + kPart + "--log roll.csv --json " + prior).json();
    EXPECT_EQ(located["verdict"], "unique") << prior;
    EXPECT_NEAR(located["placements"][0]["start"][0], 1, 0.02) << prior;
  }
  EXPECT_NEAR(watched("--heading -2.64,5deg")["placements"][0]["start"][0], 1 + half, 0.02);
}

TEST(CliPosePrior, of_a_part_face_down_it_is_of_the_pose_that_is_told) {
  const cli::Folder folder;
  write_roll(folder, 0.5, 10, 20, true);
  const std::string prior = " --mirror --pose 10,20,0.5,0.1,5deg ";
  const Json found = watched(prior);
  EXPECT_EQ(found["verdict"], "unique");
  EXPECT_NEAR(found["placements"][0]["start"][0], 1, 0.02);
  const Json located = run("locate" + kPart + "--log roll.csv --json" + prior).json();
  EXPECT_EQ(located["verdict"], "unique");
  EXPECT_NEAR(located["placements"][0]["pose_mean"][2], 0.5, 0.02);
  EXPECT_NEAR(located["pose_prior"]["heading"], 0.5, 1e-12);
}

TEST(CliPosePrior, is_shown_with_the_answer) {
  const cli::Folder folder;
  write_roll(folder, 0.5, 10, 20);
  const std::string locate = "locate" + kPart + "--log roll.csv ";
  EXPECT_THAT(run(locate + "--heading 30deg,5deg").out,
              HasSubstr("\nprior      the part's heading 30.000 deg, sd 5 deg\n"));
  EXPECT_THAT(run(locate + "--pose 10,20,30deg,0.1,5deg").out,
              HasSubstr("\nprior      the part at x = 10, y = 20, sd 0.1, heading 30.000 deg, sd 5 deg\n"));
  const Json heading = run(locate + "--json --heading 0.5,0.1").json()["pose_prior"];
  EXPECT_EQ(heading,
            (Json{{"x", nullptr}, {"y", nullptr}, {"heading", 0.5}, {"place_sd", nullptr}, {"heading_sd", 0.1}}));
  EXPECT_TRUE(run(locate + "--json").json()["pose_prior"].is_null());
}

TEST(CliPosePrior, and_centres_need_a_log_that_has_them) {
  const cli::Folder folder;
  folder.write("roll.csv", "u,psi\n0,0\n-0.1,0.2\n-0.2,0.4\n");
  EXPECT_THAT(run("watch" + kPart + "--log roll.csv --once --pose 0,0,0,0.1,5deg").err, HasSubstr("columns x and y"));
  EXPECT_THAT(run("watch gallery:cam --finger disk,r=0.2 --noise angle=0.01,position=0.01 --log roll.csv --once").err,
              HasSubstr("columns x and y"));
  folder.write("track.csv", "length,turn\n0.1,0.1\n0.2,0.2\n");
  EXPECT_THAT(run("watch gallery:cam --noise angle=0.01 --log track.csv --once --heading 0,5deg").err,
              HasSubstr("by u and psi"));
  EXPECT_THAT(run("locate gallery:cam --finger disk,r=0.2 --log roll.csv --heading 0,5deg").err,
              HasSubstr("--heading is weighed against noisy rows: give --noise as well"));
}

TEST(CliPosePrior, centres_count_in_watch_as_they_do_in_locate) {
  const cli::Folder folder;
  write_roll(folder, 0.5, 10, 20);
  const std::string noise = " gallery:ellipse,a=2,b=1 --finger disk,r=0.2 --log roll.csv --heading 0.5,5deg --noise ";
  const auto sd = [&](const std::string& kinds) {
    std::istringstream lines(run("watch" + noise + kinds + " --once --jsonl").out);
    std::string line;
    double last = 0;
    while (std::getline(lines, line)) {
      const Json event = Json::parse(line);
      if (event["event"] == "over") last = event["placements"][0]["sd"][0];
    }
    return last;
  };
  const std::string rows = "contact=0.02,angle=2deg";
  const double located = run("locate" + noise + rows + ",position=0.001 --json").json()["placements"][0]["sd"][0];
  EXPECT_NEAR(sd(rows + ",position=0.001"), located, 1e-9 * located);
  EXPECT_LT(sd(rows + ",position=0.001"), 0.8 * sd(rows));
}

}  // namespace
}  // namespace cli_pose_prior_test
