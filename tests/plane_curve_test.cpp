// The search for two rolls finds where any two curves meet that say what they are as a PlaneCurve: here antipodal
// pairs, of which closed forms and a scan know how many there are.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "antipodal_curve.hpp"
#include "outline/turn.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

namespace plane_curve_test {
namespace {

using antipodal::pairs;
using rollfix::load_part;
using rollfix::Part;
using rollfix::Vec2;
using rollfix::locating::PairCluster;
using rollfix::locating::PairPoint;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

constexpr double kAccurate = 1e-7;

PairPoint place_of(const PairCluster& pair) { return pair.exact ? pair.first : pair.roots.front().at; }

double width_of(const Part& part, const PairCluster& pair) {
  return (part.point(place_of(pair)[1]) - part.point(place_of(pair)[0])).norm();
}

/// Each pair is found from both of its ends.
bool is_from_first_end(const PairCluster& pair) { return place_of(pair)[0] < place_of(pair)[1]; }

/// How far apart the two are, each pair once, in order.
std::vector<double> widths(const Part& part) {
  std::vector<double> widths;
  for (const PairCluster& pair : pairs(part)) {
    if (is_from_first_end(pair)) widths.push_back(width_of(part, pair));
  }
  std::sort(widths.begin(), widths.end());
  return widths;
}

auto near(const std::vector<double>& expected) { return Pointwise(testing::DoubleNear(kAccurate), expected); }

/// A boundary with the support function 1 + e cos(2 m theta).
Part with_support(int m, double e) {
  std::vector<Vec2> points;
  const int count = 200 * m;
  for (int k = 0; k < count; ++k) {
    const double theta = 2 * std::numbers::pi * k / count;
    const double h = 1 + e * std::cos(2 * m * theta);
    const double slope = -2 * m * e * std::sin(2 * m * theta);
    points.emplace_back(h * std::cos(theta) - slope * std::sin(theta), h * std::sin(theta) + slope * std::cos(theta));
  }
  return Part({"support", rollfix::spline_through(points, true), true});
}

/// By a scan of all pairs of places in steps of P / n: Newton's method starts wherever a cell may hold a pair.
std::vector<Vec2> scanned(const Part& part, int n) {
  const double P = part.perimeter();
  const auto misfit = [&](double s, double t) {
    const double tangent = part.tangent(s);
    const Vec2 along(std::cos(tangent), std::sin(tangent));
    return Vec2(std::remainder(part.tangent(t) - tangent - std::numbers::pi, rollfix::kFullTurn),
                (part.point(t) - part.point(s)).dot(along) / P);
  };
  std::vector<double> tangents;
  std::vector<Vec2> points;
  for (int k = 0; k <= n; ++k) {
    tangents.push_back(part.tangent(k * P / n));
    points.push_back(part.point(k * P / n));
  }
  std::vector<Vec2> found;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      Vec2 least = Vec2::Constant(1e9);
      Vec2 most = -least;
      for (const auto& [a, b] : {std::pair(i, j), std::pair(i + 1, j), std::pair(i, j + 1), std::pair(i + 1, j + 1)}) {
        const auto s = static_cast<std::size_t>(a);
        const auto t = static_cast<std::size_t>(b);
        const Vec2 f(std::remainder(tangents[t] - tangents[s] - std::numbers::pi, rollfix::kFullTurn),
                     (points[t] - points[s]).dot(Vec2(std::cos(tangents[s]), std::sin(tangents[s]))) / P);
        least = least.cwiseMin(f);
        most = most.cwiseMax(f);
      }
      const Vec2 spread = most - least;
      if (((least - spread).array() > 0).any() || ((most + spread).array() < 0).any()) continue;
      Vec2 at((i + 0.5) * P / n, (j + 0.5) * P / n);
      for (int round = 0; round < 20; ++round) {
        const double h = 1e-6 * P;
        Eigen::Matrix2d jacobian;
        jacobian << (misfit(at.x() + h, at.y()) - misfit(at.x() - h, at.y())) / (2 * h),
            (misfit(at.x(), at.y() + h) - misfit(at.x(), at.y() - h)) / (2 * h);
        const Vec2 step = jacobian.inverse() * misfit(at.x(), at.y());
        at -= step.allFinite() ? step : Vec2::Zero();
      }
      if (!(misfit(at.x(), at.y()).norm() < 1e-10)) continue;
      at = {part.boundary().base(at.x()), part.boundary().base(at.y())};
      const auto is_it = [&](const Vec2& known) {
        return part.distance(known.x(), at.x()) + part.distance(known.y(), at.y()) < 1e-6 * P;
      };
      if (std::none_of(found.begin(), found.end(), is_it)) found.push_back(at);
    }
  }
  return found;
}

}  // namespace

