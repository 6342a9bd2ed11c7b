#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <vector>

#include "cli.hpp"
#include "hold/rig_cases.hpp"
#include "rollfix/files.hpp"

// A jaw with skin and a wheel without, as the program takes them.
namespace cli_rig_test {

using cli::Folder;
using cli::Json;
using cli::Ran;
using cli::run;
using rollfix::HoldAnswer;
using rollfix::HoldCause;
using rollfix::Noise;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kAsked = "locate gallery:cam --log jaw.csv --log pin.csv --finger jaw --finger wheel,r=0.3 ";

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

/// jaw.csv and pin.csv of a simulated rig; with its encoder the latter has psi.
rig_cases::RigCase simulate(bool encoder = false) {
  std::mt19937_64 generator(11);
  const rig_cases::Part cam = rollfix::load_part("gallery:cam");
  rig_cases::RigCase one = rig_cases::random_rig(cam, 0.3, generator, encoder, 16);
  rollfix::write_log("jaw.csv", one.problem.logs[0]);
  const rollfix::FingerRows& pin = one.problem.wheels[0].log.rows.fingers[0];
  std::string text = encoder ? "time,psi,x,y\n" : "time,x,y\n";
  for (std::size_t k = 0; k < pin.x.size(); ++k) {
    text += fmt::format("{:.17g},", one.problem.logs[0].time[k]);
    if (encoder) text += fmt::format("{:.17g},", pin.psi[k]);
    text += fmt::format("{:.17g},{:.17g}\n", pin.x[k], pin.y[k]);
  }
  write("pin.csv", text);
  return one;
}

TEST(CliRig, AJawAndAPinsPlaceSayWhereThePartIs) {
  const Folder folder;
  const rig_cases::RigCase one = simulate();
  const Ran ran = run(kAsked);
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr(fmt::format("unique: finger a started at s = {:.6g}, wheel b at ", one.start)));
  EXPECT_THAT(ran.out, HasSubstr("1 with skin and 1 wheel without, on a part"));
}

const std::string kSmall = "--noise contact=0.0005,angle=0.0005,position=0.0005 ";

TEST(SlowCliRig, AWrongRadiusOfTheWheelIsFound) {
  const Folder folder;
  simulate();
  const Ran ran = run("locate gallery:cam --log jaw.csv --log pin.csv --finger jaw --finger wheel,r=0.33 " + kSmall);
  EXPECT_THAT(ran.out,
              AllOf(HasSubstr("the radius of wheel b is 0.3 "), HasSubstr("cure: --finger wheel,r=0.3 for wheel b")));
}

TEST(SlowCliRig, APartThatIsNotSqueezedIsNamed) {
  const Folder folder;
  simulate();
  const Ran ran = run(kAsked + kSmall + "--squeezed 0.1deg");
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.out, HasSubstr("leave --squeezed out"));
}

TEST(CliRig, APinInAnotherUnitIsNamed) {
  const Folder folder;
  rig_cases::RigCase one = simulate();
  for (double& x : one.problem.wheels[0].log.rows.fingers[0].x) x *= 25.4;
  for (double& y : one.problem.wheels[0].log.rows.fingers[0].y) y *= 25.4;
  one.problem.noise = Noise{0.002, 0.002, 0, 0};
  one.problem.noise->position = 0.002;
  const HoldAnswer answer = solve(one.problem);
  ASSERT_FALSE(answer.diagnoses.empty());
  EXPECT_EQ(answer.diagnoses.front().cause, HoldCause::unit);
  EXPECT_NEAR(answer.diagnoses.front().placements.front().contacts[0].mean, one.start, 0.05);
}

TEST(CliRig, JsonHasTheWheelsPlacesLikeAFingers) {
  const Folder folder;
  const rig_cases::RigCase one = simulate(true);
  const Json document = run(kAsked + "--json").json();
  EXPECT_EQ(document["fingers"], 2);
  EXPECT_EQ(document["rolls"][1]["wheel"], true);
  EXPECT_EQ(document["rolls"][1]["encoder"], true);
  EXPECT_EQ(document["rolls"][1]["length"], nullptr);
  EXPECT_NEAR(document["placements"][0]["start"][1].get<double>(), one.wheel_start, 1e-6);
}

TEST(CliRig, AFigureShowsJawAndWheel) {
  const Folder folder;
  simulate();
  EXPECT_EQ(run(kAsked + "-o rig.svg").code, 0);
  EXPECT_THAT(cli::read("rig.svg"), HasSubstr("1 finger and 1 wheel"));
}

TEST(CliRig, CertifyWritesWhatTheVerifierProves) {
  const Folder folder;
  simulate();
  EXPECT_EQ(run(kAsked + "--certify proof.json").code, 0);
  const Ran verified = cli::shell("rollfix-verify proof.json");
  EXPECT_EQ(verified.code, 0);
  EXPECT_THAT(verified.out, testing::StartsWith("proved: 1 set of first contacts, nothing else\npart "));
}

