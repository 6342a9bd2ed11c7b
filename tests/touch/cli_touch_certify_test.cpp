// `rollfix locate --touch ... --certify`, and the program that checks what it writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli.hpp"
#include "paths.hpp"

namespace cli_touch_certify_test {
namespace {

using cli::Folder;
using cli::Ran;
using cli::run;

const std::string kBracket = checked_out("examples/bracket.dxf");
const std::string kThree = "locate " + kBracket +
                           " --loop 1 --finger disk,r=3 --touch 106.476,94.401 --touch 158.015,50.015 "
                           "--touch 192.873,57.557 --certify proof.json ";

Ran verified() { return cli::shell("rollfix-verify proof.json"); }

TEST(CliTouchCertify, writes_what_the_verifier_proves_with_noise_and_within_a_tolerance) {
  const Folder folder;
  for (const char* how : {"--noise position=0.02", "--tolerance 0.09"}) {
    EXPECT_EQ(run(kThree + how + " --force").code, 0);
    EXPECT_EQ(verified().code, 0);
    EXPECT_THAT(verified().out, testing::StartsWith("proved: 2 sets of poses, nothing else\npart "));
  }
  EXPECT_THAT(verified().out, testing::HasSubstr("\nfinger disk, radius 3.0\ntouch at 106.476, 94.401 within 0.09\n"));
}

TEST(CliTouchCertify, proves_that_nothing_fits) {
  const Folder folder;
  EXPECT_EQ(run(kThree + "--touch 0,0 --tolerance 0.09").code, 1);
  EXPECT_EQ(verified().out.substr(0, verified().out.find('\n')), "proved: 0 sets of poses, nothing else");
}

TEST(CliTouchCertify, is_refused_where_the_answer_is_changed) {
  const Folder folder;
  run(kThree + "--noise position=0.02");
  const Ran changed =
      cli::shell("sed -i 's/\"radius\": 3.0/\"radius\": 3.01/' proof.json && rollfix-verify proof.json");
  EXPECT_EQ(changed.code, 1);
  EXPECT_THAT(changed.out, testing::StartsWith("refused: set 0, touch 0, off, in tolerances: stated "));
}

TEST(CliTouchCertify, says_what_certificates_are_not_of) {
  const Folder folder;
  const Ran one = run("locate " + kBracket + " --loop 1 --touch 1,2 --tolerance 0.1 --certify proof.json");
  EXPECT_EQ(one.code, 2);
  EXPECT_THAT(one.err, testing::HasSubstr("a certificate of touches: expected at least two contacts, found 1"));
}

TEST(CliTouchCertify, proves_that_a_roll_and_a_touch_far_from_it_fit_nowhere) {
  const Folder folder;
  run("simulate " + kBracket + " --loop 1 --finger disk,r=3 --start 10 --length 30 --samples 20 -o roll.csv");
  const Ran both = run("locate " + kBracket +
                       " --loop 1 --log roll.csv --roll all --touch 901,2 --finger disk,r=3 "
                       "--tolerance 0.1,1deg --certify proof.json");
  EXPECT_EQ(both.code, 1) << both.err;
  EXPECT_THAT(verified().out, testing::StartsWith("proved: 0 sets of poses, nothing else\n"));
}

}  // namespace
}  // namespace cli_touch_certify_test
