// A table of touches that grows: after each touch the answer of all so far, at the end what locate says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "cli.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/watch/watcher.hpp"
#include "touch/touch_cases.hpp"
#include "watch_child.hpp"

namespace watch_touches_test {

using namespace touch_cases;
using cli::Json;
using cli::run;
using rollfix::RollEnd;
using rollfix::app::TouchNews;
using rollfix::app::TouchWatcher;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kOptions = "gallery:cam --noise position=0.05,angle=3deg ";
const std::string kRows = "5,4.4,97deg\n4,3.2,160deg\n5.2,2,280deg\n6.2,3.1,10deg\n";
const std::string kTable = "x,y,normal\n" + kRows;

/// The events of one kind of a watch that reads such a table once.
std::vector<Json> events_of(const std::string& table, const std::string& kind, const std::string& more = "") {
  const cli::Folder folder;
  folder.write("touches.csv", table);
  std::istringstream lines(run("watch " + kOptions + "--log touches.csv --once --jsonl " + more).out);
  std::vector<Json> events;
  for (std::string line; std::getline(lines, line);) {
    const Json event = Json::parse(line);
    if (event["event"] == kind) events.push_back(event);
  }
  return events;
}

/// Of kTable, watched once for all tests.
std::vector<Json> usual_events(const std::string& kind) {
  static const std::vector<Json> kTouches = events_of(kTable, "touch");
  static const std::vector<Json> kOver = events_of(kTable, "over");
  return kind == "touch" ? kTouches : kOver;
}

void expect_said_by_locate(const Json& event, const std::string& table,
                           const std::vector<std::string>& fields = {"status", "verdict", "touches", "placements",
                                                                     "unresolved", "rest", "fit", "diagnosis"}) {
  const cli::Folder folder;
  folder.write("touches.csv", table);
  const Json located = run("locate " + kOptions + "--log touches.csv --json").json();
  for (const std::string& field : fields) EXPECT_EQ(event[field], located[field]) << field;
}

std::vector<std::size_t> numbers_of(const std::vector<Json>& events, const char* field) {
  std::vector<std::size_t> numbers;
  for (const Json& event : events) numbers.push_back(event[field]);
  return numbers;
}

TEST(WatchedTouches, end_with_what_locate_says) {
  const std::vector<Json> over = usual_events("over");
  ASSERT_EQ(over.size(), 1U);
  EXPECT_EQ(over[0]["why"], "ended");
  expect_said_by_locate(over[0], kTable);
}

TEST(WatchedTouches, are_told_one_after_the_other_with_the_answer_of_all_so_far) {
  const std::vector<Json> touches = usual_events("touch");
  EXPECT_THAT(numbers_of(touches, "samples"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(numbers_of(touches, "line"), ElementsAre(2, 3, 4, 5));
  expect_said_by_locate(touches[1], "x,y,normal\n5,4.4,97deg\n4,3.2,160deg\n",
                        {"verdict", "placements", "rest", "fit"});
}

TEST(WatchedTouches, are_told_every_so_many) {
  EXPECT_THAT(numbers_of(events_of(kTable, "touch", "--every 3"), "samples"), ElementsAre(3));
  EXPECT_THAT(numbers_of(events_of(kTable, "over", "--every 3"), "samples"), ElementsAre(4));
}

TEST(WatchedTouches, come_with_the_next_one_while_several_poses_are_left) {
  for (const Json& event : usual_events("touch")) {
    const bool is_ambiguous = event["verdict"].get<std::string>().rfind("ambiguous", 0) == 0;
    EXPECT_EQ(event["next"].is_object(), is_ambiguous) << event["verdict"];
    EXPECT_TRUE(!is_ambiguous || event["next"]["approach"].is_object() || event["next"]["why"].is_string());
  }
}

TEST(WatchedTouches, are_said_to_be_what_they_contradict_once_it_is_over) {
  const std::string table = "x,y,normal\n0,0,0deg\n1,0,0deg\n2,0,0deg\n3,0,90deg\n";
  const std::vector<Json> over = events_of(table, "over");
  ASSERT_EQ(over.size(), 1U);
  EXPECT_EQ(over[0]["verdict"], "inconsistent");
  expect_said_by_locate(over[0], table);
}

TEST(WatchedTouches, leave_out_lines_that_can_not_be_read) {
  const cli::Folder folder;
  folder.write("touches.csv", "x,y,normal\n5,4.4,97deg\n4,here,160deg\n4,3.2\n4,3.2,160deg\n");
  const cli::Ran ran = run("watch " + kOptions + "--log touches.csv --once");
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.err, HasSubstr("touches.csv:3: column y: expected a number, found 'here'"));
  EXPECT_THAT(ran.err, HasSubstr("touches.csv:4: expected 3 cells as in the header, found 2"));
  EXPECT_THAT(ran.out, HasSubstr("2 touches in 5 lines, 2 malformed lines"));
}

TEST(WatchedTouches, may_be_a_probes_reports) {
  const std::vector<Json> over = events_of("[PRB:5.000,4.400,0:1]\nok\n[PRB:5.000,4.400,0:1]\n", "over");
  ASSERT_EQ(over.size(), 1U);
  EXPECT_EQ(over[0]["samples"], 2);
}

TEST(WatchedTouches, end_with_an_exit_code) {
  const cli::Folder folder;
  folder.write("fits.csv", "x,y\n5,4.4\n");
  folder.write("none.csv", "x,y\n0,0\n900,0\n");
  folder.write("empty.csv", "x,y\n");
  const auto code = [](const std::string& log) { return run("watch " + kOptions + "--once --log " + log).code; };
  EXPECT_EQ(code("fits.csv"), 0);
  EXPECT_EQ(code("none.csv"), 1);
  EXPECT_EQ(code("empty.csv"), 2);
}

TEST(WatchedTouches, have_no_use_for_what_is_of_rolls) {
  const cli::Folder folder;
  folder.write("touches.csv", kTable);
  for (const char* option : {"--prior 1,0.1", "--direction cw"}) {
    const cli::Ran ran = run("watch " + kOptions + "--once --log touches.csv " + option);
    EXPECT_EQ(ran.code, 2);
    EXPECT_THAT(ran.err, HasSubstr("which do not roll and have no use for it")) << option;
  }
}

TEST(WatchedTouches, may_be_outliers) {
  const std::vector<Json> events = events_of(kTable, "touch", "--robust");
  EXPECT_EQ(events.back()["placements"][0]["outliers"], Json::array());
}

TEST(WatchedTouches, are_of_one_part) {
  const cli::Folder folder;
  folder.write("touches.csv", kTable);
  folder.write("list.txt", "gallery:cam\n");
  run("catalog build list.txt -o parts.db");
  const cli::Ran ran = run("watch --catalog parts.db --noise contact=0.1,angle=1deg --once --log touches.csv");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("ask rollfix identify"));
}

TEST(WatchedTouches, are_told_to_the_last_when_a_signal_stops_the_watch) {
  watching::Child child(watching::words_of("watch " + kOptions + "--jsonl"));
  child.send("x,y,normal\n5,4.4,97deg\n");
  EXPECT_EQ(child.next_event("touch")["samples"], 1);
  child.signal(SIGINT);
  EXPECT_EQ(child.next_event("over")["samples"], 1);
  EXPECT_EQ(child.next_event("end")["why"], "signal");
  EXPECT_EQ(child.wait(), 0);
}

/// Keeps what it is told.
struct Kept : rollfix::app::TouchListener {
  void touched(const TouchNews& news) override { samples.push_back(news.answer.touches.size()); }
  void no_more_touches(const TouchNews& /*news*/, RollEnd /*why*/) override { ++over; }
  void note(const std::string& message) override { notes.push_back(message); }

