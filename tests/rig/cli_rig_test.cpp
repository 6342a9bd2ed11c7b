// A jaw and a wheel on the command line, and two fingers of different shapes: simulated, and located.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "../cli.hpp"

namespace cli_rig_test {
namespace {

using cli::run;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kFingers = "simulate gallery:ellipse --finger jaw --finger wheel,r=0.4";
const std::string kRig = kFingers + " --start 2.4 --start 6.3 --pin -0.4,-0.15 --samples 11";
const std::string kLocate = "locate gallery:ellipse --finger jaw --finger disk,r=0.4 --log a.csv --log b.csv --json";

std::string refused(const std::string& command) {
  const cli::Ran ran = run(command);
  EXPECT_EQ(ran.code, 2);
  return ran.err;
}

/// Is a pair of first contacts among the placements?
bool holds(const cli::Json& answer, double s, double t) {
  for (const cli::Json& placement : answer["placements"]) {
    if (std::abs(placement["start"][0].get<double>() - s) < 1e-6 &&
        std::abs(placement["start"][1].get<double>() - t) < 1e-6) {
      return true;
    }
  }
  return false;
}

}  // namespace

TEST(CliRig, writes_what_its_sensors_measure) {
  const cli::Folder folder;
  EXPECT_THAT(run(kRig).out, StartsWith("time,u_a,psi_a,x_a,y_a,u_b,psi_b,x_b,y_b\n"));
  EXPECT_THAT(run(kRig + " --wheel encoder").out, StartsWith("time,u_a,psi_a,x_a,y_a,psi_b,x_b,y_b\n"));
  EXPECT_EQ(run(kRig + " --wheel pin -o a.csv -o b.csv").code, 0);
  EXPECT_THAT(cli::read("a.csv"), StartsWith("time,u,psi,x,y\n"));
  EXPECT_THAT(cli::read("b.csv"), StartsWith("time,x,y\n"));
}

TEST(CliRig, is_found_where_it_started) {
  const cli::Folder folder;
  const cli::Ran ran = run(kRig + " --jaw-rotation 20deg --contact 0.7 --contact-angle 10deg -o a.csv -o b.csv");
  EXPECT_THAT(ran.err, AllOf(HasSubstr("the jaw rolled from s = 2.400000 over length -1.012"),
                             HasSubstr("the wheel rolled from s = 6.300000")));
  EXPECT_TRUE(holds(run(kLocate).json(), 2.4, 6.3));
}

TEST(CliRig, is_found_on_a_part_face_down) {
  const cli::Folder folder;
  EXPECT_EQ(run(kFingers + " --start 2.4 --start 6.3 --pin 0.4,-0.15 --mirror -o a.csv -o b.csv").code, 0);
  EXPECT_TRUE(holds(run(kLocate + " --mirror").json(), 2.4, 6.3));
}

TEST(CliRig, has_noise_with_its_errors_told) {
  const cli::Ran ran = run(kRig + " --noise contact=0.001,angle=0.1deg,slip=0.01,radius=0.01,position=0.01 --seed 3");
  EXPECT_THAT(ran.err, AllOf(HasSubstr("the jaw: the contact went "), HasSubstr("the wheel: the contact went "),
                             HasSubstr("its radius really is 0.4")));
  EXPECT_NE(ran.out, run(kRig + " --noise contact=0.001,angle=0.1deg,slip=0.01,radius=0.01 --seed 3").out);
}

TEST(CliRig, starts_a_squeezed_wheel_where_it_can_be_squeezed) {
  const std::string squeezed = kFingers + " --pin 0.2 --squeeze --start 2.4";
  EXPECT_THAT(run(squeezed).err, HasSubstr("the wheel rolled from s = 7.310565"));
  EXPECT_EQ(run(squeezed + " --start 7.3").out, run(squeezed).out);
  EXPECT_THAT(refused(squeezed + " --start 5.8"), HasSubstr("can't be squeezed there, expected a place near s = 7.31"));
  EXPECT_THAT(refused(kFingers + " --pin 0.2 --squeeze --start 0"), HasSubstr("found none in a stable grip"));
  EXPECT_THAT(run(kFingers + " --pin 2.1 --squeeze --start 2.4").err,
              HasSubstr("the jaw's contact turned back in row"));
}

TEST(CliRig, says_where_the_pin_does_not_tell_how_the_part_rolls) {
  EXPECT_THAT(refused(kFingers + " --start 2.4 --start 5.8 --pin 0.4,-0.1"),
              AllOf(HasSubstr("row 47 of the log"), HasSubstr("the wheel's normal passes through the jaw's contact"),
                    HasSubstr("the pin can move by (0.183")));
}

TEST(CliRig, refuses_what_is_no_rig) {
  EXPECT_THAT(refused(kFingers + " --start 2.4 --start 6.3"), HasSubstr("expected --pin DX,DY"));
  EXPECT_THAT(refused(kFingers + " --start 2.4 --start 6.3 --pin 1"), HasSubstr("expected DX,DY"));
  EXPECT_THAT(refused(kFingers + " --start 2.4 --pin 1,2"), HasSubstr("expected --start twice"));
  EXPECT_THAT(refused(kFingers + " --start 2.4 --start 6.3 --pin 1,2 --squeeze"), HasSubstr("expected DX alone"));
  EXPECT_THAT(refused(kRig + " --length 2"), HasSubstr("--length is of fingers that roll as told"));
  EXPECT_THAT(refused(kRig + " --wheel all"), HasSubstr("expected skin, encoder or pin"));
  EXPECT_THAT(refused("simulate gallery:ellipse --finger wheel,r=0.4 --finger jaw --start 1 --start 2 --pin 1,2"),
              HasSubstr("in this order, found --finger wheel,r=0.4 --finger jaw"));
}

TEST(CliMixedFingers, are_simulated_and_found) {
  const cli::Folder folder;
  for (const std::string pair : {"--finger jaw --finger disk,r=0.2", "--finger gallery:stadium --finger jaw",
                                 "--finger jaw", "--finger gallery:ellipse,a=0.3,b=0.2 --finger gallery:stadium"}) {
    const std::string roll = " --start 1 --start 4 --length 1.5 --length -0.8 --part-rotation 20deg";
    EXPECT_EQ(run("simulate gallery:cam " + pair + roll + " -o both.csv --force").code, 0);
    EXPECT_TRUE(holds(run("locate gallery:cam " + pair + " --log both.csv --may-overlap --json").json(), 1, 4)) << pair;
  }
}

TEST(CliMixedFingers, on_a_part_face_down_are_found_as_well) {
  const cli::Folder folder;
  const std::string fingers = " gallery:cam --finger gallery:ellipse,a=0.3,b=0.2 --finger jaw --mirror";
  // The ellipse ends beyond the jaw's line.
  EXPECT_EQ(run("simulate" + fingers + " --start 1 --start 4 --length 1.5 --length -0.8 -o both.csv").code, 0);
  EXPECT_TRUE(holds(run("locate" + fingers + " --log both.csv --may-overlap --json").json(), 1, 4));
  EXPECT_THAT(run("locate" + fingers + " --log both.csv").out, HasSubstr("but the fingers would overlap"));
}

TEST(CliMixedFingers, have_first_contacts_of_their_own_kind) {
  const std::string roll = "simulate gallery:cam --start 1 --start 4 --length 1 --length 1 --finger jaw";
  EXPECT_EQ(run(roll + " --finger disk,r=0.2 --contact 0.3 --contact-angle 20deg").code, 0);
  EXPECT_EQ(run(roll + " --contact 0.3 --contact 0.1").code, 0);
  EXPECT_THAT(refused(roll + " --contact-angle 1"), HasSubstr("--contact-angle is of a disk"));
  EXPECT_THAT(refused(roll + " --finger disk,r=0.2 --contact 1 --contact 2"),
              HasSubstr("--contact is given twice, and only finger a is a jaw or an outline; give it once, and "
                        "--contact-angle for the other one"));
}

}  // namespace cli_rig_test
