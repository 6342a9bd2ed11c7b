// What a log that grows says, line by line, without files and without a clock.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "catalog/on_catalog.hpp"
#include "rollfix/error.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/watch/watcher.hpp"
#include "watch_logs.hpp"

namespace watcher_test {

namespace {

using rollfix::Mode;
using rollfix::RollEnd;
using rollfix::Tracked;
using rollfix::app::kLongestLine;
using rollfix::app::Watcher;
using rollfix::app::WatchOptions;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using watching::cam;
using watching::kHeader;
using watching::noisy_rows;

/// Writes down what it is told.
class Diary : public rollfix::app::WatchListener {
 public:
  void found(const Tracked& answer) override { happened.push_back("found " + std::to_string(answer.roll)); }
  void changed(const Tracked& answer) override { changes.push_back(answer); }
  void over(const Tracked& answer, RollEnd why) override {
    const char* const words[] = {"lost ", "jump ", "restarted ", "ended "};
    happened.push_back(words[static_cast<int>(why)] + std::to_string(answer.roll));
    answers.push_back(answer);
  }
  void note(const std::string& message) override { notes.push_back(message); }
  bool is_ready() override { return ready; }

  std::vector<std::string> happened;
  std::vector<Tracked> changes;
  std::vector<Tracked> answers;  // each roll's last
  std::vector<std::string> notes;
  bool ready = true;
};

WatchOptions options() {
  WatchOptions options;
  options.name = "roll.csv";
  options.fingers = {watching::kFinger};
  options.noise = watching::kNoise;
  return options;
}

/// A watch with what it told.
struct Watch {
  explicit Watch(const WatchOptions& how = options()) : watcher(cam(), how, diary) {}

  Watch& push(const std::string& line) {
    watcher.push(line);
    return *this;
  }
  Watch& push(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) push(line);
    return *this;
  }

  Diary diary;
  Watcher watcher;
};

std::vector<std::string> part_of(const std::vector<std::string>& rows, std::size_t from, std::size_t to) {
  const auto at = [&](std::size_t k) { return rows.begin() + static_cast<std::ptrdiff_t>(k); };
  return {at(from), at(to)};
}

void expect_same(const Tracked& a, const Tracked& b) {
  EXPECT_EQ(a.verdict.text(), b.verdict.text());
  ASSERT_EQ(a.modes.size(), b.modes.size());
  for (std::size_t k = 0; k < a.modes.size(); ++k) {
    // A roll that is over was looked at anew, on a grid of its own.
    EXPECT_NEAR(a.modes[k].mean[0], b.modes[k].mean[0], 1e-5);
    EXPECT_NEAR(a.modes[k].sd[0], b.modes[k].sd[0], 1e-5);
    EXPECT_NEAR(a.modes[k].probability, b.modes[k].probability, 1e-5);
  }
}

/// The one place that is left is the true one. Five standard deviations: seeds change.
void expect_found(const Tracked& answer, double start, double length) {
  EXPECT_EQ(answer.verdict.name, rollfix::Verdict::unique);
  ASSERT_FALSE(answer.modes.empty());
  const Mode& best = answer.modes.front();
  EXPECT_LT(best.sd[0], 0.02);
  EXPECT_LT(std::abs(best.mean[0] - start), 5 * best.sd[0]);
  EXPECT_LT(std::abs(best.end_mean[0] - (start + length)), 5 * best.end_sd[0]);
}

/// What was told while a log grew, with nothing at all in between.
Tracked answer_to(const std::vector<std::string>& rows) {
  Watch watch;
  watch.push(kHeader).push(rows).watcher.finish();
  return watch.diary.answers.back();
}

Tracked one_place(double mean, double sd, double probability) {
  Tracked answer;
  answer.verdict = {rollfix::Verdict::ambiguous, 2};
  answer.modes.resize(1);
  answer.modes[0].mean = mean;
  answer.modes[0].sd = sd;
  answer.modes[0].probability = probability;
  return answer;
}

}  // namespace