  std::vector<std::size_t> samples;
  int over = 0;
  std::vector<std::string> notes;
};

TEST(WatchedTouches, go_on_after_the_header_came_again_and_begin_anew_with_another_table) {
  Kept kept;
  rollfix::Noise noise;
  noise.position = 0.05;
  rollfix::app::TouchWatchOptions options{"log", {Part(rollfix::gallery("cam")), {}}};
  options.problem.noise = noise;
  TouchWatcher watcher(options, kept);
  for (const char* line : {"x,y", "5,4.4", "x,y", "5,4.4"}) watcher.push(line);
  watcher.restart();
  for (const char* line : {"x,y", "4,3"}) watcher.push(line);
  watcher.finish();
  EXPECT_THAT(kept.samples, ElementsAre(1, 2, 1));
  EXPECT_EQ(kept.over, 2);
  EXPECT_THAT(kept.notes, ElementsAre());
}

TEST(WatchedTouches, end_at_once_with_the_last_answer_when_a_search_is_stopped) {
  Kept kept;
  bool is_stopped = false;
  rollfix::app::TouchWatchOptions options{"log", {Part(rollfix::gallery("cam")), {}}};
  options.problem.noise = rollfix::Noise{.position = 0.05};
  options.is_stopped = [&] { return is_stopped; };
  TouchWatcher watcher(options, kept);
  for (const char* line : {"x,y", "5,4.4", "4,3"}) watcher.push(line);
  is_stopped = true;
  EXPECT_THROW(watcher.push("3,2"), rollfix::app::Stopped);
  watcher.finish();
  EXPECT_EQ(kept.over, 1);
  EXPECT_EQ(watcher.last()->answer.touches.size(), 2U);
}

}  // namespace watch_touches_test
