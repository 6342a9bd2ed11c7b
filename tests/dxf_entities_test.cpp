// DXF: each kind of entity becomes the curves that it stands for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "drawing_helpers.hpp"
#include "dxf_text.hpp"
#include "shapes.hpp"

namespace dxf_entities_test {
namespace {

using namespace dxf_text;
using drawings::area_of;
using drawings::kinds_of;
using drawings::length_of;
using drawings::numbers_of;
using rollfix::Drawing;
using rollfix::Vec2;
using shapes::kPi;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Rows = std::vector<std::vector<double>>;

/// The curve's points to within rounding, in order.
void expect_ends(const Drawing& drawing, std::size_t number, const Vec2& from, const Vec2& to, double slack = 1e-14) {
  const rollfix::Curve& curve = drawing.curves.at(number).curve;
  EXPECT_LE((curve.front() - from).norm(), slack) << curve.front().transpose();
  EXPECT_LE((curve.back() - to).norm(), slack) << curve.back().transpose();
}

TEST(DxfEntities, line_is_a_line_to_the_bit) {
  const Drawing drawing = parsed(file(line(0.1, -2.5e-3, 1e3, 0.30000000000000004)));
  EXPECT_THAT(kinds_of(drawing), ElementsAre("line"));
  EXPECT_EQ(numbers_of(drawing), (Rows{{0.1, -2.5e-3, 1e3, 0.30000000000000004}}));
  EXPECT_THAT(drawing.notes, IsEmpty());
}

TEST(DxfEntities, circle_is_one_arc_from_angle_0) {
  const Drawing drawing = parsed(file(circle(1, 2, 0.7)));
  EXPECT_THAT(kinds_of(drawing), ElementsAre("arc"));
  EXPECT_EQ(numbers_of(drawing), (Rows{{1, 2, 0.7, 0, 2 * kPi}}));
}

TEST(DxfEntities, arc_runs_counter_clockwise_from_its_start_angle) {
  const Drawing drawing = parsed(file(arc(1, 2, 3, 90, 180)));
  EXPECT_EQ(numbers_of(drawing), (Rows{{1, 2, 3, kPi / 2, kPi / 2}}));
  expect_ends(drawing, 0, {1, 5}, {-2, 2});
}

TEST(DxfEntities, arc_across_angle_0_takes_the_way_round) {
  expect_ends(parsed(file(arc(0, 0, 1, 270, 90))), 0, {0, -1}, {0, 1});
  EXPECT_NEAR(length_of(parsed(file(arc(0, 0, 1, 270, 90)))), kPi, 1e-14);
  EXPECT_NEAR(length_of(parsed(file(arc(0, 0, 1, 90, 0)))), 1.5 * kPi, 1e-14);
}

TEST(DxfEntities, arc_with_equal_angles_is_a_full_circle) {
  EXPECT_EQ(numbers_of(parsed(file(arc(0, 0, 1, 0, 360)))), (Rows{{0, 0, 1, 0, 2 * kPi}}));
  EXPECT_EQ(numbers_of(parsed(file(arc(0, 0, 1, 0, 0)))), (Rows{{0, 0, 1, 0, 2 * kPi}}));
}

TEST(DxfEntities, ellipse_keeps_its_parameters) {
  const Drawing drawing =
      parsed(file(record("ELLIPSE", {{10, 1}, {20, 2}, {11, 3}, {21, 0}, {40, 0.5}, {41, 0.25}, {42, 1.5}})));
  EXPECT_THAT(kinds_of(drawing), ElementsAre("elliptic-arc"));
  EXPECT_EQ(numbers_of(drawing), (Rows{{1, 2, 3, 0, 0, 1.5, 0.25, 1.25}}));
}

TEST(DxfEntities, full_ellipse_may_be_written_with_few_digits) {
  const Drawing drawing =
      parsed(file(record("ELLIPSE", {{10, 0}, {20, 0}, {11, 0}, {21, 2}, {40, 0.5}, {41, 0}, {42, 6.2831853072}})));
  EXPECT_EQ(numbers_of(drawing).at(0).back(), 2 * kPi);
  EXPECT_NEAR(area_of(drawing), 2 * kPi, 1e-13);
}

TEST(DxfEntities, ellipse_with_equal_axes_is_an_arc) {
  const Drawing drawing =
      parsed(file(record("ELLIPSE", {{10, 0}, {20, 0}, {11, 0}, {21, 2}, {40, 1}, {41, 0}, {42, kPi}})));
  EXPECT_THAT(kinds_of(drawing), ElementsAre("arc"));
  expect_ends(drawing, 0, {0, 2}, {0, -2});
}

TEST(DxfEntities, polyline_is_its_segments_in_order) {
  const std::vector<Corner> corners = {{0, 0}, {2, 0}, {2, 1}};
  const Rows open = {{0, 0, 2, 0}, {2, 0, 2, 1}};
  const Rows closed = {{0, 0, 2, 0}, {2, 0, 2, 1}, {2, 1, 0, 0}};
  EXPECT_EQ(numbers_of(parsed(file(light_polyline(corners, false)))), open);
  EXPECT_EQ(numbers_of(parsed(file(light_polyline(corners, true)))), closed);
  EXPECT_EQ(numbers_of(parsed(file(polyline(corners, 0)))), open);
  EXPECT_EQ(numbers_of(parsed(file(polyline(corners, 1)))), closed);
  EXPECT_EQ(numbers_of(parsed(file(polyline(corners, 1 | 8)))), closed) << "a 3D polyline that is flat";
}

TEST(DxfEntities, bulge_of_1_is_half_a_circle_to_the_right) {
  const Drawing drawing = parsed(file(light_polyline({{0, 0, 1}, {2, 0, 1}}, true)));
  EXPECT_THAT(kinds_of(drawing), ElementsAre("arc", "arc"));
  expect_ends(drawing, 0, {0, 0}, {2, 0});
  expect_ends(drawing, 1, {2, 0}, {0, 0});
  EXPECT_NEAR(area_of(drawing), kPi, 1e-14);
  EXPECT_NEAR(drawing.curves[0].curve.position(kPi / 2).y(), -1, 1e-15);
}

TEST(DxfEntities, bulge_below_0_runs_clockwise) {
  const Drawing drawing = parsed(file(polyline({{0, 0, -1}, {2, 0, -1}}, 1)));
  EXPECT_NEAR(area_of(drawing), -kPi, 1e-14);
  EXPECT_NEAR(drawing.curves[0].curve.position(kPi / 2).y(), 1, 1e-15);
}

TEST(DxfEntities, bulge_is_the_tangent_of_a_quarter_of_the_sweep) {
  for (const double sweep : {0.01, 0.3, 1.0, 2.0, 3.0, 4.0, 6.0}) {
    const double bulge = std::tan(sweep / 4);
    const Drawing drawing = parsed(file(light_polyline({{1, 2, bulge}, {4, 6}}, false)));
    const double radius = 2.5 / std::sin(sweep / 2);
    EXPECT_NEAR(length_of(drawing), radius * sweep, 1e-13 * radius);
    expect_ends(drawing, 0, {1, 2}, {4, 6}, 1e-15 * (radius + 10));
  }
}

TEST(DxfEntities, bulge_that_rounding_hides_is_a_line) {
  EXPECT_THAT(kinds_of(parsed(file(light_polyline({{0, 0, 1e-9}, {2, 0}}, false)))), ElementsAre("line"));
  EXPECT_THAT(kinds_of(parsed(file(light_polyline({{0, 0, 1e-6}, {2, 0}}, false)))), ElementsAre("arc"));
  EXPECT_THAT(kinds_of(parsed(file(light_polyline({{1e9, 0, 1e-6}, {1e9 + 0.125, 0}}, false)))), ElementsAre("line"));
}

TEST(DxfEntities, widths_of_a_polyline_are_left_out_with_a_note) {
  const Drawing drawing = parsed(file(light_polyline({{0, 0}, {2, 0}}, false, {{43, 0.5}})));
  EXPECT_EQ(drawing.curves.size(), 1U);
  EXPECT_THAT(drawing.notes, ElementsAre(HasSubstr("the widths of 1 polyline")));
}

TEST(DxfEntities, frame_of_a_spline_fit_polyline_is_not_drawn) {
  std::string text = record("POLYLINE", {{66, 1}, {70, 4}});
  text += record("VERTEX", {{10, 0}, {20, 0}, {70, 8}});
  text += record("VERTEX", {{10, 50}, {20, 50}, {70, 16}});
  text += record("VERTEX", {{10, 1}, {20, 0}, {70, 8}});
  const Drawing drawing = parsed(file(text + record("SEQEND", {})));
  EXPECT_EQ(numbers_of(drawing), (Rows{{0, 0, 1, 0}}));
  EXPECT_THAT(drawing.notes, ElementsAre(HasSubstr("1 polyline stands for a spline")));
}

const Numbers kQuarterCircle = {{70, 8},
                                {71, 2},
                                {72, 6},
                                {73, 3},
                                {74, 0},
                                {40, 0},
                                {40, 0},
                                {40, 0},
                                {40, 1},
                                {40, 1},
                                {40, 1},
                                {41, 1},
                                {41, std::sqrt(0.5)},
                                {41, 1},
                                {10, 1},
                                {20, 0},
                                {10, 1},
                                {20, 1},
                                {10, 0},
                                {20, 1}};

TEST(DxfEntities, spline_with_weights_draws_a_circle) {
  const Drawing drawing = parsed(file(record("SPLINE", kQuarterCircle)));
  EXPECT_THAT(kinds_of(drawing), ElementsAre("rational-bezier"));
  EXPECT_NEAR(length_of(drawing), kPi / 2, 1e-14);
  expect_ends(drawing, 0, {1, 0}, {0, 1});
}

TEST(DxfEntities, control_points_win_over_fit_points) {
  Numbers both = kQuarterCircle;
  both[4] = {74, 2};
  both.insert(both.end(), {{11, 7}, {21, 7}, {11, 8}, {21, 8}});
  const Drawing drawing = parsed(file(record("SPLINE", both)));
  EXPECT_NEAR(length_of(drawing), kPi / 2, 1e-14);
  EXPECT_THAT(drawing.notes, IsEmpty());
}

TEST(DxfEntities, spline_of_degree_1_is_lines) {
  const Drawing drawing = parsed(file(record(
      "SPLINE",
      {{71, 1}, {40, 0}, {40, 0}, {40, 1}, {40, 2}, {40, 2}, {10, 0}, {20, 0}, {10, 1}, {20, 0}, {10, 1}, {20, 1}})));
  EXPECT_EQ(numbers_of(drawing), (Rows{{0, 0, 1, 0}, {1, 0, 1, 1}}));
}

TEST(DxfEntities, fit_points_alone_are_joined_by_a_cubic_spline_with_a_note) {
  const Numbers points = {{11, 0}, {21, 0}, {11, 1}, {21, 1}, {11, 2}, {21, 0}, {11, 1}, {21, -1}};
  Numbers open = {{70, 8}, {71, 3}, {74, 4}};
  Numbers closed = {{70, 9}, {71, 3}, {74, 4}};
  open.insert(open.end(), points.begin(), points.end());
  closed.insert(closed.end(), points.begin(), points.end());
  const Drawing drawing = parsed(file(record("SPLINE", open)));
  EXPECT_THAT(kinds_of(drawing), ElementsAre("cubic", "cubic", "cubic"));
  expect_ends(drawing, 1, {1, 1}, {2, 0});
  EXPECT_THAT(drawing.notes, ElementsAre(HasSubstr("1 spline has fit points only")));
  EXPECT_EQ(parsed(file(record("SPLINE", closed))).curves.size(), 4U);
}

TEST(DxfEntities, fit_points_make_no_corners) {
  // Chords that turn by 120 degrees.
  const Drawing drawing = parsed(
      file(record("SPLINE", {{70, 9}, {71, 3}, {11, 0}, {21, 0}, {11, 1}, {21, 0}, {11, 0.5}, {21, std::sqrt(0.75)}})));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 before = drawing.curves[k].curve.jet(1).first.normalized();
    const Vec2 after = drawing.curves[(k + 1) % 3].curve.jet(0).first.normalized();
    EXPECT_LE((before - after).norm(), 1e-14);
  }
}

TEST(DxfEntities, what_has_no_length_is_left_out_and_counted) {
  const std::string text = line(1, 1, 1, 1) + circle(0, 0, 0) + light_polyline({{0, 0}, {0, 0}, {1, 0}}, false) +
                           light_polyline({{5, 5}}, true) + record("POLYLINE", {{70, 0}}) + record("SEQEND", {});
  const Drawing drawing = parsed(file(text));
  EXPECT_EQ(drawing.curves.size(), 1U);
  EXPECT_THAT(drawing.notes, ElementsAre(HasSubstr("left out: 5 curves without length")));
}

TEST(DxfEntities, a_circle_of_a_radius_below_0_is_of_no_outline_and_left_out) {
  const Drawing drawing = parsed(file(circle(0, 0, -1) + circle(5, 5, 2)));
  EXPECT_EQ(drawing.curves.size(), 1U);
  EXPECT_THAT(drawing.notes, ElementsAre("left out: 1 circle of a radius below 0"));
}

TEST(DxfEntities, extrusion_below_mirrors_x_and_turns_the_sense) {
  const Drawing drawing = parsed(file(arc(3, 1, 2, 0, 90, {{210, 0}, {220, 0}, {230, -1}})));
  EXPECT_THAT(kinds_of(drawing), ElementsAre("arc"));
  expect_ends(drawing, 0, {-5, 1}, {-3, 3});
  const Drawing rounded = parsed(file(light_polyline({{0, 0, 1}, {2, 0, 1}}, true, {{230, -1}})));
  EXPECT_NEAR(area_of(rounded), -kPi, 1e-14);
  expect_ends(rounded, 0, {0, 0}, {-2, 0});
}

TEST(DxfEntities, extrusion_does_not_move_lines_splines_and_ellipses) {
  Numbers spline = kQuarterCircle;
  spline.insert(spline.end(), {{210, 0}, {220, 0}, {230, -1}});
  expect_ends(parsed(file(record("SPLINE", spline))), 0, {1, 0}, {0, 1});
  expect_ends(parsed(file(record("LINE", {{10, 1}, {20, 2}, {11, 3}, {21, 4}, {230, -1}}))), 0, {1, 2}, {3, 4});
  const Drawing ellipse = parsed(
      file(record("ELLIPSE", {{10, 5}, {20, 0}, {11, 2}, {21, 0}, {40, 0.5}, {41, 0}, {42, kPi / 2}, {230, -1}})));
  expect_ends(ellipse, 0, {7, 0}, {5, -1});
}

TEST(DxfEntities, curves_say_where_they_come_from) {
  const Drawing drawing = parsed(file(line(0, 0, 1, 0) + circle(0, 0, 1, "Holes")));
  EXPECT_EQ(drawing.curves[1].origin.entity, "CIRCLE");
  EXPECT_EQ(drawing.curves[1].origin.layer, "Holes");
  EXPECT_EQ(drawing.curves[1].origin.line, 18U);
}

}  // namespace
}  // namespace dxf_entities_test
