// Boundaries as polylines: as near to the curve as promised, with arc lengths that hold, and never too long.
#include "draw/trace.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "draw_helpers.hpp"
#include "random.hpp"

namespace draw_trace_test {
namespace {

using namespace rollfix::draw;
using rollfix::Vec2;

constexpr double kPi = std::numbers::pi;

double distance_to_segment(const Vec2& point, const Vec2& from, const Vec2& to) {
  const Vec2 edge = to - from;
  const double along = edge.squaredNorm() > 0 ? (point - from).dot(edge) / edge.squaredNorm() : 0;
  return (point - from - std::min(std::max(along, 0.0), 1.0) * edge).norm();
}

TEST(Trace, of_a_circle_stays_within_the_tolerance_everywhere) {
  const rollfix::Part part = draw_test::gallery_part("circle,r=2");
  const Trace circle = trace(part, 1e-3);
  for (int i = 0; i < 1000; ++i) {
    const double s = part.perimeter() * i / 1000.0;
    EXPECT_LT((point_at(circle, s) - Vec2(2 * std::cos(s / 2), 2 * std::sin(s / 2))).norm(), 1.6e-3);
  }
}

TEST(Trace, needs_few_vertices_for_a_tolerance_that_is_not_fine) {
  // A chord of angle phi strays r (1 - cos(phi / 2)), so that 2 pi / phi vertices suffice for that; a factor of two
  // for halving.
  const double tolerance = 1e-3, phi = 2 * std::acos(1 - tolerance);
  EXPECT_LT(trace(draw_test::gallery_part("circle"), tolerance).points.size(), 4 * kPi / phi + 8);
}

TEST(Trace, keeps_corners_exactly) {
  const rollfix::Part part = draw_test::gallery_part("polygon");
  const Trace polygon = trace(part, 0.01 * part.perimeter());
  for (const rollfix::Corner& corner : part.corners()) {
    EXPECT_LT((point_at(polygon, corner.s) - part.point(corner.s)).norm(), 1e-12 * part.perimeter());
  }
}

TEST(Trace, closes_where_it_began_and_an_open_one_does_not) {
  const Trace closed = trace(draw_test::gallery_part("ellipse"), 1e-3);
  const Trace open = trace(draw_test::gallery_part("log-spiral"), 1e-3);
  EXPECT_EQ(closed.points.front(), closed.points.back());
  EXPECT_GT((open.points.front() - open.points.back()).norm(), 0.1);
}

TEST(Trace, of_a_boundary_with_very_many_spirals_has_no_more_vertices_than_allowed) {
  const rollfix::Part part = draw_test::bumpy_part(20000);
  ASSERT_GT(part.turning().spirals().size(), 30000U);
  const Trace fine = trace(part, 1e-9, 5000);
  EXPECT_LE(fine.points.size(), 5000U);
  for (int i = 0; i < 200; ++i) {
    EXPECT_NEAR(point_at(fine, part.perimeter() * i / 200).norm(), 1, 0.01);
  }
}

TEST(Slice, may_go_round_more_than_once) {
  const Trace circle = trace(draw_test::gallery_part("circle"), 1e-4);
  const Trace roll = slice(circle, -1, 4 * kPi + 1);
  double length = 0;
  for (std::size_t i = 0; i + 1 < roll.points.size(); ++i) length += (roll.points[i + 1] - roll.points[i]).norm();
  EXPECT_NEAR(length, 4 * kPi + 2, 1e-2);
  EXPECT_TRUE(std::is_sorted(roll.s.begin(), roll.s.end()));
  for (std::size_t i = 0; i < roll.s.size(); ++i) {
    EXPECT_LT((roll.points[i] - Vec2(std::cos(roll.s[i]), std::sin(roll.s[i]))).norm(), 1e-3);
  }
}

TEST(Slice, of_an_open_boundary_ends_at_its_ends) {
  const Trace open = trace(draw_test::gallery_part("log-spiral"), 1e-3);
  const Trace all = slice(open, -5, open.length + 5);
  EXPECT_EQ(all.points.front(), open.points.front());
  EXPECT_EQ(all.points.back(), open.points.back());
}

TEST(Simplify, moves_a_random_walk_by_no_more_than_the_tolerance) {
  std::mt19937_64 generator = test_generator();
  std::normal_distribution<double> step(0, 0.1);
  std::vector<Vec2> walk = {Vec2(0, 0)};
  for (int i = 0; i < 3000; ++i) walk.emplace_back(walk.back() + Vec2(step(generator) + 0.05, step(generator)));
  const std::vector<std::size_t> kept = simplify(walk, 0.2);
  EXPECT_LT(kept.size(), 2500U);
  EXPECT_EQ(kept.front(), 0U);
  EXPECT_EQ(kept.back(), walk.size() - 1);
  for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
    for (std::size_t i = kept[k]; i <= kept[k + 1]; ++i) {
      EXPECT_LE(distance_to_segment(walk[i], walk[kept[k]], walk[kept[k + 1]]), 0.2 + 1e-12);
    }
  }
}

TEST(Densify, leaves_no_edge_longer_than_the_step_and_moves_nothing) {
  const Trace coarse = trace(draw_test::gallery_part("stadium"), 0.05);
  const Trace fine = densify(coarse, 0.01);
  for (std::size_t i = 0; i + 1 < fine.points.size(); ++i) {
    EXPECT_LE((fine.points[i + 1] - fine.points[i]).norm(), 0.01 + 1e-12);
    EXPECT_LT((point_at(coarse, fine.s[i]) - fine.points[i]).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace draw_trace_test
