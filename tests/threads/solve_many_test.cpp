#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/question.hpp"
#include "rollfix/solve.hpp"

namespace solve_many_test {
namespace {

using namespace rollfix;

/// What rolls from places all around read, by the turning function alone.
std::vector<Reading> rolls_on(const Part& part, std::size_t count) {
  std::vector<Reading> readings;
  for (std::size_t k = 0; k < count; ++k) {
    const double s = part.perimeter() * static_cast<double>(k) / static_cast<double>(count);
    const double length = part.perimeter() * (0.05 + 0.4 * std::fmod(0.618 * static_cast<double>(k), 1.0));
    readings.emplace_back(length, part.turning().angle(s + length) - part.turning().angle(s));
  }
  return readings;
}

std::vector<Question> questions_of(const Part& part, const std::vector<Reading>& readings) {
  std::vector<Question> questions;
  for (const Reading& reading : readings) questions.emplace_back(part, Measurements{.readings = {reading}});
  return questions;
}

AnswerTable table_of(const Part& part, const std::vector<Reading>& readings, unsigned threads) {
  ManyOptions options;
  options.threads = threads;
  return solve_table(
      {part, Reading()}, readings.size(),
      [&](std::size_t k, Problem& problem) { problem.measured.readings[0] = readings[k]; }, 1, options);
}

TEST(SolveMany, answers_as_solve_does_one_after_the_other) {
  const Part part(gallery("spline,n=9,seed=7,wobble=0.2"));
  const std::vector<Reading> readings = rolls_on(part, 150);
  const std::vector<Outcome> many = solve(questions_of(part, readings), {.threads = 3});
  ASSERT_EQ(many.size(), readings.size());
  for (std::size_t k = 0; k < many.size(); ++k) {
    const Answer one = solve({part, readings[k]});
    ASSERT_TRUE(many[k].solution) << many[k].error;
    const Answer& of_many = *many[k].solution->roll();
    ASSERT_EQ(of_many.placements.size(), one.placements.size());
    for (std::size_t p = 0; p < one.placements.size(); ++p)
      EXPECT_EQ(of_many.placements[p].start[0], one.placements[p].start[0]);
  }
}

TEST(SolveMany, a_table_has_the_rows_of_each_answer) {
  const Part part(gallery("cam"));
  const std::vector<Reading> readings = rolls_on(part, 300);
  const AnswerTable table = table_of(part, readings, 2);
  ASSERT_EQ(table.problems(), readings.size());
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const Answer one = solve({part, readings[k]});
    const auto first = static_cast<std::size_t>(table.offsets[k]);
    ASSERT_EQ(static_cast<std::size_t>(table.offsets[k + 1]) - first, one.placements.size());
    EXPECT_EQ(table.verdict[k], one.verdict.name);
    for (std::size_t p = 0; p < one.placements.size(); ++p) {
      EXPECT_EQ(table.start[first + p], one.placements[p].start[0]);
      EXPECT_EQ(table.extent[2 * (first + p) + 1], one.placements[p].extent[0].hi);
      EXPECT_EQ(table.point[2 * (first + p)], one.placements[p].point[0].x());
    }
  }
}

TEST(SolveMany, any_number_of_threads_gives_the_same_bits) {
  const Part part(gallery("limacon"));
  const std::vector<Reading> readings = rolls_on(part, 500);
  const AnswerTable alone = table_of(part, readings, 1);
  for (const unsigned threads : {2U, 7U}) {
    const AnswerTable together = table_of(part, readings, threads);
    EXPECT_EQ(together.start, alone.start);
    EXPECT_EQ(together.offsets, alone.offsets);
  }
}

TEST(SolveMany, an_error_stays_with_its_problem) {
  const Part part(gallery("log-spiral"));
  const std::vector<Reading> readings = {{1, 0.1}, {std::nan(""), 1}, {1000, 1}, {2, 0.2}};
  const AnswerTable table = table_of(part, readings, 2);
  ASSERT_EQ(table.errors.size(), 2U);
  EXPECT_EQ(table.errors[0].first, 1U);
  EXPECT_EQ(table.errors[1].first, 2U);
  EXPECT_THAT(table.errors[0].second, testing::HasSubstr("nan"));
  EXPECT_EQ(table.offsets[1], table.offsets[3]);
  EXPECT_TRUE(std::isnan(table.tolerance[1]));
  const std::vector<Outcome> outcomes = solve(questions_of(part, readings));
  EXPECT_FALSE(outcomes[2].solution);
  EXPECT_TRUE(outcomes[3].solution);
}

TEST(SolveMany, stops_when_it_is_told_to) {
  const Part part(gallery("spline,n=9,seed=7,wobble=0.2"));
  const std::vector<Reading> readings(1000000, Reading(0.9977, 0.9936));
  ManyOptions options;
  options.threads = 2;
  std::size_t asked = 0;
  options.go_on = [&](std::size_t done) { return ++asked < 2 && done < readings.size(); };
  EXPECT_THROW(solve_table(
                   {part, Reading()}, readings.size(),
                   [&](std::size_t k, Problem& problem) { problem.measured.readings[0] = readings[k]; }, 1, options),
               InputError);
}

TEST(SolveMany, of_nothing_is_nothing) {
  const Part part(gallery("circle"));
  EXPECT_EQ(table_of(part, {}, 4).problems(), 0U);
  EXPECT_TRUE(solve(std::span<const Question>()).empty());
}

}  // namespace
}  // namespace solve_many_test
