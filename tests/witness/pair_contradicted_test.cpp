// Rows that contradict the stated noise so far that under some mistakes nothing about any peak weighs anything.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli.hpp"
#include "paths.hpp"

namespace pair_contradicted_test {

namespace {

const std::string kFolder = checked_out("tests/two/contradicted/");

}  // namespace

// The contacts of a roll on 30 points, with places on the fingers that are 0.3 % too large.
TEST(PairContradicted, rows_are_told_to_fit_badly_when_no_peak_of_a_mistake_weighs_anything) {
  const cli::Ran ran = cli::run("locate " + kFolder + "part.csv --log " + kFolder + "a.csv --log " + kFolder +
                                "b.csv --finger disk,r=0.175 --finger disk,r=0.116 "
                                "--noise contact=0.0005,angle=0.008,slip=0.003,position=0.001 --json");
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ(ran.json()["verdict"], "unique, but the rows fit badly");
}

}  // namespace pair_contradicted_test
