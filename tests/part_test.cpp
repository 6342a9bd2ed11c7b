// What a part knows of its shape, and which outlines it refuses.

#include "rollfix/part.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

namespace part_test {
namespace {

using namespace rollfix;
using shapes::kPi;
using shapes::polygon;
using testing::AllOf;
using testing::HasSubstr;

std::string refusal(const Outline& outline, const PartOptions& options = {}) {
  try {
    const Part part(outline, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "taken";
}

/// x = u^2, y = u^3: a cusp at u = 0.
struct SemicubicalParabola {
  Interval domain() const { return {-1, 1}; }
  Jet jet(double u) const { return {{u * u, u * u * u}, {2 * u, 3 * u * u}, {2, 6 * u}, {0, 6}}; }
};

TEST(Part, of_an_ellipse_has_four_vertices_and_no_inflection) {
  const Part part(gallery("ellipse,a=2,b=1"));
  ASSERT_EQ(part.vertices().size(), 4U);
  EXPECT_TRUE(part.inflections().empty());
  for (const double s : part.vertices()) {
    EXPECT_NEAR(std::remainder(s, part.perimeter() / 4), 0, 1e-9 * part.perimeter());
  }
}

TEST(Part, of_a_dimpled_limacon_has_its_inflections_where_the_formula_has_them) {
  const Part part(gallery("limacon,a=1.5,b=1"));
  ASSERT_EQ(part.inflections().size(), 2U);
  const double cosine = -(1.5 * 1.5 + 2) / (3 * 1.5);  // a^2 + 2 b^2 + 3 a b cos u = 0
  for (const double s : part.inflections()) {
    const Vec2 point = part.point(s);
    EXPECT_NEAR(point.x() / point.norm(), cosine, 1e-9);
  }
}

TEST(Part, of_a_convex_limacon_has_no_inflection) {
  EXPECT_TRUE(Part(gallery("limacon,a=3,b=1")).inflections().empty());
}

TEST(Part, of_a_circle_and_a_stadium_has_no_vertices_at_all) {
  EXPECT_TRUE(Part(gallery("circle")).vertices().empty());
  EXPECT_TRUE(Part(gallery("stadium")).vertices().empty());
  EXPECT_TRUE(Part(gallery("stadium")).inflections().empty());
}

TEST(Part, of_a_gear_has_two_inflections_and_two_vertices_a_tooth) {
  const Part part(gallery("gear,teeth=7,r=1,depth=0.1"));
  EXPECT_EQ(part.inflections().size(), 14U);
  EXPECT_EQ(part.vertices().size(), 14U);
}

TEST(Part, knows_its_corners_by_place_and_turn) {
  const Part part(polygon({{0, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}}));
  ASSERT_EQ(part.corners().size(), 5U);
  EXPECT_EQ(part.corners()[0].s, 0);
  EXPECT_NEAR(part.corners()[1].turn, kPi / 2, 1e-15);
  EXPECT_NEAR(part.corners()[3].turn, -kPi / 2, 1e-15);  // concave
  EXPECT_EQ(part.turns(), 1);
}

TEST(Part, has_corners_exactly_as_far_apart_as_its_sides_are_long) {
  const std::vector<Vec2> points = {{0, 0}, {3, 0}, {3, 4}, {0, 4}, {-4, 1}};
  std::vector<Curve> sides;
  for (std::size_t k = 0; k < points.size(); ++k) sides.push_back(Line(points[k], points[(k + 1) % points.size()]));
  const Part part(Outline{"house", sides, true});
  const std::vector<double> places = {0, 3, 7, 10, 15};
  ASSERT_EQ(part.corners().size(), places.size());
  for (std::size_t k = 0; k < places.size(); ++k) EXPECT_EQ(part.corners()[k].s, places[k]);
}

TEST(Part, is_reversed_when_it_was_drawn_clockwise_and_keeps_its_first_point) {
  const Part part(polygon({{0, 0}, {0, 1}, {3, 1}, {3, 0}}));
  EXPECT_TRUE(part.reversed());
  EXPECT_EQ(part.turns(), 1);
  EXPECT_LT(part.point(0).norm(), 1e-15);
  EXPECT_LT((part.point(1) - Vec2(1, 0)).norm(), 1e-15);
  EXPECT_FALSE(Part(polygon({{0, 0}, {3, 0}, {3, 1}, {0, 1}})).reversed());
}

TEST(Part, that_is_reversed_takes_no_more_panels_where_the_curve_nearly_stops) {
  PartOptions options;
  options.allow_crossing = true;
  // Drawn clockwise; one of its spans almost has a cusp, where the reversed parameter is small and its original is not.
  const Part part(load_outline("gallery:spline,n=200,seed=3"), options);
  EXPECT_TRUE(part.reversed());
  EXPECT_LT(part.turning().panels().size(), 6000U);
}

TEST(Part, keeps_the_direction_of_an_open_curve) {
  const Part part(polygon({{0, 0}, {0, 1}, {3, 1}}, false));
  EXPECT_FALSE(part.reversed());
  EXPECT_NEAR(part.total_turn(), -kPi / 2, 1e-15);
  EXPECT_EQ(part.turns(), 0);
}

TEST(Part, counts_the_turns_of_a_crossing_outline) {
  PartOptions crossing;
  crossing.allow_crossing = true;
  EXPECT_EQ(Part(gallery("limacon,a=1,b=2"), crossing).turns(), 2);
  const Outline eight = polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}});
  EXPECT_EQ(Part(eight, crossing).turns(), 0);
}

TEST(Part, refuses_a_gap_and_says_where_and_how_wide) {
  Outline outline = polygon({{0, 0}, {2, 0}, {2, 2}});
  outline.curves[1] = Line(Vec2(2, 0.25), Vec2(2, 2));
  EXPECT_THAT(refusal(outline), AllOf(HasSubstr("curve 2"), HasSubstr("(2, 0)"), HasSubstr("0.25")));
}

TEST(Part, refuses_a_cusp_and_says_where) {
  EXPECT_THAT(refusal(Outline{"cusp", {Curve(SemicubicalParabola{})}, false}),
              AllOf(HasSubstr("cusp"), HasSubstr("(")));
  EXPECT_THAT(refusal(polygon({{0, 0}, {2, 0}, {1, 0}, {1, 1}})), HasSubstr("cusp"));
}

TEST(Part, refuses_a_crossing_and_says_where) {
  EXPECT_THAT(refusal(polygon({{0, 0}, {2, 2}, {2, 0}, {0, 2}})),
              AllOf(HasSubstr("(1, 1)"), HasSubstr("`allow_crossing`")));
  EXPECT_THAT(refusal(gallery("limacon,a=1,b=2")), HasSubstr("cross itself"));
}

TEST(Part, finds_a_crossing_far_from_every_point_given) {
  // A long thin hook whose tip pokes through its own shaft.
  EXPECT_THAT(refusal(polygon({{0, 0}, {10, 0}, {10, 1}, {3, 1}, {3, -1e-6}, {2.9, 1}, {0, 1}})), HasSubstr("(3"));
  EXPECT_EQ(refusal(polygon({{0, 0}, {10, 0}, {10, 1}, {3, 1}, {3, 1e-6}, {2.9, 1}, {0, 1}})), "taken");
}

TEST(Part, takes_sharp_corners_and_narrow_slots) {
  EXPECT_EQ(refusal(polygon({{0, 0}, {10, -0.01}, {10, 0.01}})), "taken");
  EXPECT_EQ(refusal(polygon({{0, 0}, {4, 0}, {4, 2}, {2.0001, 2}, {2, 0.1}, {1.9999, 2}, {0, 2}})), "taken");
  EXPECT_EQ(refusal(gallery("naca,digits=0006")), "taken");
  EXPECT_EQ(refusal(gallery("log-spiral,b=0.01,turns=9")), "taken");
}

TEST(Part, of_a_spline_through_points_on_straight_edges_has_no_spurious_events) {
  std::vector<Vec2> points;
  for (int edge = 0; edge < 4; ++edge) {
    const double angle = edge * kPi / 2 + 0.3;
    const Vec2 along(std::cos(angle), std::sin(angle));
    const Vec2 start = Vec2(std::sin(angle), -std::cos(angle)) - along;
    for (int k = 0; k < 10; ++k) points.emplace_back(start + along * (2.0 * k / 10));
  }
  const Part part(Outline{"square", spline_through(points, true, 59 * kPi / 180), true});
  EXPECT_EQ(part.corners().size(), 4U);
  EXPECT_TRUE(part.inflections().empty());
  EXPECT_TRUE(part.vertices().empty());
}

}  // namespace
}  // namespace part_test
