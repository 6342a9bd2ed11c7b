// Limits of time, memory and open files: a refusal with its reason. Not under the address sanitizer, which is slow,
// reserves terabytes and opens files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "cli.hpp"

namespace cli_limits_test {
namespace {

using testing::HasSubstr;

}  // namespace

TEST(OutlineAlongItself, is_refused_within_seconds) {
  const auto start = std::chrono::steady_clock::now();
  const cli::Ran ran = cli::run("inspect gallery:limacon,b=1e7");
  EXPECT_EQ(ran.code, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr("runs along itself too closely to tell near ("));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST(Memory, that_does_not_suffice_is_told_and_counts_as_undecided) {
  const cli::Ran ran = cli::shell(
      "ulimit -v 400000; rollfix simulate gallery:cam --finger disk,r=0.2 --start 1 --length 1 --samples 99999999");
  EXPECT_EQ(ran.code, 3) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("not enough memory"));
  EXPECT_EQ(ran.out, "");
}

TEST(OpenFiles, of_which_there_may_be_no_more_are_told) {
  const cli::Ran ran = cli::shell(
      "exec 3>&- 4>&- 5>&- 6>&-; ulimit -n 4; rollfix watch gallery:cam --finger disk,r=0.2 --noise angle=0.01 --log "
      "/dev/null --once");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("Too many open files"));
}

}  // namespace cli_limits_test
