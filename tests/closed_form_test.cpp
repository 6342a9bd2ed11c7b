// The integrated equations and the closed form which they imply.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <random>
#include <string>

#include "disk_rolls.hpp"
#include "integrated_rolls.hpp"
#include "random.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::closed_form_test {
namespace {

using namespace disk_rolls;
using integrated_rolls::integrated_roll;

struct Case {
  const char* shape;
  double radius;
  double start;  // share of the perimeter
  double laps;
};

void PrintTo(const Case& one, std::ostream* out) {
  *out << one.shape << " r=" << one.radius << " from " << one.start << " over " << one.laps;
}

class RollingCases : public testing::TestWithParam<Case> {};

TEST_P(RollingCases, integration_and_closed_form_agree) {
  const Case& one = GetParam();
  const Part part = part_of(one.shape);
  const RollPlan plan = by_distance(one.start * part.perimeter(), one.laps * part.perimeter(), 301);
  const Roll integrated = integrated_roll(part, {one.radius}, plan);
  const Roll closed = roll(part, {one.radius}, plan);
  EXPECT_LT(difference(integrated, closed, {one.radius}), 1e-9);
  EXPECT_NEAR(closed.s[0].back() - closed.s[0].front(), *plan.distance, 1e-12 * (1 + part.perimeter()));
}

TEST_P(RollingCases, readings_are_the_length_and_turn_of_the_boundary_between) {
  const Case& one = GetParam();
  const Part part = part_of(one.shape);
  const DiskFinger finger{one.radius};
  const Roll found = roll(part, finger, by_distance(one.start * part.perimeter(), one.laps * part.perimeter(), 97));
  for (std::size_t row = 1; row < found.s[0].size(); ++row) {
    const Reading reading = reading_at(found, finger, row);
    EXPECT_NEAR(reading.length[0], found.s[0][row] - found.s[0][0], 1e-9);
    constexpr double kNear = 1e-11;  // a corner's own place is known up to rounding
    const double before = part.turning().angle(found.s[0][row] - kNear) - found.angle[0][0];
    const double after = part.turning().angle(found.s[0][row] + kNear) - found.angle[0][0];
    EXPECT_GE(reading.turn, std::min(before, after) - 1e-9) << "row " << row;
    EXPECT_LE(reading.turn, std::max(before, after) + 1e-9) << "row " << row;
  }
}

INSTANTIATE_TEST_SUITE_P(Gallery, RollingCases,
                         testing::Values(Case{"circle", 0.3, 0.2, 0.7}, Case{"ellipse", 0.1, 0.123, 2.3},
                                         Case{"ellipse", 3, 0.9, -1.4}, Case{"superellipse", 0.1, 0.6, 1.1},
                                         Case{"limacon", 0.02, 0.123, 2.3}, Case{"limacon,a=1.05", 0.002, 0.2, -1.2},
                                         Case{"cam", 0.2, 0.5, 0.9}, Case{"gear", 0.02, 0.1, 1.5},
                                         Case{"spline", 0.1, 0.05, 2.1},
                                         Case{"spline,n=40,seed=3,wobble=0.05", 0.01, 0.77, -1.6},
                                         Case{"stadium", 0.5, 0, 1}, Case{"stadium", 0.1, 0.3, -2.3},
                                         Case{"rounded-rectangle", 0.1, 0.4, 1.2}, Case{"polygon", 0.1, 0.05, 1.7},
                                         Case{"polygon,n=3", 0.3, 0.4, -3.2}, Case{"reuleaux", 0.2, 0.1, 2.2},
                                         Case{"naca,digits=0012", 0.05, 0.9, 0.2}, Case{"log-spiral", 0.1, 0.1, 0.8},
                                         Case{"log-spiral", 0.1, 1, -1}, Case{"exponential", 0.2, 0, 1}));

TEST(Rolling, integration_and_closed_form_agree_on_random_splines) {
  std::mt19937_64 generator = test_generator(31);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < test_count(20); ++k) {
    const Part part = part_of("spline,n=12,wobble=0.1,seed=" + std::to_string(generator() % 100000));
    const DiskFinger finger{0.02 + 0.05 * share(generator)};
    const RollPlan plan = by_distance(share(generator) * part.perimeter(), 4 * (share(generator) - 0.5), 41);
    EXPECT_LT(difference(integrated_roll(part, finger, plan), roll(part, finger, plan), finger), 1e-9)
        << part.name() << " r=" << finger.radius << " start=" << plan.start << " distance=" << *plan.distance;
  }
}

}  // namespace
}  // namespace rollfix::closed_form_test
