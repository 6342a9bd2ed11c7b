// A cure that a message offers can be typed as it stands, and does what is meant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <regex>
#include <string>
#include <vector>

#include "cli.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace cli_cure_test {
namespace {

using cli::run;
namespace fs = std::filesystem;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
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

TEST(Cures, of_a_wrong_radius_say_the_noise_that_its_digits_need) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2012345 --start 2 --length 3 -o roll.csv").code, 0);
  const std::string text = run("locate gallery:cam --log roll.csv --finger disk,r=0.21").out;
  const std::string cure = option_in(text, "finger") + " " + option_in(text, "noise");
  EXPECT_THAT(run("locate gallery:cam --log roll.csv " + cure).out, StartsWith("unique"));
}

TEST(Cures, radians_that_were_said_to_be_degrees_are_told) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 2 --length 3 -o roll.csv").code, 0);
  const std::string locate = "locate gallery:cam --finger disk,r=0.2 --log roll.csv";
  const std::string text = run(locate + " --columns u=u:deg,psi=psi:deg").out;
  EXPECT_THAT(text, HasSubstr("likeliest: u and psi are in radians"));
  EXPECT_THAT(run(locate + " " + option_in(text, "columns")).out, StartsWith("unique"));
  EXPECT_THAT(run(locate + " --columns psi=psi:deg").out, HasSubstr("likeliest: psi is in radians"));
}

TEST(Cures, turns_in_radians_that_were_said_to_be_degrees_are_told) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 2 --length 3 -o contacts.csv").code, 0);
  std::ofstream log("roll.csv");
  log.precision(12);
  log << "length,turn\n";
  const rollfix::Part cam(rollfix::gallery("cam"));
  for (int k = 0; k <= 40; ++k)
    log << 0.08 * k << ',' << cam.turning().angle(2 + 0.08 * k) - cam.turning().angle(2) << '\n';
  log.close();
  const std::string text = run("locate gallery:cam --log roll.csv --columns turn=turn:deg").out;
  EXPECT_THAT(text, HasSubstr("likeliest: turns are in radians"));
  EXPECT_THAT(run("locate gallery:cam --log roll.csv " + option_in(text, "columns")).out,
              HasSubstr("  2.000000  5.200000"));
}

/// The log roll.csv with other numbers.
void write_changed(const std::string& file, const std::function<void(std::size_t, double&, double&)>& change) {
  const rollfix::FingerRows rows = rollfix::read_log("roll.csv").fingers[0];
  std::ofstream log(file);
  log.precision(12);
  log << "u,psi\n";
  for (std::size_t k = 0; k < rows.u.size(); ++k) {
    double u = rows.u[k];
    double psi = rows.psi[k];
    change(k, u, psi);
    log << u << ',' << psi << '\n';
  }
}

/// A roll of a disk that sticks to its skin for some rows: u stands still meanwhile.
TEST(Cures, a_short_roll_in_degrees_does_not_explain_what_it_hides) {
  const cli::Folder folder;
  const std::string noise = " --noise contact=0.00197,angle=0.2deg";
  ASSERT_EQ(
      run("simulate gallery:cam --finger disk,r=0.2343 --start 1.51 --length 3.55 --samples 120 --seed 1 -o roll.csv" +
          noise)
          .code,
      0);
  double held = 0;
  write_changed("stuck.csv", [&](std::size_t k, double& u, double& /*psi*/) {
    if (k == 60) held = u;
    if (k >= 60 && k < 70) u = held;
  });
  const std::string text = run("locate gallery:cam --log stuck.csv --finger disk,r=0.2343" + noise).out;
  EXPECT_THAT(text, HasSubstr("likeliest: "));
  EXPECT_THAT(text, Not(HasSubstr("degrees")));
}

TEST(Cures, of_psi_alone_in_degrees_is_that_and_no_jump) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 2 --length 3 --samples 40 -o roll.csv").code, 0);
  write_changed("degrees.csv", [](std::size_t, double& /*u*/, double& psi) { psi *= 180 / std::acos(-1); });
  const std::string locate = std::string("locate gallery:cam --log degrees.csv") + kFinger;
  const cli::Ran ran = run(locate);
  const std::string told = ran.code == 2 ? ran.err : ran.out;
  EXPECT_THAT(told, HasSubstr("psi is in degrees"));
  EXPECT_THAT(run(locate + " " + option_in(told, "columns")).out, StartsWith("unique"));
}

TEST(Cures, of_exchanged_fingers_are_both_with_their_radii) {
  const cli::Folder folder;
  const std::string simulate = "simulate gallery:cam --finger disk,r=0.3 --finger disk,r=0.1 --start 1 --start 4 ";
  ASSERT_EQ(run(simulate + "--length 1.5 --length -0.8 -o roll.csv").code, 0);
  const std::string locate = "locate gallery:cam --log roll.csv --noise contact=0.001,angle=0.1deg ";
  const std::string cure = "--finger disk,r=0.3 --finger disk,r=0.1";
  EXPECT_THAT(run(locate + "--finger disk,r=0.1 --finger disk,r=0.3").out, HasSubstr("\n  " + cure + "; then unique"));
  EXPECT_THAT(run(locate + cure).out, StartsWith("unique"));
}

TEST(Cures, of_one_finger_that_serves_for_both_give_both_where_one_is_off) {
  const cli::Folder folder;
  const std::string simulate = "simulate gallery:limacon --finger disk,r=0.16 --finger disk,r=0.2 --start 1 --start 6 ";
  const std::string noise = "--noise contact=0.005,angle=0.3deg ";
  ASSERT_EQ(run(simulate + noise + "--seed 3 --length 4 --length 3 --samples 150 -o roll.csv").code, 0);
  EXPECT_THAT(run("locate gallery:limacon --log roll.csv --finger disk,r=0.2 " + noise).out,
              ContainsRegex("\n  --finger disk,r=0.1[0-9]* --finger disk,r=0.2; then unique"));
}

