// A cure that a message offers can be typed as it stands, and does what is meant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "cli.hpp"

namespace cli_cure_test {
namespace {

using cli::run;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kFinger = " --finger disk,r=0.2 --noise contact=0.002,angle=0.2deg";

/// The first option of this name with its value, as the text has it.
std::string option_in(const std::string& text, const std::string& name) {
  std::smatch found;
  return std::regex_search(text, found, std::regex("--" + name + " [^ ;)]+")) ? found.str() : "";
}

TEST(Cures, columns_of_one_finger_alone_are_taken_as_one_fingers) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 2 --length 3 -o roll.csv").code, 0);
  folder.write("a.csv", std::regex_replace(cli::read("roll.csv"), std::regex("\\bu,psi\\b"), "u_a,psi_a"));
  const std::string locate = std::string("locate gallery:cam --log a.csv") + kFinger;
  const auto refused = run(locate);
  EXPECT_THAT(refused.err, HasSubstr("of one finger alone say --columns u=u_a,psi=psi_a"));
  EXPECT_THAT(run(locate + " " + option_in(refused.err, "columns")).out, HasSubstr("unique"));
}

TEST(Cures, columns_of_a_second_finger_are_looked_for_among_those_that_are_not_the_firsts) {
  const cli::Folder folder;
  folder.write("roll.csv", "u_a,psi_a,skin_b,yaw_b\n0,0,0,0\n1,1,1,1\n");
  const auto refused = run(std::string("locate gallery:cam --log roll.csv --finger disk,r=0.2") + kFinger);
  EXPECT_EQ(option_in(refused.err, "columns"), "--columns u_b=skin_b,psi_b=yaw_b");
}

void expect_degrees_told(const std::string& log) {
  const cli::Folder folder;
  folder.write("roll.csv", log);
  const auto refused = run("locate gallery:cam --log roll.csv");
  EXPECT_THAT(refused.err, HasSubstr("if the turns are in degrees"));
  EXPECT_EQ(run("locate gallery:cam --log roll.csv " + option_in(refused.err, "columns")).code, 0);
}

TEST(Cures, turns_in_degrees_are_told_apart_from_a_jump) {
  expect_degrees_told("length,turn\n0,0\n0.4,20\n0.8,41\n1.2,60\n");
  expect_degrees_told("distance,dturn\n0.4,20\n0.4,21\n0.4,19\n");
}

TEST(Cures, where_no_noise_was_said_the_cure_says_all_of_it) {
  const cli::Folder folder;
  folder.write("roll.csv", "time,length,turn\n0,0,0\n1,1.234,0.5\n2,1.5,0.9\n");
  const std::string cure = option_in(run("locate gallery:cam --log roll.csv").out, "noise");
  EXPECT_THAT(cure, HasSubstr("contact="));
  EXPECT_THAT(run("locate gallery:cam --log roll.csv " + cure).out, StartsWith("ambiguous"));
}

}  // namespace
}  // namespace cli_cure_test
