// Many problems in one file: an answer in each line, in order, errors in place, and an exit code that remembers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "cli.hpp"

namespace cli_batch_test {
namespace {

using cli::Folder;
using cli::Json;
using cli::run;
using testing::HasSubstr;

std::vector<Json> lines_of(const cli::Ran& ran) {
  std::vector<Json> lines;
  std::istringstream text(ran.out);
  for (std::string line; std::getline(text, line);) lines.push_back(Json::parse(line));
  return lines;
}

class Batch : public testing::Test {
 protected:
  cli::Ran answers_to(const std::string& problems, const std::string& options = "") {
    folder_.write("problems.jsonl", problems);
    return run("locate gallery:ellipse,a=2,b=1 --batch problems.jsonl" + options);
  }

 private:
  Folder folder_;
};

TEST_F(Batch, says_what_each_problem_alone_says) {
  const cli::Ran ran = answers_to(R"({"readings": [[1.0, 0.625]]}
{"readings": ["0.9,31.5deg"], "fingers": "disk,r=0.2"}
{"readings": [{"length": [1.0], "turn": 0.625}], "noise": {"contact": 0.01, "angle": 0.01}})");
  EXPECT_EQ(ran.code, 0);
  const std::vector<Json> lines = lines_of(ran);
  ASSERT_EQ(lines.size(), 3U);
  const std::string part = "locate gallery:ellipse,a=2,b=1 --json";
  EXPECT_EQ(lines[0], run(part + " --reading 1.0,0.625").json());
  EXPECT_EQ(lines[1], run(part + " --reading 0.9,31.5deg --finger disk,r=0.2").json());
  EXPECT_EQ(lines[2], run(part + " --reading 1.0,0.625 --noise contact=0.01,angle=0.01").json());
}

TEST_F(Batch, takes_an_answer_s_own_fields_again) {
  const Json answer =
      run("locate gallery:ellipse,a=2,b=1 --json --reading 1.0,0.625 --noise contact=0.01,angle=0.01").json();
  const Json problem = {{"readings", answer["readings"]}, {"noise", answer["noise"]}, {"prior", answer["prior"]}};
  EXPECT_EQ(lines_of(answers_to(problem.dump()))[0], answer);
}

TEST_F(Batch, refuses_brackets_so_deep_that_they_would_end_the_program) {
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  const cli::Ran ran = answers_to("{\"id\": " + deep + "}\n{\"readings\": " + deep + "}\n{\"readings\": [[1, 0.625]]}");
  EXPECT_EQ(ran.code, 2);
  const std::vector<Json> lines = lines_of(ran);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_THAT(lines[0]["error"].get<std::string>(),
              HasSubstr("problems.jsonl:1: expected a problem, found values nest"));
  EXPECT_THAT(lines[1]["error"].get<std::string>(), HasSubstr("problems.jsonl:2: "));
  EXPECT_EQ(lines[2]["status"], "complete");
}

TEST_F(Batch, keeps_errors_in_their_places_and_remembers_them) {
  const cli::Ran ran = answers_to(
      "{\"readings\": [[1, 0.6]], \"id\": \"a\"}\nnonsense\n{\"reading\": [[1, 2]], \"id\": 7}\n{}\n"
      "{\"log\": \"nowhere.csv\"}\n{\"readings\": [[1, 2, 3]]}\n{\"readings\": [[1, 0.6]]}");
  EXPECT_EQ(ran.code, 2);
  const std::vector<Json> lines = lines_of(ran);
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(lines[0]["id"], "a");
  EXPECT_THAT(lines[1]["error"], HasSubstr("problems.jsonl:2: not a JSON object"));
  EXPECT_THAT(lines[1]["error"].get<std::string>(), testing::Not(HasSubstr("json.exception")));
  EXPECT_THAT(lines[2]["error"], HasSubstr("did you mean 'readings'"));
  EXPECT_EQ(lines[2]["id"], 7);
  EXPECT_THAT(lines[3]["error"], HasSubstr("expected one of"));
  EXPECT_THAT(lines[4]["error"], HasSubstr("nowhere.csv"));
  EXPECT_THAT(lines[5]["error"], HasSubstr("problems.jsonl:6"));
  EXPECT_EQ(lines[6]["verdict"], "ambiguous (4)");
}

TEST_F(Batch, ends_with_the_code_of_what_fits_worst) {
  EXPECT_EQ(answers_to(R"({"readings": [[1, 0.6]]})").code, 0);
  EXPECT_EQ(answers_to("{\"readings\": [[1, 3.1]]}\n{\"readings\": [[1, 0.6]]}").code, 1);
  EXPECT_EQ(answers_to("{\"readings\": [[4.844, 3.1415]], \"budget\": 2}\n{\"readings\": [[1, 3.1]]}").code, 3);
}

TEST_F(Batch, has_parts_of_its_own_and_options_for_all) {
  const std::vector<Json> lines =
      lines_of(answers_to("{\"part\": \"gallery:cam\", \"readings\": [[0.4, 0.35]]}\n{\"readings\": [[1, 0.6]]}\n"
                          "{\"readings\": [[1, 0.6]], \"tolerance\": \"0.5deg\"}",
                          " --tolerance 0.001"));
  EXPECT_EQ(lines[0], run("locate gallery:cam --json --reading 0.4,0.35 --tolerance 0.001").json());
  EXPECT_EQ(lines[1]["tolerance"], 0.001);
  EXPECT_EQ(lines[2], run("locate gallery:ellipse,a=2,b=1 --json --reading 1,0.6 --tolerance 0.5deg").json());
}

TEST_F(Batch, refuses_what_it_has_no_use_for) {
  EXPECT_EQ(answers_to("{}", " --reading 1,2").code, 2);
  EXPECT_THAT(answers_to("{}", " -o x.svg").err, HasSubstr("leave -o out"));
  EXPECT_THAT(run("locate gallery:cam --batch nowhere.jsonl").err, HasSubstr("nowhere.jsonl"));
}

}  // namespace
}  // namespace cli_batch_test
