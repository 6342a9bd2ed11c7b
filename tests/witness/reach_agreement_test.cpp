// What a finger can reach, compared with a dense polyline.
#include "rollfix/part.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

namespace reach_agreement_test {
namespace {

using namespace rollfix;
using shapes::kPi;

/// No point of a dense polyline is deeper in the disk than this. Depth by its definition: r less the distance.
double sampled_depth(const std::vector<Vec2>& boundary, const Vec2& centre, double r) {
  double nearest = 1e300;
  for (const Vec2& point : boundary) nearest = std::min(nearest, (point - centre).norm());
  return r - nearest;
}

Part random_spline(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> unit(0, 1);
  const int count = 6 + static_cast<int>(8 * unit(generator));
  const double wobble = 0.2 + 0.4 * unit(generator);
  std::vector<Vec2> through;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * kPi * (k + 0.5 * unit(generator)) / count;
    const double radius = 1 + wobble * (2 * unit(generator) - 1);
    through.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return Part(Outline{"random spline", spline_through(through, true), true}, {true});
}

}  // namespace

TEST(Reach, agrees_with_a_dense_polyline_on_random_splines) {
  std::mt19937_64 generator = test_generator(71);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr int kSamples = 4000;
  constexpr double kSlack = 1e-4;
  int blocked = 0;
  int free = 0;
  for (int round = 0; round < full_count(20); ++round) {
    const Part part = random_spline(generator);
    const double r = std::pow(10.0, 2 * unit(generator) - 1.5);
    const Reach reach = reach_of_disk(part, r, {.slack = kSlack});
    ASSERT_TRUE(reach.decided);
    const std::vector<Vec2> boundary = part.polyline(0, part.perimeter(), kSamples);
    // A chord of the polyline is within this of the boundary, or less: samples may miss that much.
    const double step = part.perimeter() / kSamples;
    const double missed = step * step * (1 / r + part.turning().most_curvature());
    for (int k = 0; k < 300; ++k) {
      const double s = part.perimeter() * unit(generator);
      const double angle = part.tangent(s);
      const double depth = sampled_depth(boundary, part.point(s) + r * Vec2(std::sin(angle), -std::cos(angle)), r);
      if (depth > kSlack * 1.001) {
        ++blocked;
        EXPECT_FALSE(reach.contains(s)) << "seed " << test_seed() << " round " << round << " s " << s << " r " << r;
      } else if (depth < kSlack - missed) {
        ++free;
        EXPECT_TRUE(reach.contains(s)) << "seed " << test_seed() << " round " << round << " s " << s << " r " << r;
      }
    }
  }
  EXPECT_GT(blocked, 100);
  EXPECT_GT(free, 100);
}

TEST(Reach, of_a_jaw_agrees_with_a_dense_polyline_on_random_splines) {
  std::mt19937_64 generator = test_generator(72);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr double kSlack = 1e-4;
  for (int round = 0; round < test_count(20); ++round) {
    const Part part = random_spline(generator);
    const Reach reach = reach_of_jaw(part, {.slack = kSlack});
    const std::vector<Vec2> boundary = part.polyline(0, part.perimeter(), 4000);
    for (int k = 0; k < 300; ++k) {
      const double s = part.perimeter() * unit(generator);
      const Vec2 normal(std::sin(part.tangent(s)), -std::cos(part.tangent(s)));
      double depth = 0;
      for (const Vec2& point : boundary) depth = std::max(depth, normal.dot(point - part.point(s)));
      if (depth > kSlack * 0.8 && depth < kSlack * 1.001) continue;
      EXPECT_EQ(reach.contains(s), depth < kSlack) << "seed " << test_seed() << " round " << round << " s " << s;
    }
  }
}

TEST(Reach, of_a_drawing_with_a_thousand_spirals_takes_few_tests) {
  const Part part(gallery("spline,n=300,seed=3"), {true});
  ASSERT_GT(part.turning().spirals().size(), 500U);
  EXPECT_LT(reach_of_disk(part, 0.1).tests, 2000000U);
}

}  // namespace reach_agreement_test
