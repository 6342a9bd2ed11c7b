// rollfix watch as it is used: from every kind of source, until it ends or is stopped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <thread>

#include "cli.hpp"
#include "watch_child.hpp"
#include "watch_logs.hpp"

namespace watch_program_test {

namespace {

using cli::Json;
using cli::run;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;
using watching::Child;
using watching::kHeader;
using watching::kOptions;
using watching::noisy_log;
using watching::noisy_rows;
using watching::text_of;
using watching::words_of;

/// The program that watches, printing JSON.
std::unique_ptr<Child> watch(const std::string& options) {
  return std::make_unique<Child>(words_of("watch " + kOptions + "--jsonl " + options));
}

std::vector<Json> events_of(const std::string& lines) {
  std::vector<Json> events;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) events.push_back(Json::parse(line));
  return events;
}

/// The place that is left is the one where the roll started.
void expect_found(const Json& answer, double start) {
  EXPECT_EQ(answer["verdict"], "unique");
  const Json& best = answer["placements"][0];
  EXPECT_LT(std::abs(best["mean"][0].get<double>() - start), 5 * best["sd"][0].get<double>());
}

/// Waits until all of so many samples have been heard of; needs --every 1.
Json answer_after(Child& child, std::size_t samples) {
  for (;;) {
    Json answer = child.next_event("placements");
    if (answer.is_null() || answer["samples"] == samples) return answer;
  }
}

void expect_clean_end(Child& child, const std::string& why) {
  const Json end = child.next_event("end");
  ASSERT_FALSE(end.is_null());
  EXPECT_EQ(end["why"], why);
  EXPECT_EQ(child.next_line(), "");
  EXPECT_EQ(child.wait(), 0);
}

}  // namespace

TEST(WatchProgram, reads_a_file_once_and_says_where_the_roll_started) {
  const cli::Folder folder;
  folder.write("roll.csv", noisy_log(2, 3, 500));
  const cli::Ran ran = run("watch " + kOptions + "--log roll.csv --once");
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ(ran.err, "");
  EXPECT_THAT(ran.out, StartsWith("part  gallery:cam, closed, perimeter 7.558250\nlog   roll.csv\n"));
  EXPECT_THAT(ran.out, HasSubstr("end of input: unique: roll 1 started at s = "));
  EXPECT_THAT(ran.out, HasSubstr("\n500 samples in 1 roll, 0 malformed lines, 0 reconnects; "));
  EXPECT_THAT(ran.out, EndsWith(" us per sample\n"));
}

TEST(WatchProgram, prints_the_same_whenever_a_file_is_read_once) {
  const cli::Folder folder;
  folder.write("roll.csv", noisy_log(2, 3, 500));
  const auto without_time = [](std::string text) { return text.substr(0, text.rfind("reconnects;")); };
  const std::string command = "watch " + kOptions + "--log roll.csv --once";
  EXPECT_EQ(without_time(run(command).out), without_time(run(command).out));
}

TEST(WatchProgram, prints_an_object_per_line) {
  const cli::Folder folder;
  folder.write("roll.csv", noisy_log(2, 3, 500));
  const cli::Ran ran = run("watch " + kOptions + "--log roll.csv --once --jsonl");
  const std::vector<Json> events = events_of(ran.out);
  ASSERT_GE(events.size(), 5U);
  EXPECT_EQ(events[0]["event"], "begin");
  EXPECT_EQ(events[0]["part"]["name"], "gallery:cam");
  EXPECT_EQ(events[0]["noise"]["contact"], 0.002);
  EXPECT_EQ(events[1]["event"], "found");
  EXPECT_EQ(events[2]["event"], "placements");
  expect_found(events[events.size() - 2], 2);
  EXPECT_EQ(events.back()["event"], "end");
  EXPECT_EQ(events.back()["counts"]["samples"], 500);
}

TEST(WatchProgram, starts_from_a_prior) {
  const cli::Folder folder;
  folder.write("roll.csv", noisy_log(2, 0.3, 100));
  const std::string command = "watch " + kOptions + "--log roll.csv --once --jsonl";
  EXPECT_THAT(events_of(run(command).out).back()["verdict"].get<std::string>(), StartsWith("ambiguous"));
  EXPECT_EQ(events_of(run(command + " --prior 2,0.1").out).back()["verdict"], "unique");
}

TEST(WatchProgram, says_what_it_knows_while_the_pipe_stays_open) {
  const auto child = watch("");
  child->send(noisy_log(2, 3, 500));
  for (Json answer = child->next_event("placements");; answer = child->next_event("placements")) {
    ASSERT_FALSE(answer.is_null());
    if (answer["samples"] == 500) break;
    if (answer["verdict"] == "unique" && answer["placements"][0]["sd"][0] < 0.02) break;
  }
  child->close_input();
  expect_found(child->next_event("over"), 2);
  expect_clean_end(*child, "stream");
}

TEST(WatchProgram, follows_a_file_until_it_is_stopped) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const cli::Folder folder;
    folder.write("roll.csv", "");
    const auto child = watch("--every 1 --log roll.csv");
    EXPECT_FALSE(child->next_event("begin").is_null());
    std::ofstream("roll.csv", std::ios::app) << noisy_log(2, 3, 400);
    expect_found(answer_after(*child, 400), 2);
    child->signal(signal);
    expect_clean_end(*child, "signal");
  }
}