TEST(Watcher, tells_where_a_roll_started_and_where_the_finger_is) {
  Watch watch;
  watch.push(kHeader).push(noisy_rows(2, 3, 600)).watcher.finish();
  EXPECT_THAT(watch.diary.happened, ElementsAre("found 1", "ended 1"));
  expect_found(watch.diary.answers.back(), 2, 3);
  EXPECT_EQ(watch.watcher.counts().samples, 600U);
  EXPECT_EQ(watch.diary.answers.back().samples, 600U);
  EXPECT_EQ(watch.diary.answers.back().sample.line, 601U);
}

TEST(Watcher, tells_what_changes_and_not_every_sample) {
  Watch watch;
  watch.push(kHeader).push(noisy_rows(2, 3, 2000)).watcher.finish();
  EXPECT_GE(watch.diary.changes.size(), 3U);
  EXPECT_LE(watch.diary.changes.size(), 40U);
  for (std::size_t k = 1; k < watch.diary.changes.size(); ++k) {
    EXPECT_TRUE(is_news(watch.diary.changes[k - 1], watch.diary.changes[k], cam()));
  }
}

TEST(Watcher, tells_every_so_many_samples_when_asked_to) {
  WatchOptions every = options();
  every.every = 50;
  Watch watch(every);
  watch.push(kHeader).push(noisy_rows(2, 3, 220));
  ASSERT_THAT(watch.diary.changes, SizeIs(4));
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(watch.diary.changes[k].samples, 50 * (k + 1));
}

TEST(Watcher, gives_each_sample_its_due_however_rarely_it_tells) {
  WatchOptions rarely = options();
  rarely.every = 100000;
  Watch watch(rarely);
  const std::vector<std::string> rows = noisy_rows(2, 3, 300);
  watch.push(kHeader).push(rows).watcher.finish();
  EXPECT_THAT(watch.diary.changes, SizeIs(0));
  EXPECT_EQ(watch.diary.answers.back().samples, 300U);
  expect_found(watch.diary.answers.back(), 2, 3);
}

TEST(Watcher, comes_to_the_same_answer_however_often_it_works_it_out) {
  const std::vector<std::string> rows = noisy_rows(2, 3, 400);
  const Tracked by_default = answer_to(rows);
  for (const std::size_t every : {1U, 7U, 100000U}) {
    WatchOptions asked = options();
    asked.every = every;
    Watch watch(asked);
    watch.push(kHeader).push(rows).watcher.finish();
    const Tracked& answer = watch.diary.answers.back();
    EXPECT_EQ(answer.verdict, by_default.verdict);
    EXPECT_NEAR(answer.modes[0].mean[0], by_default.modes[0].mean[0], 0.1 * by_default.modes[0].sd[0]);
    EXPECT_NEAR(answer.modes[0].sd[0], by_default.modes[0].sd[0], 0.05 * by_default.modes[0].sd[0]);
  }
}

TEST(Watcher, skips_and_counts_what_cannot_be_read) {
  const std::vector<std::string> rows = noisy_rows(2, 3, 300);
  Watch watch;
  watch.push(kHeader).push(part_of(rows, 0, 100)).push("5.81,abc,2,1").push("1,2").push(part_of(rows, 100, 200));
  watch.push("1,nan,2,1").push(part_of(rows, 200, 300)).watcher.finish();
  expect_same(watch.diary.answers.back(), answer_to(rows));
  EXPECT_EQ(watch.watcher.counts().malformed, 3U);
  ASSERT_THAT(watch.diary.notes, SizeIs(3));
  EXPECT_THAT(watch.diary.notes[0], HasSubstr("roll.csv:102: "));
  EXPECT_THAT(watch.diary.notes[0], HasSubstr("abc"));
}

