// Files that Inkscape wrote, and lib2geom, which it reads paths with, as a witness.
#include <2geom/path.h>
#include <2geom/pathvector.h>
#include <2geom/svg-path-parser.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>
#include <string>

#include "paths.hpp"
#include "random.hpp"
#include "svg_helpers.hpp"

namespace svg_inkscape_test {
namespace {

using rollfix::Curve;
using rollfix::Drawing;
using rollfix::Vec2;
using std::numbers::pi;
using testing::ElementsAre;
using testing::IsEmpty;

std::string file(const std::string& name) {
  std::ifstream stream(checked_out("tests/svg/" + name));
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The curves that come from the element with this id.
Drawing from(const Drawing& drawing, const std::string& id) {
  Drawing part;
  for (const auto& curve : drawing.curves) {
    if (curve.origin.layer == id) part.curves.push_back(curve);
  }
  return part;
}

double ellipse_length(double a, double b) { return 4 * a * boost::math::ellint_2(std::sqrt(1 - b * b / (a * a))); }

void expect_figures(const Drawing& part, double perimeter, double area, double accuracy = 1e-11) {
  EXPECT_NEAR(svg_test::length_of(part), perimeter, accuracy * perimeter);
  EXPECT_NEAR(std::abs(svg_test::area_of(part)), area, accuracy * area);
}

class Inkscape : public testing::TestWithParam<const char*> {
 protected:
  Drawing drawing_ = rollfix::files::parse_svg(file(GetParam()), GetParam());
};

INSTANTIATE_TEST_SUITE_P(File, Inkscape, testing::Values("inkscape.svg", "inkscape_plain.svg"),
                         [](const auto& one) { return std::string(one.index == 0 ? "with_its_own_data" : "plain"); });

TEST_P(Inkscape, file_is_in_millimetres_and_read_whole) {
  EXPECT_EQ(drawing_.unit, "mm");
  EXPECT_THAT(drawing_.notes, IsEmpty());
  EXPECT_EQ(drawing_.name, GetParam());
}

TEST_P(Inkscape, rectangle_rounded_by_bezier_curves) {
  expect_figures(from(drawing_, "rounded"), 186.29638711799333, 2345.3088256);
  EXPECT_EQ(from(drawing_, "rounded").curves.size(), 8U);
}

TEST_P(Inkscape, turned_ellipse_of_four_arcs) {
  expect_figures(from(drawing_, "oval"), ellipse_length(30, 20), 600 * pi);
}

TEST_P(Inkscape, skewed_circle_is_an_ellipse) {
  // Half axes: 15 times the singular values of the matrix, whose squares have the sum 1.98 and the product 0.94^2.
  const double root = std::sqrt(0.99 * 0.99 - 0.94 * 0.94);
  expect_figures(from(drawing_, "sheared"), ellipse_length(15 * std::sqrt(0.99 + root), 15 * std::sqrt(0.99 - root)),
                 0.94 * 225 * pi);
}

TEST_P(Inkscape, union_of_circle_and_rectangle) {
  const Drawing disk = from(drawing_, "disk");
  EXPECT_THAT(svg_test::kinds(disk), ElementsAre("arc", "arc", "arc", "line", "line", "line", "arc"));
  expect_figures(disk, 210.67819338954998, 2476.8777424139959);
}

TEST(InkscapeLayers, clones_and_shapes_are_drawn_and_the_rest_named) {
  const Drawing drawing = rollfix::files::parse_svg(file("inkscape_layers.svg"), "layers");
  EXPECT_THAT(drawing.notes, ElementsAre("left out: 1 text", "left out: 1 hidden element"));
  EXPECT_EQ(drawing.unit, "mm");
  const Drawing drops = from(drawing, "drop");
  ASSERT_EQ(drops.curves.size(), 4U);
  expect_figures({"", "", {drops.curves[0], drops.curves[1]}, {}}, 122.86133125735521, 748.8);
  expect_figures({"", "", {drops.curves[2], drops.curves[3]}, {}}, 73.737447312569148, 280.8);
  expect_figures(from(drawing, "plate"), 0.4 * (316 + ellipse_length(12, 9)), 0.16 * (9600 - 108 * (4 - pi)));
  expect_figures(from(drawing, "hole"), 8 * pi, 16 * pi);
}

TEST(InkscapeLayers, stand_where_the_page_has_them) {
  // 203.2 mm x 200 mm for 400 x 500: 0.4 mm a unit, the 43.2 mm left over in width shared by both sides.
  const Drawing drawing = rollfix::files::parse_svg(file("inkscape_layers.svg"), "layers");
  const Vec2 start = from(drawing, "hole").curves.at(0).curve.front();
  EXPECT_NEAR((start - Vec2(21.6 + 0.4 * (170 + 10), -0.4 * (340 + 10))).norm(), 0, 1e-12);
}

// ---- lib2geom

/// A random path: every command, absolute and relative, as tight as the grammar allows.
class RandomPath {
 public:
  explicit RandomPath(std::mt19937_64& generator) : generator_(generator) {}

  std::string text() {
    text_ = relative() ? "m" : "M";
    numbers(2);
    const int commands = whole(1, 12);
    for (int k = 0; k < commands; ++k) add_command();
    return text_;
  }

 private:
  int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(generator_); }
  bool relative() { return whole(0, 1) == 0; }

  void number() {
    const double value = std::uniform_real_distribution<double>(-50, 50)(generator_);
    std::string digits;
    switch (whole(0, 3)) {
      case 0:
        digits = fmt::format("{:.3f}", value / 100);
        if (digits.starts_with("0.")) digits.erase(0, 1);
        if (digits.starts_with("-0.")) digits.erase(1, 1);
        break;
      case 1:
        digits = fmt::format("{:.0f}", value);
        break;
      case 2:
        digits = fmt::format("{:.7e}", value);
        break;
      default:
        digits = fmt::format("{}", value);
    }
    const bool touches = text_.empty() || !std::isalpha(static_cast<unsigned char>(text_.back()));
    const bool clear = digits[0] == '-' || (digits[0] == '.' && last_has_point_);
    constexpr const char* kSeparators[] = {" ", ",", " , ", "\n"};
    if (touches && !(clear && whole(0, 1) == 0)) text_ += kSeparators[whole(0, 3)];
    text_ += digits;
    last_has_point_ = digits.find('.') != std::string::npos;
  }

  void numbers(int count) {
    for (int k = 0; k < count; ++k) number();
  }

  void add_command() {
    constexpr const char* kLetters = "LHVCSQTAZM";
    constexpr int kCounts[] = {2, 1, 1, 6, 4, 4, 2, 0, 0, 2};
    const auto k = static_cast<std::size_t>(whole(0, 9));
    text_ += relative() ? static_cast<char>(kLetters[k] - 'A' + 'a') : kLetters[k];
    if (kLetters[k] == 'Z') return;
    const int times = whole(1, 2);
    for (int n = 0; n < times; ++n) kLetters[k] == 'A' ? arc() : numbers(kCounts[k]);
  }

  void arc() {
    numbers(3);
    text_ += whole(0, 1) == 0 ? " 0" : ",1";
    text_ += whole(0, 1) == 0 ? "0" : " 1";
    last_has_point_ = false;
    if (whole(0, 1) == 0) text_ += " ";
    const std::string before = std::exchange(text_, "A");  // a number may touch a flag
    number();
    const std::string x = std::exchange(text_, before).substr(1);
    text_ += x;
    number();
  }

  std::mt19937_64& generator_;
  std::string text_;
  bool last_has_point_ = false;
};

Vec2 turned_up(const Geom::Point& point) { return {point.x(), -point.y()}; }

/// Whether both run through their points at the same pace. Not so where a Bezier curve became a line or starts at rest,
/// nor where radii grew until they reached: half a turn, whose centre lib2geom gets only to the root of a rounding.
bool same_parameter(const Curve& ours, const Geom::Curve& theirs) {
  const std::string kind = ours.record()->kind;
  if (kind == "arc" || kind == "elliptic-arc") return std::abs(ours.record()->numbers.back()) != pi;
  return kind == "bezier" || theirs.isLineSegment();
}

double largest_number(const Curve& curve) {
  double most = 0;
  const rollfix::CurveRecord record = *curve.record();
  for (const double number : record.numbers) most = std::max(most, std::abs(number));
  return most;
}

void expect_same(const Drawing& ours, const Geom::PathVector& theirs) {
  std::size_t number = 0;
  for (const Geom::Path& path : theirs) {
    for (Geom::Path::size_type k = 0; k < path.size_default(); ++k) {
      const Geom::Curve& curve = path[k];
      if (curve.isDegenerate()) continue;
      ASSERT_LT(number, ours.curves.size());
      const Curve& own = ours.curves[number++].curve;
      const rollfix::Interval domain = own.domain();
      const double slack = 1e-13 * (100 + largest_number(own));  // radii that grew may be large
      EXPECT_NEAR((own.front() - turned_up(curve.initialPoint())).norm(), 0, slack);
      EXPECT_NEAR((own.back() - turned_up(curve.finalPoint())).norm(), 0, slack);
      if (!same_parameter(own, curve)) continue;
      for (const double share : {0.2, 0.5, 0.9}) {
        const Vec2 place = own.position(domain.lo + share * domain.width());
        EXPECT_NEAR((place - turned_up(curve.pointAt(share))).norm(), 0, 100 * slack);
      }
    }
  }
  EXPECT_EQ(number, ours.curves.size());
}

TEST(SvgAgainstLib2geom, random_paths_have_the_same_points) {
  auto generator = test_generator();
  for (int i = 0; i < test_count(2000); ++i) {
    const std::string data = RandomPath(generator).text();
    SCOPED_TRACE(data);
    expect_same(svg_test::path(data), Geom::parse_svg_path(data.c_str()));
    if (HasFailure()) break;
  }
}

}  // namespace
}  // namespace svg_inkscape_test