TEST(PlaneCurve, of_an_ellipse_squeezes_along_its_axes) {
  EXPECT_THAT(widths(load_part("gallery:ellipse,a=2,b=1")), near({2, 4}));
}

TEST(PlaneCurve, of_a_limacon_squeezes_where_the_closed_form_says) {
  EXPECT_THAT(widths(load_part("gallery:limacon,a=4,b=2.5")), near({8, 9.166510938}));
}

TEST(PlaneCurve, of_a_support_function_with_2m_waves_has_2m_pairs) {
  for (const int m : {1, 2, 3, 5}) {
    const double e = 0.4 / (4 * m * m - 1);
    std::vector<double> expected;
    for (int k = 0; k < m; ++k) expected.push_back(2 - 2 * e);
    for (int k = 0; k < m; ++k) expected.push_back(2 + 2 * e);
    EXPECT_THAT(widths(with_support(m, e)), near(expected)) << m;
  }
}

TEST(PlaneCurve, of_a_circle_is_one_family_all_round) {
  const std::vector<PairCluster> found = pairs(load_part("gallery:circle,r=3"));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found.front().exact);
  EXPECT_THAT(found.front().whole_loop, ElementsAre(true, true));
}

TEST(PlaneCurve, of_a_rectangle_has_two_families_and_two_diagonals) {
  std::vector<double> of_families;
  std::vector<double> of_diagonals;
  const Part part = Part(shapes::polygon({{0, 0}, {4, 0}, {4, 3}, {0, 3}}));
  for (const PairCluster& pair : pairs(part)) {
    if (is_from_first_end(pair)) (pair.exact ? of_families : of_diagonals).push_back(width_of(part, pair));
  }
  std::sort(of_families.begin(), of_families.end());
  EXPECT_THAT(of_families, near({3, 4}));
  EXPECT_THAT(of_diagonals, near({5, 5}));
}

TEST(PlaneCurve, of_a_pentagon_has_five_heights_and_five_diagonals) {
  const double height = 1 + std::cos(std::numbers::pi / 5);
  const double diagonal = 2 * std::cos(std::numbers::pi / 10);
  std::vector<double> expected(5, height);
  expected.insert(expected.end(), 5, diagonal);
  EXPECT_THAT(widths(load_part("gallery:polygon,n=5,r=1")), near(expected));
}

TEST(PlaneCurve, of_wavy_parts_has_what_a_scan_of_all_pairs_finds) {
  auto generator = test_generator();
  for (int k = 0; k < test_count(4); ++k) {
    const std::string source = "gallery:spline,n=" + std::to_string(9 + k % 4) + ",wobble=0.25,seed=" +
                               std::to_string(std::uniform_int_distribution<int>(1, 9999)(generator));
    const Part part = load_part(source);
    const std::vector<Vec2> expected = scanned(part, 400);
    const std::vector<PairCluster> found = pairs(part);
    EXPECT_EQ(found.size(), expected.size()) << source << ", seed " << test_seed();
    for (const Vec2& pair : expected) {
      EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                              [&](const PairCluster& cluster) {
                                return part.distance(place_of(cluster)[0], pair.x()) +
                                           part.distance(place_of(cluster)[1], pair.y()) <
                                       kAccurate * part.perimeter();
                              }))
          << source << ", seed " << test_seed() << ": " << pair.transpose();
    }
  }
}

}  // namespace plane_curve_test