TEST(Watcher, counts_a_line_without_end_as_one_that_cannot_be_read) {
  const std::vector<std::string> rows = noisy_rows(2, 3, 300);
  const std::string beginning = rows[100] + std::string(kLongestLine, ' ');
  Watch watch;
  watch.push(kHeader).push(part_of(rows, 0, 100));
  watch.watcher.push(beginning);
  watch.push(part_of(rows, 100, 300)).watcher.finish();
  expect_same(watch.diary.answers.back(), answer_to(rows));
  EXPECT_EQ(watch.watcher.counts().malformed, 1U);
  ASSERT_THAT(watch.diary.notes, SizeIs(1));
  EXPECT_THAT(watch.diary.notes[0], HasSubstr("roll.csv:102: "));
  EXPECT_EQ(watch.diary.answers.back().sample.line, 302U);
}

TEST(Watcher, begins_anew_with_a_contact_that_was_lost_and_found_again) {
  Watch watch;
  watch.push(kHeader).push(noisy_rows(2, 3, 400)).push("900,0,0,0").push("901,0,0,0");
  EXPECT_THAT(watch.diary.happened, ElementsAre("found 1", "lost 1"));
  watch.push(noisy_rows(1, 3, 400, 1000)).watcher.finish();
  EXPECT_THAT(watch.diary.happened, ElementsAre("found 1", "lost 1", "found 2", "ended 2"));
  expect_found(watch.diary.answers[0], 2, 3);
  expect_found(watch.diary.answers[1], 1, 3);
  EXPECT_EQ(watch.watcher.counts().rolls, 2U);
  EXPECT_EQ(watch.watcher.counts().samples, 800U);
}

TEST(Watcher, looks_for_what_is_wrong_with_some_of_many_short_rolls_and_with_the_last) {
  WatchOptions exact = options();
  exact.noise.contact *= 0.1;
  exact.noise.angle *= 0.1;
  Watch watch(exact);
  watch.push(kHeader);
  for (int roll = 0; roll < 12; ++roll) {
    watch.push(noisy_rows(1, 2, 300, 100.0 * roll)).push(std::to_string(100 * roll + 90) + ",0,0,0");
  }
  watch.push(noisy_rows(1, 2, 300, 1200)).watcher.finish();
  std::size_t explained = 0;
  for (const Tracked& answer : watch.diary.answers) explained += answer.diagnoses.empty() ? 0 : 1;
  EXPECT_THAT(watch.diary.answers, SizeIs(13));
  EXPECT_LE(explained, 3U);
  EXPECT_FALSE(watch.diary.answers.front().diagnoses.empty());
  EXPECT_FALSE(watch.diary.answers.back().diagnoses.empty());
}

TEST(Watcher, goes_on_after_a_connection_that_dropped) {
  const std::vector<std::string> rows = noisy_rows(2, 3, 400);
  Watch watch;
  watch.push(kHeader).push(part_of(rows, 0, 150)).watcher.resume();
  watch.push(kHeader).push(part_of(rows, 150, 400)).watcher.finish();
  EXPECT_THAT(watch.diary.happened, ElementsAre("found 1", "ended 1"));
  expect_same(watch.diary.answers.back(), answer_to(rows));
  EXPECT_EQ(watch.watcher.counts().reconnects, 1U);
}

TEST(Watcher, takes_another_log_as_another_roll) {
  Watch watch;
  watch.push(kHeader).push(noisy_rows(2, 3, 400)).watcher.restart();
  watch.push("psi,u,time");
  watch.push("0,0,0").push("1,-0.5,1").watcher.finish();
  EXPECT_THAT(watch.diary.happened, ElementsAre("found 1", "restarted 1", "found 2", "ended 2"));
  expect_found(watch.diary.answers[0], 2, 3);
  EXPECT_EQ(watch.diary.answers[1].sample.line, 3U);
  EXPECT_NEAR(watch.diary.answers[1].sample.reading.length[0], 0.1, 1e-12);
}

