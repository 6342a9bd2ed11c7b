// The exhaustive check of the two-finger search is itself checked: against closed forms, symmetry and planted pairs.

#include "pair_oracle.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "march_oracle.hpp"
#include "march_shapes.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

namespace pair_oracle_test {
namespace {

using pair_oracle::Boundary;
using pair_oracle::Exhaustive;
using pair_oracle::Root;
using pair_oracle::Scan;
using rollfix::Reading;

const std::vector<std::string> kShapes = {
    "ellipse", "ellipse,a=1,b=0.05", "superellipse", "limacon,a=1.05,b=1", "cam", "gear", "spline", "log-spiral"};

/// What two fingers read that start at s and t.
Reading reading_at(const Boundary& boundary, double s, double t, double length_a, double length_b) {
  return {length_a, length_b, boundary.phi(s, length_a) - boundary.phi(t, length_b)};
}

bool has(const Exhaustive& oracle, const Scan& scan, double s, double t) {
  const double near = 1e-8 * oracle.boundary().perimeter();
  return std::any_of(scan.roots.begin(), scan.roots.end(), [&](const Root& root) {
    return oracle.distance(root.s, s) < near + root.error && oracle.distance(root.t, t) < near + root.error;
  });
}

TEST(PairOracle, knows_the_tangent_as_well_as_the_one_finger_check_does) {
  for (const std::string& name : kShapes) {
    const rollfix::Outline outline = rollfix::gallery(name);
    const Boundary boundary(outline);
    const march_oracle::Exhaustive other(outline);
    EXPECT_NEAR(boundary.perimeter(), other.perimeter(), 1e-12 * other.perimeter());
    for (double share = outline.closed ? -1.5 : 0.01; share < (outline.closed ? 2.5 : 1); share += 0.0137) {
      const double s = share * boundary.perimeter();
      EXPECT_NEAR(boundary.angle(s) - boundary.angle(0), other.value(s), 1e-11) << name << " " << s;
      EXPECT_NEAR(boundary.rough(s).angle, boundary.angle(s), 1e-7) << name << " " << s;
    }
  }
}

TEST(PairOracle, finds_the_sixteen_pairs_of_an_ellipse_where_one_finger_rolls_at_a_time) {
  // Rolling a alone tells s, rolling b alone tells t. A turn's four places follow from one by symmetry: half a loop
  // further on, and mirrored, where the roll runs backward from its end.
  const Exhaustive oracle(rollfix::gallery("ellipse"));
  const double P = oracle.boundary().perimeter(), a = 0.11 * P, b = 0.23 * P, s = 0.04 * P, t = 0.31 * P;
  const Scan scan = oracle.scan({reading_at(oracle.boundary(), s, t, a, 0), reading_at(oracle.boundary(), s, t, 0, b)});
  EXPECT_EQ(scan.roots.size(), 16U);
  for (const double start_a : {s, s + P / 2, -s - a, P / 2 - s - a}) {
    for (const double start_b : {t, t + P / 2, -t - b, P / 2 - t - b}) {
      EXPECT_TRUE(has(oracle, scan, start_a, start_b)) << start_a << " " << start_b;
    }
  }
}

TEST(PairOracle, finds_the_four_pairs_of_an_ellipse_on_which_both_fingers_face_the_same_way) {
  // Both start at one place, so that their contacts afterwards are the ends of one roll of length La - Lb.
  const Exhaustive oracle(rollfix::gallery("ellipse"));
  const double P = oracle.boundary().perimeter(), a = 0.33 * P, b = 0.12 * P, s = 0.07 * P;
  const Scan scan = oracle.scan({reading_at(oracle.boundary(), s, s, a, b)}, 0.0);
  EXPECT_EQ(scan.roots.size(), 4U);
  for (const double start : {s, s + P / 2, -s - a - b, P / 2 - s - a - b}) {
    EXPECT_TRUE(has(oracle, scan, start, start)) << start;
  }
}

TEST(PairOracle, notices_a_near_double_root_and_resolves_one_that_is_less_near) {
  const Exhaustive oracle(rollfix::gallery("ellipse"));
  const Boundary& boundary = oracle.boundary();
  const double P = boundary.perimeter(), a = 0.1 * P;
  // The turn of a roll over the end of the long axis, its middle there, is the greatest of its length.
  Reading first = reading_at(boundary, -0.5 * a, 0, a, 0);
  const Reading second = reading_at(boundary, 0, 0.31 * P, 0, 0.23 * P);
  first.turn -= 1e-8;
  EXPECT_LE(oracle.scan({first, second}).nearest_miss, 2e-8);
  first.turn -= 1e-4;
  const Scan scan = oracle.scan({first, second});
  EXPECT_GT(scan.nearest_miss, 1e-6);
  EXPECT_EQ(scan.roots.size(), 16U);
  first.turn += 2e-4;
  EXPECT_TRUE(oracle.scan({first, second}).roots.empty());
}

class PairOracleShapes : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Gallery, PairOracleShapes, testing::ValuesIn(kShapes), shapes::as_identifier);

TEST_P(PairOracleShapes, finds_planted_pairs_and_an_even_number_of_them) {
  const rollfix::Outline outline = rollfix::gallery(GetParam());
  const Exhaustive oracle(outline);
  const Boundary& boundary = oracle.boundary();
  auto generator = test_generator(40);
  std::uniform_real_distribution<double> unit(0, 1);
  const double P = boundary.perimeter();
  int told = 0;
  for (int k = 0; k < test_count(4); ++k) {
    const double s = P * unit(generator), t = P * unit(generator);
    const auto roll = [&](double from) {
      return outline.closed ? (2 * unit(generator) - 1) * P : unit(generator) * P - from;
    };
    const double a1 = roll(s), b1 = roll(t), a2 = roll(s), b2 = roll(t);
    const Scan scan = oracle.scan({reading_at(boundary, s, t, a1, b1), reading_at(boundary, s, t, a2, b2)});
    if (scan.nearest_miss < pair_oracle::kHorizon) continue;
    ++told;
    EXPECT_TRUE(has(oracle, scan, s, t)) << s << " " << t;
    EXPECT_TRUE(!outline.closed || scan.roots.size() % 2 == 0) << scan.roots.size();
  }
  EXPECT_GT(told, 0);
}

}  // namespace
}  // namespace pair_oracle_test
