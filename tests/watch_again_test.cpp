// A wheel that is carried to another place of its course while its log goes on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "belief_cases.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/turning_function.hpp"
#include "rollfix/watch/watcher.hpp"

namespace watch_again_test {
namespace {

using rollfix::Part;
using rollfix::RollEnd;
using rollfix::Tracked;
using rollfix::app::Watcher;
using rollfix::app::WatchOptions;
using testing::ElementsAre;
using testing::HasSubstr;

Part course() { return belief_cases::part_of("spline,n=12,seed=5,wobble=0.3"); }

rollfix::Noise noise() { return {2e-4 * course().perimeter(), 2e-3, 5e-3, 0}; }

/// How the rolls ended, and with which answers.
struct Told {
  std::vector<Tracked> answers;
  std::vector<RollEnd> ends;
  std::vector<std::string> notes;
};

class Diary : public rollfix::app::WatchListener {
 public:
  void found(const Tracked& /*answer*/) override {}
  void changed(const Tracked& /*answer*/) override {}
  void over(const Tracked& answer, RollEnd why) override {
    told.answers.push_back(answer);
    told.ends.push_back(why);
  }
  void note(const std::string& message) override { told.notes.push_back(message); }
  bool is_ready() override { return true; }

  Told told;
};

/// Rows of a drive over so many laps.
std::vector<std::string> rows(double start, double laps, std::uint64_t seed) {
  const double P = course().perimeter();
  const auto drive =
      rollfix::noisy_increments(course(), start * P, laps * P, static_cast<std::size_t>(400 * laps), noise(), seed);
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < drive.s.size(); ++k) {
    lines.push_back(fmt::format("{},{}", drive.log.fingers[0].distance[k], drive.log.fingers[0].dturn[k]));
  }
  return lines;
}

Told watched(const std::vector<std::vector<std::string>>& drives, bool again) {
  WatchOptions options;
  options.name = "drive.csv";
  options.noise = noise();
  options.again = again;
  Diary diary;
  Watcher watcher(course(), options, diary);
  watcher.push("distance,dturn");
  for (const std::vector<std::string>& lines : drives) {
    for (const std::string& line : lines) watcher.push(line);
  }
  watcher.finish();
  return diary.told;
}

}  // namespace

TEST(WatchAgain, finds_a_wheel_that_was_carried_elsewhere) {
  const Told told = watched({rows(0.1, 1, 3), rows(0.6, 1.5, 4)}, true);
  EXPECT_THAT(told.ends, ElementsAre(RollEnd::elsewhere, RollEnd::ended));
  EXPECT_THAT(told.notes.front(), HasSubstr("contradict the roll so far"));
  const rollfix::Mode& last = told.answers.back().modes.front();
  const double P = course().perimeter();
  EXPECT_LT(rollfix::periodic_distance(last.end_mean[0], 0.1 * P, P), 5 * last.end_sd[0]);
}

TEST(WatchAgain, leaves_a_wheel_alone_that_stays_on_its_course) {
  EXPECT_THAT(watched({rows(0.1, 2, 3)}, true).ends, ElementsAre(RollEnd::ended));
}

TEST(WatchAgain, is_asked_for) {
  const Told told = watched({rows(0.1, 1, 3), rows(0.6, 1.5, 4)}, false);
  EXPECT_THAT(told.ends, ElementsAre(RollEnd::ended));
  const rollfix::Verdict& verdict = told.answers.back().verdict;
  EXPECT_TRUE(verdict.fits_badly || verdict.name == rollfix::Verdict::inconsistent);
}

}  // namespace watch_again_test