TEST(Cures, of_a_stray_row_say_the_noise_that_robust_needs) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 2 --length 3 --samples 60 -o roll.csv").code, 0);
  write_changed("stray.csv", [](std::size_t k, double& /*u*/, double& psi) { psi += k == 30 ? 0.2 : 0; });
  EXPECT_THAT(run("locate gallery:cam --log stray.csv --finger disk,r=0.2").out,
              HasSubstr("--robust --noise contact="));
}

TEST(Cures, a_row_of_units_is_no_row_to_leave_out) {
  const cli::Folder folder;
  folder.write("roll.csv", "time,u,psi\ns,deg,deg\n0,0,0\n1,-10,20\n");
  const cli::Ran ran = run("locate gallery:cam --log roll.csv --finger disk,r=0.2");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, AllOf(HasSubstr("roll.csv:2: 's,deg,deg' are units"), Not(HasSubstr("skip-bad"))));
}

TEST(Cures, an_empty_value_is_refused_and_not_left_out) {
  for (const char* const option : {"--noise", "--tolerance", "--unit", "--certify", "-o", "--layer"}) {
    const auto ran = cli::run_words({"locate", "gallery:cam", "--reading", "1,0.5", option, ""});
    EXPECT_EQ(ran.code, 2) << option;
    EXPECT_THAT(ran.err, HasSubstr("expected a value behind it, found an empty one"));
  }
  EXPECT_EQ(run("locate gallery:cam --reading 1,0.5 --noise=").code, 2);
}

TEST(Cures, of_two_fingers_by_names_of_ones_own_are_of_two) {
  const cli::Folder folder;
  ASSERT_EQ(
      run("simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --length 1.5 --length -0.8 -o two.csv").code,
      0);
  const std::string text = cli::read("two.csv");
  folder.write("own.csv", "t,skinL,yawL,skinR,yawR,xL,yL,xR,yR" + text.substr(text.find('\n')));
  const std::string locate = std::string("locate gallery:cam --log own.csv") + kFinger;
  const cli::Ran refused = run(locate);
  EXPECT_THAT(refused.err, HasSubstr("u_a=skinL,psi_a=yawL,time=t,x_a=xL,y_a=yL,u_b=skinR,psi_b=yawR,x_b=xR,y_b=yR"));
  EXPECT_THAT(run(locate + " " + option_in(refused.err, "columns")).out, HasSubstr("finger a"));
}

TEST(Cures, one_column_is_not_read_as_two) {
  const cli::Folder folder;
  folder.write("roll.csv", "u,psi\n0,0\n1,1\n");
  EXPECT_THAT(run("locate gallery:cam --log roll.csv --finger disk,r=0.2 --columns u=u,psi=u").err,
              HasSubstr("reads 'u' twice, as psi as well"));
}

TEST(Cures, a_part_in_pixels_first_in_a_catalog_says_what_unit_to_give) {
  const cli::Folder folder;
  fs::create_directory("parts");
  folder.write("parts/a.svg", "<svg xmlns='http://www.w3.org/2000/svg'><rect width='40' height='20'/></svg>");
  folder.write("parts/b.csv", "x [mm],y [mm]\n0,0\n40,0\n40,20\n");
  const cli::Ran mixed = run("catalog build parts -o parts.db");
  EXPECT_THAT(mixed.err + mixed.out,
              HasSubstr("the catalog is in px, as its first part: build another file, with --unit mm"));
  EXPECT_EQ(run("catalog build parts -o other.db --unit mm").code, 0);
}

TEST(Cures, a_heading_of_ninety_radians_is_one_of_degrees) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 2 --length 3 -o roll.csv").code, 0);
  const cli::Ran ran = run(std::string("locate gallery:cam --log roll.csv --heading 90,5") + kFinger);
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("degrees are written 90deg"));
}

// Each run of the program in these tests types what it offers: see cures.hpp. That sees what is offered:

TEST(Cures, are_found_in_messages) {
  using Cures = std::vector<cli::Cure>;
  EXPECT_EQ(cli::cures::of_errors("rollfix: a.csv:3: time must grow; --skip-bad leaves such rows out"),
            (Cures{{"--skip-bad"}}));
  EXPECT_EQ(cli::cures::of_errors("x: say it with --wrapped no, or --wrapped yes\n"),
            (Cures{{"--wrapped", "no"}, {"--wrapped", "yes"}}));
  EXPECT_EQ(cli::cures::of_errors("say which column is which, as in --columns 'u=a b,psi=c:deg' (the header has a b)"),
            (Cures{{"--columns", "u=a b,psi=c:deg"}}));
  EXPECT_EQ(cli::cures::of_errors("x: --loop N takes another; --noise is from rollfix.toml:3"), Cures{});
  EXPECT_EQ(cli::cures::of_diagnoses("likeliest: a wrong radius\n  --finger disk,r=0.2 --noise contact=1; then unique"),
            (Cures{{"--finger", "disk,r=0.2", "--noise", "contact=1"}}));
}

TEST(Cures, take_the_place_of_what_was_typed) {
  EXPECT_EQ(cli::cures::with({"locate", "cam", "--noise", "angle=1", "-o", "a.svg", "--json"}, {"--noise", "angle=2"}),
            (std::vector<std::string>{"locate", "cam", "--json", "--noise", "angle=2"}));
}

}  // namespace
}  // namespace cli_cure_test
