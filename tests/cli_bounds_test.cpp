// Numbers beyond any sense: an answer, a refusal with its reason, or `incomplete`; never NaN, and never a wait without
// end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <locale>

#include "cli.hpp"
#include "outline/turn.hpp"

namespace cli_bounds_test {
namespace {

using cli::Json;
using cli::run;
using testing::HasSubstr;

const std::string kRoll = "locate gallery:cam --log roll.csv --finger disk,r=0.2 --noise contact=0.01,angle=0.01 ";

/// JSON knows no NaN: parsing it finds one.
void expect_sense(const cli::Ran& ran) {
  EXPECT_THAT(ran.code, testing::AnyOf(0, 1, 2, 3)) << ran.err;
  if (ran.code == 2) {
    EXPECT_EQ(ran.out, "");
    EXPECT_THAT(ran.err, testing::StartsWith("rollfix: "));
  } else {
    EXPECT_TRUE(Json::accept(ran.out)) << ran.out;
  }
}

void expect_refusal(const std::string& command, const std::string& reason) {
  const cli::Ran ran = run(command);
  EXPECT_EQ(ran.code, 2) << command;
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr(reason)) << command;
}

class AnyNumber : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(AnyNumber, is_a_length_or_a_turn_that_is_answered_or_refused) {
  for (const std::string part : {"gallery:cam", "gallery:polygon,n=4", "gallery:stadium", "gallery:log-spiral"}) {
    expect_sense(run("locate " + part + " --json --reading " + GetParam() + ",0.5"));
    expect_sense(run("locate " + part + " --json --reading 0.5," + GetParam()));
    expect_sense(run("locate " + part + " --json --facing 1 --reading 0.5,1," + GetParam()));
    expect_sense(run("locate " + part + " --json --reading 0.5,1 --tolerance " + GetParam()));
  }
}

TEST_P(AnyNumber, is_a_size_that_is_answered_or_refused) {
  for (const std::string shape : {"ellipse,a=", "polygon,r=", "naca,chord=", "superellipse,a="}) {
    expect_sense(run("inspect --json gallery:" + shape + GetParam()));
  }
  expect_sense(run("inspect --json gallery:ellipse --finger disk,r=" + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Numbers, AnyNumber,
                         testing::Values("0", "-0", "5e-324", "1e-310", "1e-300", "1e-12", "1e12", "1e20", "1e300",
                                         "1.7976931348623157e308", "-1e300", "nan", "inf", "-inf", "1e999"),
                         [](const auto& shape) { return "number_" + std::to_string(shape.index); });

TEST(Facing, of_so_many_turns_that_rounding_is_all_that_is_left_of_it_is_refused) {
  const std::string question = "locate gallery:cam --reading 1.5,-0.8,110.97deg --facing ";
  expect_refusal(question + "1e12", "a facing of at most 1000000 rad");
  expect_refusal(question + "-1000001", "check the units");
  EXPECT_EQ(run(question + "-1000000").code, 0);
}

TEST(Facing, of_many_turns_is_reduced_in_all_its_digits) {
  constexpr long double kTurn = 6.283185307179586476925286766559L;
  for (const double angle : {1e6, -1e6, 876543.21, 3.0, -4.0, 0.0}) {
    const auto reduced = static_cast<double>(std::remainder(static_cast<long double>(angle), kTurn));
    EXPECT_NEAR(rollfix::without_laps(angle), reduced, 2e-14) << angle;
  }
}

TEST(Laps, beyond_which_a_perimeter_does_not_tell_where_a_roll_ends_are_refused) {
  expect_refusal("locate gallery:cam --reading 1e12,0.5", "no more than 1000000 laps of gallery:cam");
  expect_refusal("locate gallery:polygon,n=4 --reading -1e300,0.5", "check the units");
  expect_refusal("locate gallery:cam --reading 1,1e300,0.5 --facing 1", "laps");
  EXPECT_EQ(run("locate gallery:ellipse --reading 1000000,0.5").code, 1);  // laps, but not that many
}

TEST(TinyDisk, that_is_lost_in_rounding_is_refused) {
  expect_refusal("inspect gallery:cam --finger disk,r=1e-300", "lost in the rounding of the perimeter");
  expect_refusal("locate gallery:cam --reading 1,0.5 --finger disk,r=1e-13", "lost in the rounding of the perimeter");
  expect_refusal("simulate gallery:cam --finger disk,r=1e-300 --start 1 --length 1",
                 "lost in the rounding of the perimeter");
}

TEST(NarrowPrior, is_taken_as_it_is_unless_it_is_lost_in_rounding) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 1 --length 1.5 --samples 21 -o roll.csv").code, 0);
  const Json answer = run(kRoll + "--prior 1,1e-9 --json").json();
  ASSERT_EQ(answer["placements"].size(), 1U);
  EXPECT_NEAR(answer["placements"][0]["mean"][0].get<double>(), 1, 1e-8);
  expect_refusal(kRoll + "--prior 1,1e-300", "lost in the rounding of the perimeter");
}

TEST(HugeNoise, that_leaves_no_numbers_is_refused) {
  expect_refusal("simulate gallery:cam --finger disk,r=0.2 --start 1 --length 1 --noise contact=1e308",
                 "beyond any double");
}

TEST(Scale, of_a_part_and_its_rolls_changes_no_answer) {
  const auto starts = [](const std::string& unit) {
    std::vector<double> found;
    const Json answer =
        run("locate gallery:ellipse,a=2e" + unit + ",b=1e" + unit + " --reading 1.5e" + unit + ",1.25 --json").json();
    for (const Json& placement : answer["placements"]) {
      found.push_back(placement["start"][0].get<double>() / answer["part"]["perimeter"].get<double>());
    }
    return found;
  };
  const std::vector<double> expected = starts("0");
  EXPECT_EQ(expected.size(), 4U);
  for (const std::string unit : {"-9", "6", "-50", "50"}) {
    EXPECT_THAT(starts(unit), testing::Pointwise(testing::DoubleNear(1e-9), expected)) << unit;
  }
}

TEST(Detail, of_a_millionth_of_the_perimeter_is_found) {
  const cli::Folder folder;
  // A square whose first side has a notch of 4e-6.
  folder.write("notch.csv", "0 0\n0.5 0\n0.500002 0.000002\n0.500004 0\n1 0\n1 1\n0 1\n");
  const Json answer = run("locate notch.csv --corner-angle 20deg --reading 0.000004,45deg --json").json();
  EXPECT_EQ(answer["status"], "complete");
  EXPECT_EQ(answer["part"]["corners"], 7);
}

TEST(Device, slow_that_has_no_end_is_refused) {
  if (!cli::fs::exists("/dev/zero")) GTEST_SKIP() << "there is no /dev/zero";
  const cli::Folder folder;
  cli::fs::create_symlink("/dev/zero", "zero.csv");
  expect_refusal("inspect zero.csv", "zero.csv: has no end");
}

TEST(DecimalComma, of_the_user_s_locale_changes_nothing) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::vector<std::string> commands = {"locate gallery:cam --reading 0.9,40.5deg", "inspect gallery:gear --json",
                                             "simulate gallery:cam --finger disk,r=0.2 --start 1 --length 1",
                                             "inspect gallery:ellipse -o -"};
  for (const std::string& command : commands) {
    const std::string expected = run(command).out;
    const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
    const std::string found = run(command).out;
    std::locale::global(before);
    EXPECT_EQ(found, expected) << command;
  }
}

}  // namespace cli_bounds_test
