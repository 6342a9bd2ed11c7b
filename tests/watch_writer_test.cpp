// What a watch prints: rows for people, an object per line for programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "rollfix/error.hpp"
#include "rollfix/watch/writer.hpp"
#include "watch_logs.hpp"

namespace watch_writer_test {

namespace {

using nlohmann::json;
using rollfix::Mode;
using rollfix::RollEnd;
using rollfix::Tracked;
using rollfix::app::NoteLimit;
using rollfix::app::WatchCounts;
using rollfix::app::WatchEnd;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using watching::cam;

struct Printed {
  std::ostringstream out;
  std::ostringstream err;
  std::unique_ptr<rollfix::app::WatchWriter> json_lines =
      rollfix::app::watch_jsonl(cam(), out, err, [] { return true; });
  std::unique_ptr<rollfix::app::WatchWriter> text = rollfix::app::watch_text(cam(), out, err, [] { return true; });

  std::vector<json> events() const {
    std::vector<json> all;
    std::istringstream lines(out.str());
    for (std::string line; std::getline(lines, line);) all.push_back(json::parse(line));
    return all;
  }
};

Tracked answer() {
  Tracked answer;
  answer.roll = 2;
  answer.samples = 7;
  answer.sample.line = 19;
  answer.sample.reading = {0.1 + 0.2, -1.0 / 3};
  answer.verdict = {rollfix::Verdict::ambiguous, 2};
  answer.modes.resize(2);
  Mode& first = answer.modes[0];
  first.start = 7.1;
  first.end = 0.2;
  first.tangent = 0.5 + 2 * std::numbers::pi;
  first.probability = 2.0 / 3;
  first.mean = 7.125;
  first.sd = 1.0 / 7;
  first.interval = rollfix::Interval{7.0, 7.7};
  first.end_mean = 0.25;
  first.end_sd = 0.3;
  answer.modes[1].start = 1;
  answer.modes[1].probability = 1.0 / 3;
  answer.rest = 1e-17;
  return answer;
}

}  // namespace

TEST(WatchJsonl, has_the_fields_of_locate_and_numbers_that_read_back) {
  Printed printed;
  printed.json_lines->changed(answer());
  ASSERT_EQ(printed.events().size(), 1U);
  const json event = printed.events().front();
  EXPECT_EQ(event["schema"], "rollfix/watch/1");
  EXPECT_EQ(event["event"], "placements");
  EXPECT_EQ(event["line"], 19);
  EXPECT_EQ(event["roll"], 2);
  EXPECT_EQ(event["samples"], 7);
  EXPECT_EQ(event["reading"]["length"][0].get<double>(), 0.1 + 0.2);
  EXPECT_EQ(event["reading"]["turn"].get<double>(), -1.0 / 3);
  EXPECT_EQ(event["verdict"], "ambiguous (2)");
  EXPECT_EQ(event["rest"].get<double>(), 1e-17);
  EXPECT_EQ(event["excess"], 1.0);
  ASSERT_EQ(event["placements"].size(), 2U);
  const json& first = event["placements"][0];
  EXPECT_EQ(first["start"], json({7.1}));
  EXPECT_EQ(first["end"], json({0.2}));
  EXPECT_EQ(first["probability"].get<double>(), 2.0 / 3);
  EXPECT_EQ(first["mean"], json({7.125}));
  EXPECT_EQ(first["sd"], json({1.0 / 7}));
  EXPECT_EQ(first["interval"], json({{7.0, 7.7}}));
  EXPECT_EQ(first["end_mean"], json({0.25}));
  EXPECT_EQ(first["end_sd"], json({0.3}));
  EXPECT_EQ(first["point"][0][0].get<double>(), cam().point(7.1).x());
  EXPECT_NEAR(first["tangent"][0].get<double>(), 0.5, 1e-15);
}

TEST(WatchJsonl, says_null_for_what_is_not_defined) {
  Printed printed;
  Tracked infinite = answer();
  infinite.modes[0].sd[0] = std::numeric_limits<double>::infinity();
  printed.json_lines->found(infinite);
  printed.json_lines->end(WatchEnd::signal, {}, {});
  EXPECT_TRUE(printed.events()[0]["time"].is_null());
  EXPECT_TRUE(printed.events()[0]["placements"][0]["sd"][0].is_null());
  EXPECT_TRUE(printed.events()[1]["verdict"].is_null());
  EXPECT_TRUE(printed.events()[1]["seconds_per_sample"].is_null());
}

TEST(WatchJsonl, begins_with_what_was_known_before) {
  Printed printed;
  rollfix::app::WatchOptions options;
  options.prior = rollfix::Prior{1.5, 0.25};
  printed.json_lines->begin(cam(), options);
  printed.json_lines->found(answer());
  EXPECT_EQ(printed.events().front()["prior"], json({1.5, 0.25}));
}

TEST(WatchJsonl, names_every_event) {
  Printed printed;
  printed.json_lines->begin(cam(), {});
  printed.json_lines->found(answer());
  for (const RollEnd why : {RollEnd::lost, RollEnd::jump, RollEnd::restarted, RollEnd::ended}) {
    printed.json_lines->over(answer(), why);
  }
  printed.json_lines->resumed({});
  for (const WatchEnd why : {WatchEnd::stream, WatchEnd::signal, WatchEnd::idle}) {
    printed.json_lines->end(why, answer(), {});
  }
  std::vector<std::string> names;
  for (const json& event : printed.events()) {
    EXPECT_EQ(event["schema"], "rollfix/watch/1");
    names.push_back(event["event"].get<std::string>() + event.value("why", ""));
  }
  EXPECT_THAT(names, testing::ElementsAre("begin", "found", "overlost", "overjump", "overrestarted", "overended",
                                          "resumed", "endstream", "endsignal", "endidle"));
}

TEST(WatchJsonl, ends_with_the_counts) {
  Printed printed;
  printed.json_lines->end(WatchEnd::stream, answer(), {10, 8, 3, 1, 2, 4e-6});
  const json event = printed.events().front();
  EXPECT_EQ(event["counts"], json({{"lines", 10}, {"samples", 8}, {"rolls", 3}, {"malformed", 1}, {"reconnects", 2}}));
  EXPECT_EQ(event["seconds_per_sample"].get<double>(), 4e-6 / 8);
}

TEST(WatchText, shows_the_places_the_most_probable_first) {
  Printed printed;
  printed.text->changed(answer());
  EXPECT_THAT(printed.out.str(),
              ContainsRegex("19 +- +0.3000 +-19.099 +ambiguous \\(2\\) +7.1000 +0.2000 +0.143 +66.7 %"
                            " +or 1.0000 \\(33.3 %\\)\n"));
}

TEST(WatchText, shows_the_last_row_of_a_roll_once) {
  Printed printed;
  printed.text->changed(answer());
  const std::string before = printed.out.str();
  printed.text->over(answer(), RollEnd::lost);
  const std::string more = printed.out.str().substr(before.size());
  EXPECT_THAT(more, HasSubstr("contact lost: roll 2 is over"));
  EXPECT_THAT(more, Not(HasSubstr("ambiguous")));
}

TEST(WatchText, shows_no_place_when_nothing_fits) {
  Printed printed;
  Tracked nothing = answer();
  nothing.verdict = {rollfix::Verdict::inconsistent};
  printed.text->changed(nothing);
  EXPECT_THAT(printed.out.str(), HasSubstr("inconsistent\n"));
}

TEST(WatchText, ends_with_why_nothing_fits) {
  Printed printed;
  Tracked nothing = answer();
  nothing.verdict = {rollfix::Verdict::inconsistent};
  rollfix::Diagnosis radius;
  radius.cause = rollfix::Cause::radius;
  radius.length_scale = 1.25;
  nothing.diagnoses = {radius};
  printed.text->end(WatchEnd::stream, nothing, {});
  EXPECT_THAT(printed.out.str(),
              HasSubstr("inconsistent: nothing fits\nlikeliest: all lengths are 1.25 times what was measured"));
  printed.json_lines->over(nothing, RollEnd::ended);
  EXPECT_THAT(printed.out.str(),
              AllOf(HasSubstr(R"("diagnosis":{"cause":"radius",)"), HasSubstr(R"("length_scale":1.25,)")));
}

TEST(WatchText, ends_with_a_summary) {
  Printed printed;
  printed.text->end(WatchEnd::stream, answer(), {10, 8, 1, 1, 2, 4e-6});
  EXPECT_EQ(printed.out.str(),
            "\nend of input: ambiguous (2)\n"
            "8 samples in 1 roll, 1 malformed line, 2 reconnects; 0.5 us per sample\n");
}

TEST(WatchNotes, go_to_stderr_and_not_all_of_them) {
  Printed printed;
  for (int k = 0; k < 100; ++k) printed.text->note("roll.csv:7: expected a number");
  EXPECT_EQ(printed.out.str(), "");
  EXPECT_EQ(printed.err.str(),
            "rollfix: roll.csv:7: expected a number\n"
            "rollfix: roll.csv:7: expected a number\n"
            "rollfix: roll.csv:7: expected a number\n");
}

TEST(WatchNotes, are_let_through_a_few_at_once_and_then_now_and_then) {
  NoteLimit limit;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t k = 0; k < NoteLimit::kAtOnce; ++k) EXPECT_EQ(limit.allow(start), 0U);
  for (int k = 0; k < 7; ++k) EXPECT_EQ(limit.allow(start), std::nullopt);
  EXPECT_EQ(limit.allow(start + NoteLimit::kOneMoreEvery), 7U);
  EXPECT_EQ(limit.allow(start + NoteLimit::kOneMoreEvery), std::nullopt);
  EXPECT_EQ(limit.allow(start + 100 * NoteLimit::kOneMoreEvery), 1U);
}

TEST(WatchWriter, that_cannot_write_says_so) {
  Printed printed;
  printed.out.setstate(std::ios::badbit);
  EXPECT_THROW(printed.text->changed(answer()), rollfix::InputError);
}

TEST(WatchWriter, shows_what_is_watched_before_anything_else_and_only_once) {
  Printed printed;
  printed.json_lines->begin(cam(), {});
  EXPECT_EQ(printed.out.str(), "");
  printed.json_lines->found(answer());
  printed.json_lines->show();
  ASSERT_EQ(printed.events().size(), 2U);
  EXPECT_EQ(printed.events()[0]["event"], "begin");
}

}  // namespace watch_writer_test
