// One part shared by many threads without a lock. The preset tsan watches that none of them writes what others read.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "documents/documents.hpp"
#include "rollfix/files.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/solve.hpp"

namespace sharing_test {
namespace {

using namespace rollfix;

constexpr std::size_t kThreads = 32;

Reading roll_on(const Part& part, double s, double length) {
  return {length, part.turning().angle(s + length) - part.turning().angle(s)};
}

std::string answer_to(const Problem& problem) { return answer_document(solve(problem), false).dump(); }

/// What each of so many threads has to say at the same time.
std::vector<std::string> said_at_once(const std::function<std::string()>& say) {
  std::vector<std::string> said(kThreads);
  std::vector<std::thread> threads;
  for (std::string& words : said) threads.emplace_back([&] { words = say(); });
  for (std::thread& thread : threads) thread.join();
  return said;
}

void expect_all_say_the_same(const std::function<std::string()>& say) {
  const std::vector<std::string> said = said_at_once(say);
  EXPECT_EQ(said, std::vector<std::string>(kThreads, say()));
}

class SharedPart : public testing::TestWithParam<std::string> {
 protected:
  const Part part{gallery(GetParam())};
};

}  // namespace

TEST_P(SharedPart, answers_one_finger_in_all_threads_alike) {
  expect_all_say_the_same([&] { return answer_to({part, roll_on(part, 1, 0.7)}); });
}

TEST_P(SharedPart, answers_two_fingers_in_all_threads_alike) {
  const double turn = roll_on(part, 1, 0.7).turn - roll_on(part, 3, -0.4).turn;
  Problem problem{part, Reading(0.7, -0.4, turn)};
  problem.facing = part.turning().angle(1) - part.turning().angle(3);
  expect_all_say_the_same([&] { return answer_to(problem); });
}

TEST_P(SharedPart, weighs_noise_in_all_threads_alike) {
  expect_all_say_the_same([&] { return answer_to({part, roll_on(part, 1, 0.7), {}, Noise{0.01, 0.01, 0, 0}}); });
}

TEST_P(SharedPart, is_reached_and_saved_in_all_threads_alike) {
  expect_all_say_the_same([&] {
    const Reach reach = reach_of(part, Finger(DiskFinger{0.1}));
    return std::to_string(reach.arcs.size()) + format_part(part);
  });
}

INSTANTIATE_TEST_SUITE_P(Gallery, SharedPart, testing::Values("cam", "stadium", "spline,n=9,seed=7,wobble=0.2"),
                         [](const auto& shape) { return shape.param.substr(0, shape.param.find(',')); });

TEST(CopiesOfAPart, are_made_and_dropped_while_others_ask_it) {
  const Part part(gallery("limacon"));
  expect_all_say_the_same([&] {
    const Part copy = part;
    return answer_to({copy, roll_on(copy, 2, 1.1)});
  });
}

}  // namespace sharing_test
