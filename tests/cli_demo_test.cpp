// What the demo leaves in a folder; tests/witness/demo_test.cpp looks at what it finds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli.hpp"

namespace cli_demo_test {

using cli::run;
using testing::ElementsAre;

TEST(Demo, writes_figures_logs_and_a_part_and_overwrites_nothing_that_is_not_its_own) {
  const cli::Folder folder;
  EXPECT_EQ(run("demo -o a/b").code, 0);
  EXPECT_THAT(folder.files("a/b"),
              ElementsAre("figure7-roll.csv", "figure7.png", "figure7.svg", "figure8-rolled-on.png",
                          "figure8-rolled-on.svg", "figure8-rolls.csv", "figure8.png", "figure8.svg", "plate.dxf",
                          "wing-roll.csv", "wing.csv", "wing.png", "wing.svg"));
  EXPECT_EQ(run("demo -o a/b").code, 0);
  folder.write("a/b/figure7.svg", "mine");
  EXPECT_EQ(run("demo -o a/b").code, 2);
  EXPECT_EQ(run("demo -o a/b --force").code, 0);
}

}  // namespace cli_demo_test