TEST(Watcher, keeps_news_back_while_nobody_takes_it_and_then_tells_the_newest) {
  const std::vector<std::string> rows = noisy_rows(2, 3, 400);
  Watch watch;
  watch.diary.ready = false;
  watch.push(kHeader).push(rows);
  EXPECT_THAT(watch.diary.changes, SizeIs(0));
  EXPECT_TRUE(watch.watcher.is_behind());
  watch.diary.ready = true;
  watch.watcher.catch_up();
  ASSERT_THAT(watch.diary.changes, SizeIs(1));
  EXPECT_EQ(watch.diary.changes[0].samples, 400U);
  EXPECT_FALSE(watch.watcher.is_behind());
  expect_same(watch.diary.changes[0], answer_to(rows));
}

TEST(Watcher, that_is_live_makes_something_of_the_last_samples_before_more_come) {
  WatchOptions live = options();
  live.live = true;
  Watch watch(live);
  const std::vector<std::string> rows = noisy_rows(2, 3, 599);
  watch.push(kHeader).push(rows);
  watch.watcher.catch_up();
  EXPECT_FALSE(watch.watcher.is_behind());
  expect_same(watch.watcher.last_answer(), answer_to(rows));
}

TEST(Watcher, refuses_noise_that_cannot_be_before_anything_comes) {
  WatchOptions none = options();
  none.noise = {};
  EXPECT_THROW(Watch{none}, rollfix::InputError);
}

TEST(News, are_another_verdict_a_place_that_was_not_known_and_more_certainty) {
  const Tracked said = one_place(2, 0.1, 0.6);
  Tracked other_verdict = said;
  other_verdict.verdict = {rollfix::Verdict::unique, 1};
  EXPECT_TRUE(is_news(said, other_verdict, cam()));
  EXPECT_TRUE(is_news(said, one_place(2.11, 0.1, 0.6), cam()));
  EXPECT_TRUE(is_news(said, one_place(2, 0.049, 0.6), cam()));
  EXPECT_TRUE(is_news(said, one_place(2, 0.1, 0.71), cam()));
  EXPECT_TRUE(is_news(said, one_place(2, 0.1, 0.49), cam()));
  EXPECT_TRUE(is_news(Tracked{}, said, cam()));
}

TEST(News, are_not_what_hardly_differs) {
  const Tracked said = one_place(2, 0.1, 0.6);
  EXPECT_FALSE(is_news(said, said, cam()));
  EXPECT_FALSE(is_news(said, one_place(2.09, 0.051, 0.69), cam()));
}

TEST(News, are_not_a_step_across_the_seam) {
  const double P = cam().perimeter();
  EXPECT_FALSE(is_news(one_place(0.01, 0.1, 0.6), one_place(P - 0.01, 0.1, 0.6), cam()));
}

TEST(News, of_a_catalog_are_another_part_and_another_probability) {
  const auto likeliest = [](std::size_t part, double probability) {
    rollfix::Identified found;
    found.verdict = "2 parts";
    found.parts.push_back({{}, rollfix::solve({cam(), rollfix::Reading(1, 0.5)}), probability});
    found.parts.back().weight.part = part;
    return found;
  };
  const rollfix::Identified said = likeliest(3, 0.6);
  EXPECT_TRUE(rollfix::catalog::is_news_of_parts(said, likeliest(4, 0.6)));
  EXPECT_TRUE(rollfix::catalog::is_news_of_parts(said, likeliest(3, 0.71)));
  EXPECT_TRUE(rollfix::catalog::is_news_of_parts(said, likeliest(3, 0.49)));
  EXPECT_FALSE(rollfix::catalog::is_news_of_parts(said, likeliest(3, 0.69)));
}

TEST(News, are_not_where_nothing_fits) {
  Tracked said = one_place(2, 0.1, 0.6);
  Tracked now = one_place(3, 0.01, 0.9);
  said.verdict = now.verdict = {rollfix::Verdict::inconsistent};
  EXPECT_FALSE(is_news(said, now, cam()));
}

