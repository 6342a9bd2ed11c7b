// Long computations look up: what their pulse throws ends them, in whatever thread.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "rollfix/outline.hpp"
#include "rollfix/pulse.hpp"
#include "rollfix/question.hpp"
#include "rollfix/solve.hpp"

namespace pulse_test {
namespace {

using rollfix::Part;
using rollfix::Pulse;
using rollfix::Question;
using rollfix::Reading;
using Clock = std::chrono::steady_clock;

struct Enough {};

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Question question_of(std::size_t count) {
  const Part part(rollfix::gallery("spline"));
  std::vector<Reading> readings;
  for (std::size_t k = 1; k <= count; ++k) readings.emplace_back(1e-3 * static_cast<double>(k), 0.0);
  return {part, rollfix::Measurements{.readings = readings}};
}

TEST(Pulse, what_it_throws_ends_the_computation_and_comes_out_of_it) {
  const Pulse pulse([](const char* /*doing*/) { throw Enough(); });
  const auto build = [] {
    for (int k = 0; k < 100000; ++k) Part(rollfix::gallery("spline"));
  };
  EXPECT_THROW(build(), Enough);
}

TEST(Pulse, many_problems_end_in_the_middle_of_one) {
  const std::vector<Question> questions(200000, question_of(40));
  const Clock::time_point start = Clock::now();
  const Pulse pulse([&](const char* /*doing*/) {
    if (seconds_since(start) > 0.1) throw Enough();
  });
  EXPECT_THROW(solve(questions), Enough);
}

TEST(Pulse, is_told_what_is_being_done) {
  std::vector<std::string> told;
  const Pulse pulse([&](const char* doing) {
    if (doing != nullptr) told.emplace_back(doing);
  });
  for (int k = 0; k < 100000 && told.empty(); ++k) Part(rollfix::gallery("spline"));
  ASSERT_FALSE(told.empty());
  EXPECT_THAT(told.front(), testing::AnyOf("measuring the outline", "computing what the part is like"));
}

TEST(Pulse, of_an_inner_one_the_outer_one_goes_on_afterwards) {
  const Pulse outer([](const char* /*doing*/) {});
  {
    const Pulse inner([](const char* /*doing*/) {});
    EXPECT_EQ(Pulse::current(), &inner);
  }
  EXPECT_EQ(Pulse::current(), &outer);
}

}  // namespace
}  // namespace pulse_test
