// JSON files of users: gallery shapes, and curves one by one.
#include "files/formats.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "svg_helpers.hpp"

namespace json_outline_test {
namespace {

using rollfix::Drawing;
using rollfix::InputError;
using rollfix::Outline;
using rollfix::Vec2;
using rollfix::files::parse_json_outline;
using std::numbers::pi;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

Drawing drawing(const std::string& text) { return std::get<Drawing>(parse_json_outline(text, "part.json")); }

/// A drawing of one curve.
Drawing curve(const std::string& fields) { return drawing("{\"curves\": [{" + fields + "}]}"); }

std::vector<double> numbers(const Drawing& drawing) { return drawing.curves.at(0).curve.record()->numbers; }

std::string message_of(const std::string& text) {
  try {
    parse_json_outline(text, "part.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string message_of_curve(const std::string& fields) { return message_of("{\"curves\": [{" + fields + "}]}"); }

TEST(JsonOutline, gallery_shape_is_an_outline_named_after_the_file) {
  const auto found = parse_json_outline(R"({"gallery": "ellipse", "parameters": {"a": 3, "b": "2"}})", "part.json");
  const Outline& outline = std::get<Outline>(found);
  EXPECT_EQ(outline.name, "part.json");
  EXPECT_EQ(outline.curves.at(0).position(1), rollfix::gallery("ellipse,a=3,b=2").curves.at(0).position(1));
}

TEST(JsonCurves, line) {
  EXPECT_THAT(numbers(curve(R"("type": "line", "from": [1, 2], "to": [3.5, -4e0])")), ElementsAre(1, 2, 3.5, -4));
}

TEST(JsonCurves, arc_with_angles_in_radians_or_degrees) {
  const auto arc = curve(R"("type": "arc", "centre": [1, 2], "radius": 3, "from": "90deg", "sweep": -1.5)");
  EXPECT_THAT(numbers(arc), ElementsAre(1, 2, 3, testing::DoubleEq(pi / 2), -1.5));
  EXPECT_THAT(numbers(curve(R"("type": "arc", "centre": [1, 2], "radius": 3)")), ElementsAre(1, 2, 3, 0, 2 * pi));
  EXPECT_THAT(numbers(curve(R"("type": "arc", "centre": [1, 2], "radius": 3, "sweep": "-360deg")")),
              ElementsAre(1, 2, 3, 0, -2 * pi));
}

TEST(JsonCurves, ellipse_with_its_half_axes) {
  const auto ellipse = curve(R"("type": "ellipse", "centre": [1, 2], "major": [3, 1], "minor": [-1, 2])");
  EXPECT_THAT(numbers(ellipse), ElementsAre(1, 2, 3, 1, -1, 2, 0, 2 * pi));
  EXPECT_NEAR(svg_test::area_of(ellipse), 7 * pi, 1e-12);
}

TEST(JsonCurves, bezier_with_and_without_weights) {
  EXPECT_THAT(numbers(curve(R"("type": "bezier", "points": [[0, 0], [1, 1], [2, 0]])")), ElementsAre(0, 0, 1, 1, 2, 0));
  const auto quarter =
      curve(R"("type": "bezier", "points": [[1, 0], [1, 1], [0, 1]], "weights": [1, 0.70710678118654752, 1])");
  EXPECT_NEAR(svg_test::length_of(quarter), pi / 2, 1e-13);
}

TEST(JsonCurves, nurbs_gives_a_curve_for_each_stretch) {
  const auto circle = curve(
      R"("type": "nurbs", "degree": 2, "knots": [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4],
         "points": [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]],
         "weights": [1, 0.70710678118654752, 1, 0.70710678118654752, 1, 0.70710678118654752, 1, 0.70710678118654752, 1])");
  EXPECT_THAT(circle.curves, SizeIs(4));
  EXPECT_NEAR(svg_test::area_of(circle), pi, 1e-13);
}

TEST(JsonCurves, polyline) {
  const auto three = curve(R"("type": "polyline", "points": [[0, 0], [1, 0], [1, 1]])");
  EXPECT_EQ(svg_test::joints(three), (std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}}));
}

TEST(JsonCurves, closed_adds_a_line_where_there_is_a_way_to_go) {
  const std::string open = R"({"curves": [{"type": "polyline", "points": [[0, 0], [1, 0], [1, 1]]}], "closed": )";
  EXPECT_THAT(drawing(open + "false}").curves, SizeIs(2));
  EXPECT_THAT(drawing(open + "true}").curves, SizeIs(3));
  EXPECT_EQ(drawing(open + "true}").curves.back().curve.back(), Vec2(0, 0));
  EXPECT_THAT(drawing(R"({"curves": [{"type": "arc", "centre": [0, 0], "radius": 1}], "closed": true})").curves,
              SizeIs(1));
  EXPECT_THAT(
      drawing(R"({"closed": true, "curves": [{"type": "polyline", "points": [[0, 0], [1, 0], [1, 1], [0, 0]]}]})")
          .curves,
      SizeIs(3));
}

TEST(JsonCurves, unit_name_and_origin_are_kept) {
  const auto two = drawing(
      "{\"unit\": \"mm\",\n \"curves\": [{\"type\": \"line\", \"from\": [0, 0], \"to\": [1, 0]},\n\n"
      "{\"type\": \"line\", \"from\": [1, 0], \"to\": [1, 1]}]}");
  EXPECT_EQ(two.unit, "mm");
  EXPECT_EQ(two.name, "part.json");
  EXPECT_EQ(two.curves.at(0).origin.line, 2U);
  EXPECT_EQ(two.curves.at(1).origin.line, 4U);
  EXPECT_EQ(two.curves.at(1).origin.entity, "line");
}

TEST(JsonErrors, what_is_not_json_is_refused_with_line_and_column) {
  EXPECT_THAT(message_of("{\"curves\":\n [}"), HasSubstr("part.json:2:3: is not JSON from here on"));
  EXPECT_THAT(message_of(""), HasSubstr("part.json:1:1: is not JSON"));
  EXPECT_THAT(message_of(std::string("{}\n\0\"", 5)), HasSubstr("part.json:2:1: is not JSON from here on"));
  EXPECT_THAT(message_of("{\"curves\": [1e999]}"), HasSubstr("a number that is out of range"));
  EXPECT_THAT(message_of(std::string(1000000, '[')), HasSubstr("nested more than 100 deep"));
}

TEST(JsonErrors, something_else_is_refused) {
  for (const char* text : {"[]", "5", "{}", R"({"schema": "x"})", R"({"gallery": 5})", "\"ellipse\"", "null"}) {
    EXPECT_THAT(message_of(text), HasSubstr("part.json: holds something else, expected a gallery shape such as"))
        << text;
  }
  EXPECT_THAT(message_of(R"({"curves": []})"), HasSubstr("'curves' is not an array of curves"));
  EXPECT_THAT(message_of(R"({"curves": {}})"), HasSubstr("'curves' is not an array of curves"));
  EXPECT_THAT(message_of(R"({"curves": [5]})"), HasSubstr("curves[0]: expected an object as in {...}, found 5"));
}

TEST(JsonErrors, unknown_fields_are_refused_with_the_nearest) {
  EXPECT_THAT(message_of(R"({"curves": [], "close": true})"), HasSubstr("has a field 'close': did you mean 'closed'?"));
  EXPECT_THAT(message_of(R"({"gallery": "circle", "parameter": {}})"), HasSubstr("did you mean 'parameters'?"));
  EXPECT_THAT(message_of_curve(R"("type": "arc", "center": [0, 0], "radius": 1)"),
              HasSubstr("part.json:1: curves[0]: has a field 'center': did you mean 'centre'?"));
  EXPECT_THAT(message_of_curve(R"("type": "arcs")"), HasSubstr("has the unknown type 'arcs': did you mean 'arc'?"));
}

TEST(JsonErrors, field_that_stands_there_twice_is_refused) {
  EXPECT_THAT(message_of_curve(R"("type": "line", "from": [0, 0], "to": [1, 0], "to": [2, 0])"),
              HasSubstr("has the field 'to' twice in one object"));
}

TEST(JsonErrors, bad_values_are_refused_with_the_place) {
  EXPECT_THAT(message_of_curve(R"("type": 5)"), HasSubstr("type: expected a text in quotes, found 5"));
  EXPECT_THAT(message_of_curve(R"("from": [0, 0])"), HasSubstr("expected a text as 'type', found no such field"));
  EXPECT_THAT(message_of_curve(R"("type": "line", "from": [0, 0])"),
              HasSubstr("expected a point as in [1.5, 2] as 'to', found no such field"));
  EXPECT_THAT(message_of_curve(R"("type": "line", "from": [0, 0], "to": [1])"),
              HasSubstr("to: expected a point as in [1.5, 2], found [1]"));
  EXPECT_THAT(message_of_curve(R"("type": "line", "from": [0, 0], "to": [1, "2"])"),
              HasSubstr("to: expected a number, found \"2\""));
  EXPECT_THAT(message_of_curve(R"("type": "line", "from": [0, 0], "to": [1, 1e80])"),
              HasSubstr("to: expected a number of at most 1e+75, found 1e+80"));
  EXPECT_THAT(message_of_curve(R"("type": "line", "from": [0, 0], "to": [0, 0])"),
              AllOf(HasSubstr("part.json:1: curves[0]: "), HasSubstr("has no length")));
  EXPECT_THAT(message_of_curve(R"("type": "arc", "centre": [0, 0], "radius": -1)"),
              HasSubstr("radius must be above 0"));
  EXPECT_THAT(message_of_curve(R"("type": "arc", "centre": [0, 0], "radius": 1, "sweep": "400deg")"),
              HasSubstr("at most 2 pi"));
  EXPECT_THAT(message_of_curve(R"("type": "arc", "centre": [0, 0], "radius": 1, "from": "north")"),
              HasSubstr("from: expected an angle as in 1.27 or \"73deg\", found \"north\""));
  EXPECT_THAT(message_of_curve(R"("type": "arc", "centre": [0, 0], "radius": 1, "from": "nan")"),
              HasSubstr("from: expected an angle"));
  EXPECT_THAT(message_of_curve(R"("type": "polyline", "points": [[0, 0]])"), HasSubstr("at least 2 points, found 1"));
  EXPECT_THAT(message_of_curve(R"("type": "polyline", "points": [[0, 0], 5])"),
              HasSubstr("points[1]: expected a point as in [1.5, 2], found 5"));
  EXPECT_THAT(message_of_curve(R"("type": "bezier", "points": [[0, 0], [0, 0]])"), HasSubstr("are the same"));
  EXPECT_THAT(message_of_curve(R"("type": "bezier", "points": [[0, 0], [1, 0]], "weights": [1])"),
              HasSubstr("one weight for each"));
  EXPECT_THAT(message_of_curve(R"("type": "nurbs", "degree": 1.5, "knots": [], "points": [])"),
              HasSubstr("degree: expected a whole number, found 1.5"));
  EXPECT_THAT(message_of_curve(R"("type": "nurbs", "degree": 1, "knots": [0, 0, 1], "points": [[0, 0], [1, 0]])"),
              HasSubstr("expected 4 knots"));
  EXPECT_THAT(message_of(R"({"curves": [{"type": "line", "from": [0, 0], "to": [1, 0]}], "closed": "yes"})"),
              HasSubstr("closed: expected true or false, found \"yes\""));
  EXPECT_THAT(message_of(R"({"curves": [{"type": "line", "from": [0, 0], "to": [1, 0]}], "unit": 5})"),
              HasSubstr("unit: expected a text in quotes, found 5"));
}

TEST(JsonErrors, a_type_as_long_as_a_file_is_quoted_in_part) {
  const std::string message = message_of(R"({"curves": [{"type": ")" + std::string(10'000'000, 'a') + R"("}]})");
  EXPECT_THAT(message, HasSubstr("has the unknown type"));
  EXPECT_LT(message.size(), 500U);
}

TEST(JsonErrors, mutilated_files_give_an_error_or_a_drawing) {
  const std::string whole = R"({"curves": [{"type": "arc", "centre": [0, 0], "radius": 1, "sweep": "90deg"},
    {"type": "nurbs", "degree": 2, "knots": [0, 0, 0, 1, 1, 1], "points": [[0, 1], [-1, 1], [-1, 0]], "weights": [1, 2, 1]},
    {"type": "bezier", "points": [[-1, 0], [-1, 0], [0, -1], [1, 0]]}], "closed": true, "unit": "mm"})";
  ASSERT_EQ(message_of(whole), "no error");
  auto generator = test_generator();
  std::uniform_int_distribution<std::size_t> place(0, whole.size() - 1);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int i = 0; i < test_count(2000); ++i) {
    std::string text = whole;
    for (int k = i % 4; k >= 0; --k) text[place(generator)] = static_cast<char>(byte(generator));
    if (i % 3 == 0) text.resize(place(generator));
    const std::string message = message_of(text);
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace json_outline_test