TEST(WatchProgram, that_is_stopped_while_nobody_reads_says_the_rest_when_somebody_does) {
  const cli::Folder folder;
  folder.write("roll.csv", noisy_log(2, 3, 400));
  const auto child = watch("--every 1 --log roll.csv");
  EXPECT_FALSE(child->next_event("found").is_null());
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // until the pipe is full
  child->signal(SIGINT);
  std::this_thread::sleep_for(watching::kAWhile);
  expect_clean_end(*child, "signal");
}

TEST(WatchProgram, that_is_stopped_twice_ends_at_once) {
  const cli::Folder folder;
  folder.write("roll.csv", noisy_log(2, 3, 400));
  const auto child = watch("--every 1 --log roll.csv");
  EXPECT_FALSE(child->next_event("found").is_null());
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  child->signal(SIGINT);
  std::this_thread::sleep_for(watching::kAWhile);
  child->signal(SIGINT);
  EXPECT_EQ(child->wait(), -1);
}

TEST(WatchProgram, takes_a_file_that_is_written_anew_as_another_roll) {
  const cli::Folder folder;
  folder.write("roll.csv", noisy_log(2, 3, 400));
  const auto child = watch("--every 1 --log roll.csv");
  expect_found(answer_after(*child, 400), 2);
  folder.write("roll.csv", noisy_log(1, 3, 300));
  EXPECT_EQ(child->next_event("over")["why"], "restarted");
  expect_found(answer_after(*child, 300), 1);
  child->signal(SIGINT);
  expect_clean_end(*child, "signal");
}

TEST(WatchProgram, goes_on_when_a_dropped_connection_is_back) {
  watching::Server server;
  const auto child = watch("--every 1 --log " + server.name());
  const std::vector<std::string> rows = noisy_rows(2, 3, 400);
  server.accept();
  server.send(kHeader + "\n" + text_of({rows.begin(), rows.begin() + 150}) + "12.3,");
  EXPECT_FALSE(answer_after(*child, 150).is_null());
  server.drop();
  server.accept();
  server.send(text_of({rows.begin() + 150, rows.end()}));
  EXPECT_EQ(child->next_event("resumed")["counts"]["reconnects"], 1);
  expect_found(answer_after(*child, 400), 2);
  child->signal(SIGTERM);
  const Json over = child->next_event("over");
  EXPECT_EQ(over["roll"], 1);
  expect_clean_end(*child, "signal");
}

TEST(WatchProgram, reads_a_serial_device) {
  const watching::SerialLine line;
  const auto child = watch("--every 1 --baud 57600 --log " + line.name());
  EXPECT_FALSE(child->next_event("begin").is_null());
  line.send(kHeader + "\r\n");
  // Less than a serial line holds at once.
  const std::vector<std::string> rows = noisy_rows(2, 3, 60);
  for (const std::string& row : rows) line.send(row + "\r\n");
  EXPECT_FALSE(answer_after(*child, 60).is_null());
  child->signal(SIGINT);
  expect_clean_end(*child, "signal");
}

TEST(WatchProgram, stops_when_nothing_more_comes) {
  const auto child = watch("--idle-timeout 1");
  child->send(noisy_log(2, 3, 300));
  expect_clean_end(*child, "idle");
}

TEST(WatchProgram, says_by_its_exit_code_that_nothing_fits) {
  const cli::Folder folder;
  folder.write("roll.csv", noisy_log(2, 3, 500));
  const cli::Ran ran =
      run("watch gallery:circle,r=3 --finger disk,r=0.2 --noise contact=0.002,angle=0.003 --log roll.csv --once");
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.out, HasSubstr("end of input: inconsistent: nothing fits"));
}

TEST(WatchProgram, survives_lines_that_cannot_be_read) {
  const cli::Folder folder;
  std::vector<std::string> rows = noisy_rows(2, 3, 300);
  for (std::size_t k = 50; k < 300; k += 50) rows.insert(rows.begin() + static_cast<std::ptrdiff_t>(k), "what?");
  folder.write("roll.csv", kHeader + "\n" + text_of(rows));
  const cli::Ran ran = run("watch " + kOptions + "--log roll.csv --once --jsonl");
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 3) << ran.err;
  EXPECT_THAT(ran.err, StartsWith("rollfix: roll.csv:52: "));
  EXPECT_EQ(events_of(ran.out).back()["counts"]["malformed"], 5);
  EXPECT_EQ(events_of(ran.out).back()["counts"]["samples"], 300);
}

TEST(WatchProgram, that_has_nowhere_to_print_says_so) {
  if (!cli::fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const cli::Folder folder;
  folder.write("roll.csv", noisy_log(2, 3, 100));
  const cli::Ran ran = cli::shell("rollfix watch " + kOptions + "--log roll.csv --once > /dev/full");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("standard output"));
}

TEST(WatchProgram, that_finds_no_rows_says_so) {
  const cli::Ran ran = cli::shell("rollfix watch " + kOptions + " < /dev/null");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("standard input: expected rows with contact, found none in 0 lines"));
}

}  // namespace watch_program_test
