#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "outline/turn.hpp"
#include "random.hpp"
#include "touch/touch_cases.hpp"

namespace touch_truth_test {

using namespace touch_cases;

/// Parts of all kinds, with their sizes between 2 and 80.
const std::vector<std::string> kParts = {"gallery:spline,n=9,wobble=0.25,seed=%",
                                         "gallery:spline,n=30,wobble=0.12,seed=%", "gallery:naca,digits=2412",
                                         "polygon", "bracket"};

struct Kind {
  std::size_t count;
  std::size_t normals;
  double radius;  // shares of the part's size
  double place;
  double degrees;
};
constexpr std::array<Kind, 9> kKinds = {{{2, 2, 0, 0.001, 1},
                                         {3, 3, 0, 0.01, 5},
                                         {4, 4, 0.04, 0.001, 1},
                                         {3, 0, 0, 0.001, 1},
                                         {5, 0, 0, 0.003, 1},
                                         {4, 0, 0.04, 0.001, 1},
                                         {4, 0, 0.04, 0.01, 1},
                                         {4, 1, 0.04, 0.001, 1},
                                         {3, 1, 0, 0.01, 5}}};

/// Calls `check` with cases of each kind on each part.
template <class Check>
void each_case(int count, const Check& check) {
  for (std::uint64_t k = 0; k < kKinds.size(); ++k) {
    const Kind& kind = kKinds[k];
    for (int number = 0; number < static_cast<int>(kParts.size()); ++number) {
      for (int c = 0; c < count; ++c) {
        std::mt19937_64 generator = test_generator(10000 * k + static_cast<std::uint64_t>(1000 * number + c));
        const Part part = part_named(kParts[static_cast<std::size_t>(number)], c + 1, generator);
        const double size = diagonal(part);
        const Making making{kind.count, kind.normals, kind.radius * size, kind.place * size,
                            kind.degrees * rollfix::kDegree};
        SCOPED_TRACE("kind " + std::to_string(k) + " on part " + std::to_string(number) + ", case " +
                     std::to_string(c));
        check(random_case(part, making, generator), making);
      }
    }
  }
}

TEST(TouchTruth, IsAmongThePosesOfNoisyTouches) {
  int cases = 0;
  int improbable = 0;
  each_case(test_count(2), [&](const Case& one, const Making&) {
    const TouchAnswer answer = rollfix::solve(one.problem);
    EXPECT_EQ(answer.status, rollfix::Status::complete);
    const bool is_listed = std::any_of(answer.poses.begin(), answer.poses.end(),
                                       [&](const TouchPose& pose) { return in_extent(pose, one.truth); });
    EXPECT_TRUE(is_listed || answer.improbable > 0) << answer.poses.size() << " poses";
    ++cases;
    improbable += is_listed ? 0 : 1;
  });
  EXPECT_LE(improbable, 1 + cases / 200);  // each of dozens of sets that are not listed is it once in ten thousand
}

TEST(TouchTruth, IsWithinAStatedTolerance) {
  int cases = 0;
  int incomplete = 0;
  each_case(test_count(1), [&](const Case& one, const Making& making) {
    TouchProblem problem = one.problem;
    problem.noise.reset();
    problem.tolerance = rollfix::TouchTolerance{4.5 * making.place_sd, 4.5 * making.angle_sd};
    const TouchAnswer answer = rollfix::solve(problem);
    const bool is_listed = std::any_of(answer.poses.begin(), answer.poses.end(),
                                       [&](const TouchPose& pose) { return in_extent(pose, one.truth); });
    // What could not be decided is told by the first touch's place.
    EXPECT_TRUE(is_listed || answer.status == rollfix::Status::incomplete) << answer.poses.size() << " poses";
    for (const TouchPose& pose : answer.poses) EXPECT_LE(pose.worst, 1);
    ++cases;
    incomplete += answer.status == rollfix::Status::incomplete ? 1 : 0;
  });
  EXPECT_LE(incomplete, 1 + cases / 20);
}

TEST(TouchTruth, IsFoundToTheRoundingOfExactTouches) {
  each_case(test_count(1), [](const Case& one, const Making& making) {
    std::mt19937_64 generator = test_generator(77);
    Making exact = making;
    exact.place_sd = exact.angle_sd = 0;
    exact.count = 5;
    const Case again = random_case(one.problem.part, exact, generator);
    TouchProblem problem = again.problem;
    problem.noise->position = 1e-5 * diagonal(problem.part);
    problem.noise->angle = 1e-5;
    const TouchAnswer answer = rollfix::solve(problem);
    ASSERT_FALSE(answer.poses.empty());
    const double size = diagonal(problem.part);
    double least = 1;
    for (const TouchPose& pose : answer.poses) {
      least = std::min(least, apart(pose.pose, again.truth, problem.part.point(0), size) / size);
    }
    EXPECT_LT(least, 1e-6);
  });
}

}  // namespace touch_truth_test
