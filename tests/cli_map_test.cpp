// Points of the part's frame in the world.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "cli.hpp"

namespace cli_map_test {
namespace {

using cli::run;
using testing::HasSubstr;
using testing::StartsWith;

struct MappedPoint {
  int placement = 0;
  std::string set;
  double x = 0;
  double y = 0;
};

std::vector<MappedPoint> points_of(const std::string& table) {
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "placement,set,x,y");
  std::vector<MappedPoint> points;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    MappedPoint point;
    char comma = ',';
    cells >> point.placement >> comma;
    std::getline(cells, point.set, ',');
    cells >> point.x >> comma >> point.y;
    points.push_back(point);
  }
  return points;
}

/// A log of a roll around a part that lies turned by 90 degrees and moved by (10, 20): its points are turned and moved.
void write_moved_roll(const cli::Folder& folder) {
  const cli::Ran rolled = run("simulate gallery:cam --finger disk,r=0.2 --start 0.5 --length 2.5 --quiet");
  std::istringstream lines(rolled.out);
  std::string line;
  std::getline(lines, line);
  ASSERT_EQ(line, "time,u,psi,x,y");
  std::string log = line + "\n";
  while (std::getline(lines, line)) {
    std::vector<double> row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    log += fmt::format("{},{},{},{},{}\n", row[0], row[1], row[2] + std::acos(0.0), 10 - row[4], 20 + row[3]);
  }
  folder.write("roll.csv", log);
}

/// The placement that starts here; of the answer to this without --map.
int placement_at(double s, const std::string& locate) {
  const cli::Json placements = run(locate + " --json").json()["placements"];
  for (std::size_t k = 0; k < placements.size(); ++k) {
    if (std::abs(placements[k]["start"][0].get<double>() - s) < 1e-4) return static_cast<int>(k);
  }
  ADD_FAILURE() << "nothing starts at " << s;
  return -1;
}

/// Of one placement.
std::vector<MappedPoint> points_of(const std::string& table, int placement) {
  std::vector<MappedPoint> own;
  for (const MappedPoint& point : points_of(table)) {
    if (point.placement == placement) own.push_back(point);
  }
  return own;
}

constexpr const char* kLocate = "locate gallery:cam --finger disk,r=0.2 --log roll.csv ";

TEST(CliMap, points_go_where_the_part_is) {
  const cli::Folder folder;
  write_moved_roll(folder);
  folder.write("holes.csv", "x,y\n0.25,0.5\n1,0\n");
  const cli::Ran ran = run(std::string(kLocate) + "--map holes.csv -o -");
  EXPECT_EQ(ran.code, 0);
  const std::vector<MappedPoint> points = points_of(ran.out, placement_at(0.5, kLocate));
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].set, "holes.csv");
  EXPECT_NEAR(points[0].x, 10 - 0.5, 1e-6);
  EXPECT_NEAR(points[0].y, 20 + 0.25, 1e-6);
  EXPECT_NEAR(points[1].x, 10, 1e-6);
  EXPECT_NEAR(points[1].y, 21, 1e-6);
}

TEST(CliMap, with_noise_the_pose_of_all_rows_is_taken_and_each_placement_has_its_block) {
  const cli::Folder folder;
  write_moved_roll(folder);
  folder.write("holes.csv", "0.25 0.5\n");
  const std::string noisy = std::string(kLocate) + "--noise contact=1e-3,angle=1e-3 ";
  ASSERT_EQ(run(noisy + "--map holes.csv -o mapped.csv").code, 0);
  const cli::Json answer = run(noisy + "--json").json();
  const std::vector<MappedPoint> points = points_of(cli::read("mapped.csv"));
  ASSERT_EQ(points.size(), answer["placements"].size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::vector<double> pose = answer["placements"][k]["pose_mean"];
    EXPECT_EQ(points[k].placement, static_cast<int>(k));
    EXPECT_NEAR(points[k].x, pose[0] + 0.25 * std::cos(pose[2]) - 0.5 * std::sin(pose[2]), 1e-9);
    EXPECT_NEAR(points[k].y, pose[1] + 0.25 * std::sin(pose[2]) + 0.5 * std::cos(pose[2]), 1e-9);
  }
}

TEST(CliMap, the_other_loops_of_a_drawing_go_along) {
  const cli::Folder folder;
  folder.write(
      "plate.svg",
      "<svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0 C 40 -30 90 10 100 0 L 80 60 C 50 80 20 40 0 50 Z'/>"
      "<circle cx='50' cy='25' r='5'/></svg>");
  ASSERT_EQ(run("simulate plate.svg --finger disk,r=2 --start 10 --length 120 -o roll.csv").code, 0);
  const std::string locate = "locate plate.svg --finger disk,r=2 --log roll.csv";
  const cli::Ran ran = run(locate + " --map loops -o -");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::vector<MappedPoint> points = points_of(ran.out, placement_at(10, locate));
  ASSERT_GT(points.size(), 20U);
  const cli::Json hole = run("inspect plate.svg --loop 2 --json").json();
  const double cx = hole["outline"]["x"][0].get<double>() - 5;
  const double cy = hole["outline"]["y"][0].get<double>();
  for (const MappedPoint& point : points) {
    EXPECT_EQ(point.set, "loop 1");
    EXPECT_NEAR(std::hypot(point.x - cx, point.y - cy), 5, 1e-6);
  }
}

TEST(CliMap, what_it_needs_is_said) {
  const cli::Folder folder;
  folder.write("holes.csv", "1 2\n");
  EXPECT_THAT(run("locate gallery:cam --reading 0.9,40deg --map holes.csv -o -").err, HasSubstr("--map: where points"));
  folder.write("roll.csv", "u,psi\n0,0\n-1,0.7\n");
  EXPECT_THAT(run(std::string(kLocate) + "--map holes.csv").err, HasSubstr("expected -o FILE.csv"));
  EXPECT_THAT(run(std::string(kLocate) + "--map holes.csv -o map.svg").err, HasSubstr("ends in .csv"));
  EXPECT_THAT(run(std::string(kLocate) + "--map loops -o -").err, HasSubstr("no drawing with other loops"));
}

}  // namespace
}  // namespace cli_map_test
