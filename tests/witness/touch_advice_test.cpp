#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "outline/turn.hpp"
#include "random.hpp"
#include "rollfix/advise.hpp"
#include "touch/touch_cases.hpp"

// Advised touches against random ones, made by a simulator that knows the outline's points alone.
namespace touch_advice_test {

using namespace touch_cases;
using rollfix::Approach;
using rollfix::ExpectedTouch;
using rollfix::NextTouch;

/// Where a finger stops: the first place of its way that is as near to one of many points as its radius.
struct Stop {
  bool hits = false;
  Vec2 at = Vec2::Zero();
  double normal = 0;
};

Stop stop_of(const Part& part, const Pose& truth, double radius, const Approach& approach) {
  const Vec2 along(std::cos(approach.direction), std::sin(approach.direction));
  const int count = 3000;
  double first = std::numeric_limits<double>::infinity();
  Stop stop;
  for (int k = 0; k < count; ++k) {
    const double s = part.perimeter() * k / count;
    const Vec2 point = truth.world(part.point(s));
    const Vec2 off = point - approach.from;
    const double travel = off.dot(along);
    const double aside = off.x() * along.y() - off.y() * along.x();
    if (std::abs(aside) > std::max(radius, part.perimeter() / count)) continue;
    const double until = travel - std::sqrt(std::max(0.0, radius * radius - aside * aside));
    if (until < 0 || until >= first) continue;
    first = until;
    stop = {true, approach.from + until * along, part.tangent(s) + truth.heading - 0.5 * std::numbers::pi};
    if (radius > 0) {
      const Vec2 away = stop.at - point;
      stop.normal = std::atan2(away.y(), away.x());
    }
  }
  return stop;
}

/// A way from outside towards somewhere near the part.
Approach random_approach(const Part& part, const Pose& truth, std::mt19937_64& generator) {
  const double size = diagonal(part);
  const std::vector<Vec2> points = part.polyline(0, part.perimeter(), 100);
  Vec2 middle(0, 0);
  for (const Vec2& point : points) middle += truth.world(point) / static_cast<double>(points.size());
  const double angle = uniform(generator, 0, 2 * std::numbers::pi);
  const double aside = uniform(generator, -0.35, 0.35) * size;
  const Vec2 along(std::cos(angle), std::sin(angle));
  return {middle - size * along + aside * Vec2(-along.y(), along.x()), angle};
}

/// Tries a touch: it is one, or a clear path.
void try_touch(TouchProblem& problem, const Pose& truth, const Making& making, const Approach& approach,
               std::mt19937_64& generator) {
  const Stop stop = stop_of(problem.part, truth, making.radius, approach);
  const auto off = [&] { return Vec2(normal(generator, making.place_sd), normal(generator, making.place_sd)); };
  if (!stop.hits) {
    const double far = 2.5 * diagonal(problem.part);
    const Vec2 along(std::cos(approach.direction), std::sin(approach.direction));
    problem.clear.push_back({approach.from, approach.from + far * along});
    return;
  }
  MeasuredTouch touch;
  touch.at = stop.at + off();
  if (making.normals > 0) touch.normal = stop.normal + normal(generator, making.angle_sd);
  problem.touches.push_back(touch);
}

Part part_of(int which, std::mt19937_64& generator) {
  switch (which % 4) {
    case 0:
      return rollfix::load_part("gallery:spline,n=9,seed=" + std::to_string(which + 1) + ",wobble=0.25");
    case 1:
      return rollfix::load_part("gallery:naca,digits=2412");
    case 2:
      return random_polygon(generator);
    default:
      return bracket();
  }
}

constexpr int kMostTouches = 10;

/// Touches, misses among them: until there are two, and until one pose is left.
struct Count {
  int first_two = 0;
  int all = kMostTouches;
};

Count touches_until_unique(int which, bool is_advised, bool with_normals) {
  std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(which) + 700);
  const Part part = part_of(which, generator);
  const double size = diagonal(part);
  const Making making{0, with_normals ? 1U : 0U, 0.03 * size, 0.001 * size, rollfix::kDegree};
  const Pose truth{uniform(generator, -size, size), uniform(generator, -size, size), uniform(generator, -3, 3)};
  TouchProblem problem{part, {}, rollfix::disk(making.radius)};
  problem.noise.emplace();
  problem.noise->position = making.place_sd;
  problem.noise->angle = with_normals ? making.angle_sd : 0;
  problem.diagnose = false;
  std::optional<TouchAnswer> answer;
  Count result;
  for (int count = 1; count <= kMostTouches; ++count) {
    // Who touches at random goes for any pose that is left.
    const std::size_t poses = answer ? answer->poses.size() : 0;
    const Pose& aim = poses == 0 ? truth : answer->poses[generator() % poses].pose;
    Approach approach = random_approach(part, aim, generator);
    if (is_advised && answer) {
      const NextTouch next = rollfix::next_touch(*answer);
      if (next.helps) approach = next.advised().approach;
    }
    try_touch(problem, truth, making, approach, generator);
    if (problem.touches.empty()) continue;
    if (problem.touches.size() == 2 && result.first_two == 0) result.first_two = count;
    answer.emplace(rollfix::solve(problem));
    if (answer->verdict.name != rollfix::Verdict::unique) continue;
    result.all = count;
    break;
  }
  return result;
}

/// The table of docs/touch.md: --count=96.
TEST(TouchAdvice, AdvisedTouchesAreNoMoreThanRandomOnes) {
  for (const bool with_normals : {true, false}) {
    double random = 0, advised = 0, first = 0;
    const int cases = test_count(8);
    for (int c = 0; c < cases; ++c) {
      const Count of_random = touches_until_unique(c, false, with_normals);
      first += of_random.first_two;
      random += of_random.all;
      advised += touches_until_unique(c, true, with_normals).all;
    }
    std::printf("| %s | %d | %.2f | %.2f | %.2f |\n", with_normals ? "with normals" : "places", cases, first / cases,
                random / cases, advised / cases);
    EXPECT_LE((with_normals ? 1.1 : 1) * advised, random + 0.25 * cases);
  }
}

TEST(TouchAdvice, ItsExpectedTouchesAreWhereASimulatedFingerStops) {
  for (int c = 0; c < test_count(8); ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 800);
    const Part part = part_of(c, generator);
    const double size = diagonal(part), radius = 0.05 * size;
    const Case one = random_case(part, {2, 2, radius, 0.001 * size, rollfix::kDegree}, generator);
    const TouchAnswer answer = rollfix::solve(one.problem);
    if (answer.poses.size() < 2) continue;
    const NextTouch next = rollfix::next_touch(answer, {random_approach(part, one.truth, generator)});
    ASSERT_EQ(next.gains.size(), 1U);
    double sum = 0;
    for (const ExpectedTouch& expected : next.expected) {
      const Stop stop = stop_of(part, expected.pose, radius, next.advised().approach);
      sum += expected.probability;
      if (stop.hits != expected.hits) continue;  // it grazes
      EXPECT_NEAR((stop.at - expected.at).norm(), 0, 2e-3 * size) << "case " << c;
    }
    EXPECT_NEAR(sum, 1, 1e-9);
    EXPECT_GE(next.advised().bits, -1e-9);
    EXPECT_LE(next.advised().bits, next.bits_wanted + 1e-9);
  }
}

}  // namespace touch_advice_test