TEST(CliRig, SqueezedTakesItsErrorOrNot) {
  const Folder folder;
  simulate();
  EXPECT_THAT(run(kAsked + kSmall + "--squeezed --json").json()["squeezed"].dump(), HasSubstr("0.0872"));
  EXPECT_THAT(run(kAsked + kSmall + "--squeezed=60deg --json").json()["squeezed"].dump(), HasSubstr("1.04"));
}

TEST(CliRig, WhatSaysNothingIsRefusedWithTheReason) {
  const Folder folder;
  simulate();
  const auto refusal = [](const std::string& asked) {
    const Ran ran = run("locate gallery:cam " + asked);
    EXPECT_EQ(ran.code, 2);
    return ran.err;
  };
  write("encoder.csv", "time,psi\n0,1\n1,2\n");
  EXPECT_THAT(refusal("--log jaw.csv --log encoder.csv --finger jaw --finger wheel,r=0.3"),
              HasSubstr("says nothing of the part by itself"));
  EXPECT_THAT(refusal("--log jaw.csv --finger jaw --finger wheel,r=0.3"), HasSubstr("any place on the part fits"));
  EXPECT_THAT(refusal("--log pin.csv --finger wheel,r=0.3"), HasSubstr("expected fingers with skin first"));
  EXPECT_THAT(refusal("--log jaw.csv --log pin.csv --finger jaw --finger disk,r=0.3"), HasSubstr("wheel,r=R"));
  EXPECT_THAT(refusal("--log jaw.csv --log jaw.csv --finger jaw --finger wheel,r=0.3"),
              HasSubstr("a wheel has no skin"));
  EXPECT_THAT(refusal("--log jaw.csv --log pin.csv --finger jaw --finger wheel,0.3"), HasSubstr("as in wheel,r=0.4"));
  EXPECT_THAT(refusal("--log jaw.csv --finger jaw --squeezed"), HasSubstr("--squeezed"));
  EXPECT_THAT(refusal("--reading 1,2 --finger wheel,r=0.3"), HasSubstr("beside a finger with skin"));
}

/// The jaw turns by 4 rad from row to row, or by 2.3 rad the other way; the pin stays in front of it.
void write_rows_far_apart() {
  write("jaw.csv", "time,u,psi,x,y\n0,0,0,0,0\n1,-1,4,1,0\n2,-1.5,5,2,0\n");
  write("pin.csv", "time,x,y\n0,0,-3\n1,-1.27,1.96\n2,-0.88,-0.85\n");
}

TEST(CliRig, AnglesOfRowsFarApartAreAskedAbout) {
  const Folder folder;
  write_rows_far_apart();
  const Ran ran = run(kAsked + "--noise contact=0.3,angle=0.5,position=2 ");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("jaw.csv:3: psi goes from 0 to 4 in one row"));
  EXPECT_THAT(ran.err, HasSubstr("say it with --wrapped no, or --wrapped yes"));
}

TEST(CliRig, AWheelsEncoderIsAskedAboutToo) {
  const Folder folder;
  write("jaw.csv", "time,u,psi,x,y\n0,0,0,0,0\n1,-1,0.1,1,0\n2,-1.5,0.2,2,0\n");
  write("pin.csv", "time,psi,x,y\n0,0,0,-3\n1,4,0,-3.1\n2,5,0,-3.2\n");
  EXPECT_THAT(run(kAsked + "--noise contact=0.3,angle=0.5,position=2 ").err,
              HasSubstr("pin.csv:3: psi goes from 0 to 4 in one row"));
}

TEST(CliRig, WatchBeginsAnewWhereAnglesAreInDoubt) {
  const Folder folder;
  write_rows_far_apart();
  const std::string watch = "watch gallery:cam --log jaw.csv --log pin.csv --finger jaw --finger wheel,r=0.3 --once ";
  const std::string noise = "--noise contact=0.3,angle=0.5,position=2 ";
  EXPECT_THAT(run(watch + noise).err, HasSubstr("jaw.csv:3: whether psi is wrapped can't be told"));
  EXPECT_THAT(run(watch + noise + "--wrapped no").err, Not(HasSubstr("can't be told")));
}

TEST(CliRig, AnEmptyLogOfAPinIsToldItsHeader) {
  const Folder folder;
  simulate();
  write("pin.csv", "");
  EXPECT_THAT(run(kAsked).err, HasSubstr("a header such as 'time,x,y'"));
}

TEST(CliRig, AJawThatIsTurnedTheOtherWayIsSuspected) {
  const Folder folder;
  write("jaw.csv", "time,u,psi,x,y\n0,0,0,0,0\n1,0,0.1,0,0\n");
  write("pin.csv", "time,x,y\n0,0,5\n1,0,5\n");
  EXPECT_THAT(run(kAsked).err, HasSubstr("the unit of x and y, and the unit and the direction of psi"));
}

}  // namespace cli_rig_test