TEST(News, are_not_two_places_that_change_ranks) {
  Tracked said = one_place(2, 0.1, 0.51);
  said.modes.push_back(one_place(5, 0.1, 0.49).modes[0]);
  Tracked now = said;
  std::swap(now.modes[0], now.modes[1]);
  EXPECT_FALSE(is_news(said, now, cam()));
}

// --- A serial line, a connection: joined in the middle.

WatchOptions joined() {
  WatchOptions how = options();
  how.midway = true;
  return how;
}

TEST(WatcherMidway, half_a_row_before_the_header_is_skipped) {
  for (const std::string half : {"3,0.0712", "12,0.4,0.0712,1", "0712", ",1"}) {
    Watch watch(joined());
    watch.push(half).push(kHeader).push(noisy_rows(2, 3, 600)).watcher.finish();
    EXPECT_THAT(watch.diary.happened, ElementsAre("found 1", "ended 1")) << half;
    expect_found(watch.diary.answers.back(), 2, 3);
    EXPECT_EQ(watch.watcher.counts().malformed, 1U) << half;
    EXPECT_EQ(watch.diary.answers.back().sample.line, 602U) << half;
  }
}

TEST(WatcherMidway, rows_before_the_header_are_skipped_where_they_need_one) {
  Watch watch(joined());
  const std::vector<std::string> rows = noisy_rows(2, 3, 600);
  watch.push("0.4,1").push(part_of(rows, 0, 40)).push(kHeader).push(rows).watcher.finish();
  EXPECT_THAT(watch.diary.happened, ElementsAre("found 1", "ended 1"));
  expect_found(watch.diary.answers.back(), 2, 3);
  EXPECT_EQ(watch.watcher.counts().malformed, 41U);
}

TEST(WatcherMidway, a_header_that_comes_after_rows_that_need_none_is_taken) {
  Watch watch(joined());
  watch.push({"0.1,0.02", "0.1,0.02", "0.1,0.03"}).push(kHeader).push(noisy_rows(2, 3, 600)).watcher.finish();
  EXPECT_THAT(watch.diary.happened, ElementsAre("found 1", "restarted 1", "found 2", "ended 2"));
  expect_found(watch.diary.answers.back(), 2, 3);
}

TEST(WatcherMidway, rows_without_a_header_are_distance_and_dturn_all_the_same) {
  Watch watch(joined());
  watch.push({"0.1,0.02", "0.1,0.02", "0.1,0.03"}).watcher.finish();
  EXPECT_EQ(watch.watcher.counts().samples, 3U);
}

TEST(WatcherMidway, a_header_that_never_comes_is_asked_for) {
  Watch watch(joined());
  EXPECT_THROW(for (int k = 0; k < 1000; ++k) watch.push("0.1,0.02,0.3"), rollfix::InputError);
  Watch one_row(joined());
  one_row.push("0.1,0.02,0.3");
  EXPECT_THROW(one_row.watcher.finish(), rollfix::InputError);
}

TEST(WatcherMidway, what_is_no_text_before_the_header_is_skipped) {
  using namespace std::string_literals;
  for (const std::string& noise : {"\0\0\0"s, "\xFF\xFE"s, "\xF8\x00\xE1,\x03 3"s, "\x80u,psi"s + "\xFF"s}) {
    Watch watch(joined());
    watch.push(noise).push("\0\xFF"s + kHeader);
    watch.push(noisy_rows(2, 3, 600)).watcher.finish();
    EXPECT_THAT(watch.diary.happened, ElementsAre("found 1", "ended 1"));
    EXPECT_EQ(watch.watcher.counts().malformed, 1U);
    expect_found(watch.diary.answers.back(), 2, 3);
  }
}

}  // namespace watcher_test
