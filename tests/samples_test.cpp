// A boundary as numbers: against closed forms, and as dense as it is said to be.
#include "rollfix/part.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "cli.hpp"
#include "rollfix/outline.hpp"

namespace samples_test {
namespace {

using rollfix::BoundarySample;
using rollfix::Part;

Part part_of(const std::string& shape) { return Part(rollfix::gallery(shape)); }

TEST(Samples, of_a_circle_lie_on_it) {
  const Part part = part_of("circle,r=2");
  for (const BoundarySample& at : samples_of(part)) {
    EXPECT_NEAR(at.point.x(), 2 * std::cos(at.s / 2), 1e-11);
    EXPECT_NEAR(at.point.y(), 2 * std::sin(at.s / 2), 1e-11);
    EXPECT_NEAR(at.tangent, std::numbers::pi / 2 + at.s / 2, 1e-11);
    EXPECT_NEAR(at.curvature, 0.5, 1e-10);
  }
}

TEST(Samples, run_from_0_to_the_perimeter_no_further_apart_than_is_said) {
  for (const rollfix::GalleryShape& shape : rollfix::gallery_shapes()) {
    const Part part = part_of(shape.name);
    const std::vector<BoundarySample> samples = samples_of(part);
    EXPECT_EQ(samples.front().s, 0) << shape.name;
    EXPECT_EQ(samples.back().s, part.perimeter()) << shape.name;
    for (std::size_t k = 1; k < samples.size(); ++k) {
      const double length = samples[k].s - samples[k - 1].s;
      EXPECT_GE(length, 0) << shape.name;
      EXPECT_LE(length, part.perimeter() / 200 * (1 + 1e-9)) << shape.name;
      if (length > 0) {
        EXPECT_LE(std::abs(samples[k].tangent - samples[k - 1].tangent), 2.0001 * std::numbers::pi / 180);
      }
    }
  }
}

TEST(Samples, have_both_tangents_at_a_corner) {
  const Part part = part_of("polygon,n=4");
  const std::vector<BoundarySample> samples = samples_of(part);
  int corners = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    if (samples[k].s != samples[k - 1].s) continue;
    ++corners;
    EXPECT_NEAR(samples[k].tangent - samples[k - 1].tangent, std::numbers::pi / 2, 1e-12);
  }
  EXPECT_GE(corners, 3);  // the fourth may be where the outline starts and ends
}

TEST(Samples, keep_the_parts_unit_in_a_table) {
  const cli::Folder folder;
  ASSERT_EQ(cli::run("inspect gallery:ellipse --unit in -o outline.csv").code, 0);
  EXPECT_EQ(cli::read("outline.csv").substr(0, 28), "s [in],x [in],y [in],tangent");
  EXPECT_THAT(cli::run("inspect outline.csv --unit mm").out, testing::HasSubstr("perimeter    246."));  // 9.688 in
}

TEST(Samples, are_the_same_in_a_table_and_in_json) {
  const cli::Folder folder;
  const cli::Ran ran = cli::run("inspect gallery:ellipse --json -o outline.csv");
  ASSERT_EQ(ran.code, 0);
  const cli::Json outline = ran.json()["outline"];
  std::istringstream table(cli::read("outline.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "s,x,y,tangent,curvature");
  std::size_t row = 0;
  for (; std::getline(table, line); ++row) {
    double s = 0, x = 0, y = 0, tangent = 0, curvature = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &s, &x, &y, &tangent, &curvature), 5);
    EXPECT_EQ(outline["s"][row], s);
    EXPECT_EQ(outline["x"][row], x);
    EXPECT_EQ(outline["y"][row], y);
    EXPECT_EQ(outline["tangent"][row], tangent);
    EXPECT_EQ(outline["curvature"][row], curvature);
    EXPECT_NEAR(x * x / 4 + y * y, 1, 1e-9);
  }
  EXPECT_EQ(outline["s"].size(), row);
  EXPECT_GT(row, 200U);
}

}  // namespace
}  // namespace samples_test
