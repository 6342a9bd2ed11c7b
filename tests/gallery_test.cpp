// The gallery: the shapes are what their names say, start where the table says, and refuse what is not a shape.
#include "rollfix/outline.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "paths.hpp"
#include "rollfix/error.hpp"

namespace gallery_test {
namespace {

using rollfix::check;
using rollfix::cross;
using rollfix::Curve;
using rollfix::gallery;
using rollfix::gallery_shapes;
using rollfix::GalleryShape;
using rollfix::InputError;
using rollfix::Interval;
using rollfix::Outline;
using rollfix::Vec2;
using std::numbers::pi;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<Vec2> sampled(const Outline& outline, int per_curve) {
  std::vector<Vec2> points;
  for (const Curve& curve : outline.curves) {
    for (int k = 0; k < per_curve; ++k) {
      points.push_back(curve.position(curve.domain().lo + curve.domain().width() * k / per_curve));
    }
  }
  return points;
}

template <class Density>
double integral(const Outline& outline, const Density& density) {
  double sum = 0;
  for (const Curve& curve : outline.curves) {
    const Interval domain = curve.domain();
    sum += boost::math::quadrature::gauss_kronrod<double, 31>::integrate([&](double u) { return density(curve, u); },
                                                                         domain.lo, domain.hi, 12, 1e-12);
  }
  return sum;
}

double perimeter(const Outline& outline) {
  return integral(outline, [](const Curve& curve, double u) { return curve.velocity(u).norm(); });
}

double area(const Outline& outline) {
  return integral(outline, [](const Curve& curve, double u) {
    const rollfix::Jet jet = curve.jet(u);
    return 0.5 * cross(jet.position, jet.first);
  });
}

/// How far the tangent turns, corners included.
double total_turn(const Outline& outline) {
  std::vector<Vec2> tangents;
  for (const Curve& curve : outline.curves) {
    constexpr int kSteps = 400;
    const Interval domain = curve.domain();
    for (int k = 0; k <= kSteps; ++k) tangents.push_back(curve.velocity(domain.lo + domain.width() * k / kSteps));
  }
  if (outline.closed) tangents.push_back(tangents.front());
  double turn = 0;
  for (std::size_t i = 1; i < tangents.size(); ++i) {
    turn += std::atan2(cross(tangents[i - 1], tangents[i]), tangents[i - 1].dot(tangents[i]));
  }
  return turn;
}

/// How far the tangent turns from the end of one curve to the start of the next.
double turn_between(const Outline& outline, std::size_t before, std::size_t after) {
  const Curve& first = outline.curves[before];
  const Curve& second = outline.curves[after];
  const Vec2 a = first.velocity(first.domain().hi);
  const Vec2 b = second.velocity(second.domain().lo);
  return std::atan2(cross(a, b), a.dot(b));
}

bool crosses_itself(const std::vector<Vec2>& loop) {
  const auto side = [](const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a) > 0; };
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      const Vec2 &a = loop[i], &b = loop[(i + 1) % n], &c = loop[j], &d = loop[(j + 1) % n];
      if (side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)) return true;
    }
  }
  return false;
}

std::string message_of(const std::string& specification) {
  try {
    gallery(specification);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

class EveryShape : public testing::TestWithParam<GalleryShape> {
 protected:
  const Outline outline_ = gallery(GetParam().name);
};
class ClosedShape : public EveryShape {};

std::vector<GalleryShape> closed_shapes() {
  std::vector<GalleryShape> shapes;
  for (const GalleryShape& shape : gallery_shapes()) {
    if (shape.closed) shapes.push_back(shape);
  }
  return shapes;
}

std::string test_name(const testing::TestParamInfo<GalleryShape>& shape) {
  std::string name = shape.param.name;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Gallery, EveryShape, testing::ValuesIn(gallery_shapes()), test_name);
INSTANTIATE_TEST_SUITE_P(Gallery, ClosedShape, testing::ValuesIn(closed_shapes()), test_name);

TEST_P(EveryShape, passes_the_check) { EXPECT_THAT(check(outline_), IsEmpty()); }

TEST_P(ClosedShape, is_closed_to_a_unit_in_the_last_place) {
  for (std::size_t i = 0; i < outline_.curves.size(); ++i) {
    const Vec2 end = outline_.curves[i].back();
    const Vec2 start = outline_.curves[(i + 1) % outline_.curves.size()].front();
    EXPECT_LE((end - start).norm(), 1e-15) << i;
  }
}

TEST_P(ClosedShape, turns_once_around_counter_clockwise) {
  EXPECT_NEAR(total_turn(outline_), 2 * pi, 1e-9);
  EXPECT_GT(area(outline_), 0);
}

TEST_P(ClosedShape, does_not_cross_itself_by_default) {
  EXPECT_FALSE(crosses_itself(sampled(outline_, outline_.curves.size() < 3 ? 600 : 50)));
}

TEST_P(EveryShape, is_named_by_what_makes_it_again) {
  EXPECT_EQ(outline_.name, "gallery:" + GetParam().name);
  EXPECT_EQ(gallery(outline_.name).curves.size(), outline_.curves.size());
}

TEST_P(EveryShape, takes_its_own_defaults) {
  rollfix::ParameterList defaults;
  for (const auto& parameter : GetParam().parameters) defaults.emplace_back(parameter.name, parameter.default_value);
  const Outline same = gallery(GetParam().name, defaults);
  EXPECT_EQ(sampled(same, 10), sampled(outline_, 10));
}

TEST_P(EveryShape, has_corners_only_where_the_table_says_so) {
  double sharpest = 0;
  for (std::size_t i = 0; i < outline_.curves.size(); ++i) {
    if (i + 1 == outline_.curves.size() && !outline_.closed) break;
    sharpest = std::max(sharpest, std::abs(turn_between(outline_, i, (i + 1) % outline_.curves.size())));
  }
  EXPECT_EQ(sharpest < 1e-12, GetParam().smooth) << sharpest;
}

// ---- Each shape is what its name says.

void expect_start(const std::string& specification, double x, double y) {
  const Vec2 start = gallery(specification).curves.front().front();
  EXPECT_NEAR(start.x(), x, 1e-15) << specification;
  EXPECT_NEAR(start.y(), y, 1e-15) << specification;
}

TEST(Gallery, starts_where_the_formula_has_its_parameter_0) {
  expect_start("circle,r=3", 3, 0);
  expect_start("ellipse,a=2,b=1", 2, 0);
  expect_start("superellipse,a=2,b=1,n=5", 2, 0);
  expect_start("limacon,a=3,b=-1", 2, 0);
  expect_start("cam,base=1,lift=0.25", 1.25, 0);
  expect_start("gear,r=1,depth=0.25", 1.25, 0);
  expect_start("naca,digits=4412,chord=2", 2, 0);
  expect_start("reuleaux,width=3", std::sqrt(3.0), 0);
  expect_start("stadium,length=4,r=1", -2, -1);
  expect_start("rounded-rectangle,width=4,height=2,r=0.5", -1.5, -1);
  expect_start("polygon,n=5,r=2", 2, 0);
  expect_start("log-spiral,a=2", 2, 0);
  expect_start("exponential,from=0,to=1,scale=2", 0, 2);
}

TEST(Gallery, circle_has_its_perimeter_and_area) {
  EXPECT_NEAR(perimeter(gallery("circle,r=2")), 4 * pi, 1e-13);
  EXPECT_NEAR(area(gallery("circle,r=2")), 4 * pi, 1e-13);
}

TEST(Gallery, ellipse_has_the_perimeter_of_the_elliptic_integral) {
  const double eccentricity = std::sqrt(1 - 0.25 * 0.25);
  EXPECT_NEAR(perimeter(gallery("ellipse,a=4,b=1")), 16 * boost::math::ellint_2(eccentricity), 1e-12);
  EXPECT_NEAR(area(gallery("ellipse,a=4,b=1")), 4 * pi, 1e-12);
}

TEST(Gallery, limacon_has_the_perimeter_of_the_elliptic_integral) {
  const double a = 1.5, b = 1;
  const double modulus = 2 * std::sqrt(a * b) / (a + b);
  EXPECT_NEAR(perimeter(gallery("limacon,a=1.5,b=1")), 4 * (a + b) * boost::math::ellint_2(modulus), 1e-12);
  EXPECT_NEAR(area(gallery("limacon,a=1.5,b=1")), pi * (a * a + b * b / 2), 1e-12);
}

TEST(Gallery, limacon_with_an_inner_loop_turns_twice) {
  EXPECT_NEAR(total_turn(gallery("limacon,a=1,b=1.5")), 4 * pi, 1e-9);
  EXPECT_TRUE(crosses_itself(sampled(gallery("limacon,a=1,b=1.5"), 600)));
}

TEST(Gallery, superellipse_satisfies_its_equation) {
  for (const char* n : {"2", "3", "3.5", "4", "9", "100"}) {
    const double power = std::stod(n);
    for (const Vec2& p : sampled(gallery(fmt::format("superellipse,a=3,b=0.5,n={}", n)), 97)) {
      const double left = std::pow(std::abs(p.x() / 3), power) + std::pow(std::abs(p.y() / 0.5), power);
      EXPECT_NEAR(left, 1, 4e-16 * (power + 2)) << n;
    }
  }
}

TEST(Gallery, superellipse_with_n_2_is_an_ellipse) {
  EXPECT_EQ(sampled(gallery("superellipse,a=3,b=2,n=2"), 50), sampled(gallery("ellipse,a=3,b=2"), 50));
}

TEST(Gallery, stadium_has_its_perimeter_and_area) {
  EXPECT_NEAR(perimeter(gallery("stadium,length=3,r=0.5")), 6 + pi, 1e-13);
  EXPECT_NEAR(area(gallery("stadium,length=3,r=0.5")), 3 + 0.25 * pi, 1e-13);
}

TEST(Gallery, rounded_rectangle_has_its_perimeter_and_area) {
  const Outline outline = gallery("rounded-rectangle,width=4,height=3,r=0.5");
  EXPECT_NEAR(perimeter(outline), 10 + pi, 1e-13);
  EXPECT_NEAR(area(outline), 11 + 0.25 * pi, 1e-13);
}

TEST(Gallery, reuleaux_triangle_is_as_wide_as_a_circle_and_as_long) {
  const Outline outline = gallery("reuleaux,width=3");
  EXPECT_NEAR(perimeter(outline), 3 * pi, 1e-13);  // Barbier
  EXPECT_NEAR(area(outline), 0.5 * (pi - std::sqrt(3.0)) * 9, 1e-13);
}

TEST(Gallery, polygon_is_regular) {
  const Outline outline = gallery("polygon,n=5,r=2");
  ASSERT_EQ(outline.curves.size(), 5U);
  EXPECT_NEAR(perimeter(outline), 5 * 2 * 2 * std::sin(pi / 5), 1e-13);
  EXPECT_NEAR(area(outline), 0.5 * 5 * 4 * std::sin(2 * pi / 5), 1e-13);
}

TEST(Gallery, square_has_its_corners_on_the_axes_exactly) {
  const Outline square = gallery("polygon,n=4,r=1");
  EXPECT_EQ(square.curves[1].front(), Vec2(0, 1));
  EXPECT_EQ(square.curves[2].front(), Vec2(-1, 0));
}

TEST(Gallery, log_spiral_has_its_length) {
  const double b = 0.1;
  EXPECT_NEAR(perimeter(gallery("log-spiral,a=1,b=0.1,turns=2")), std::sqrt(1 + b * b) / b * (std::exp(4 * pi * b) - 1),
              1e-12);
}

TEST(Gallery, wing_section_has_its_thickness_and_length) {
  double thickest = 0;
  for (const Vec2& p : sampled(gallery("naca,digits=0018,chord=2"), 2000)) thickest = std::max(thickest, 2 * p.y());
  EXPECT_NEAR(thickest, 0.18 * 2, 2e-4);  // the formula's own maximum is a little off its name
  const Outline cambered = gallery("naca,digits=4412");
  ASSERT_EQ(cambered.curves.size(), 4U);
  EXPECT_EQ(cambered.curves[1].back(), Vec2(0, 0));  // the nose
  EXPECT_EQ(cambered.curves[3].back(), cambered.curves[0].front());
}

TEST(Gallery, cambered_wing_section_has_the_slight_corners_of_its_formula) {
  // At x = p the camber line is level. Its normal turns at 2 m/p^2 before and 2 m/(1 - p)^2 after, per length, so that
  // the upper side's velocity by x is (1 + rate h, h') with half thickness h.
  const double m = 0.04, p = 0.4, t = 0.12;
  const double h =
      5 * t * (0.2969 * std::sqrt(p) - 0.126 * p - 0.3516 * p * p + 0.2843 * p * p * p - 0.1036 * p * p * p * p);
  const double slope =
      5 * t * (0.5 * 0.2969 / std::sqrt(p) - 0.126 - 2 * 0.3516 * p + 3 * 0.2843 * p * p - 4 * 0.1036 * p * p * p);
  const double before = std::atan2(slope, 1 + 2 * m / (p * p) * h);
  const double after = std::atan2(slope, 1 + 2 * m / ((1 - p) * (1 - p)) * h);
  const Outline outline = gallery("naca,digits=4412");
  EXPECT_NEAR(turn_between(outline, 0, 1), before - after, 1e-14);
  EXPECT_GT(std::abs(before - after), 1e-4);
}

TEST(Gallery, spline_runs_through_the_points_it_documents) {
  std::mt19937_64 generator(42);
  const Outline outline = gallery("spline,n=7,seed=42,wobble=0.5");
  ASSERT_EQ(outline.curves.size(), 7U);
  for (int i = 0; i < 7; ++i) {
    const double uniform = 2 * (static_cast<double>(generator() >> 11) / 9007199254740992.0) - 1;
    const double angle = 2 * pi * i / 7;
    const Vec2 point = (1 + 0.5 * uniform) * Vec2(std::cos(angle), std::sin(angle));
    EXPECT_LE((outline.curves[static_cast<std::size_t>(i)].front() - point).norm(), 1e-15) << i;
  }
}

TEST(Gallery, default_spline_is_not_convex) {
  bool has_concave_place = false;
  const Outline outline = gallery("spline");
  for (const Curve& curve : outline.curves) has_concave_place |= rollfix::curvature(curve.jet(0.5)) < -0.1;
  EXPECT_TRUE(has_concave_place);
}

// ---- What is refused, and how.

TEST(Gallery, unknown_shape_lists_the_known_and_the_nearest) {
  EXPECT_THAT(message_of("elipse,a=2"), AllOf(HasSubstr("'elipse'"), HasSubstr("did you mean 'ellipse'?"),
                                              HasSubstr("circle, ellipse, superellipse")));
  EXPECT_THAT(message_of("nonsense"), AllOf(HasSubstr("'nonsense'"), testing::Not(HasSubstr("did you mean"))));
  EXPECT_THAT(message_of(""), HasSubstr("there is no gallery shape ''"));
}

TEST(Gallery, unknown_parameter_lists_the_known) {
  EXPECT_THAT(message_of("spline,sed=2"), AllOf(HasSubstr("'spline' has no parameter 'sed'"),
                                                HasSubstr("did you mean 'seed'?"), HasSubstr("n, seed, wobble")));
}

TEST(Gallery, bad_value_is_named_with_what_is_allowed) {
  EXPECT_EQ(message_of("circle,r=-1"), "gallery shape 'circle': parameter r = '-1', expected a number above 0");
  EXPECT_THAT(message_of("circle,r=nan"), HasSubstr("r = 'nan', expected a number above 0"));
  EXPECT_THAT(message_of("circle,r=1e999"), HasSubstr("r = '1e999', expected a number above 0 (1e-99 to 1e+99)"));
  EXPECT_THAT(message_of("cam,lift=-1"), HasSubstr("lift = '-1', expected a number of at least 0"));
  EXPECT_THAT(message_of("limacon,b=x"), HasSubstr("b = 'x', expected a number"));
  EXPECT_THAT(message_of("circle,r=1m"), HasSubstr("r = '1m', expected a number above 0"));
  EXPECT_THAT(message_of("circle,r="), HasSubstr("r = '', expected a number above 0"));
  EXPECT_THAT(message_of("polygon,n=2"), HasSubstr("n = '2', expected a whole number from 3 to 10000"));
  EXPECT_THAT(message_of("polygon,n=4.5"), HasSubstr("n = '4.5', expected a whole number from 3 to 10000"));
  EXPECT_THAT(message_of("spline,wobble=1.5"), HasSubstr("wobble = '1.5', expected a number from 0 to 0.99"));
}

TEST(Gallery, malformed_specification_is_explained) {
  EXPECT_THAT(message_of("ellipse,2"), HasSubstr("'2' in 'ellipse,2': expected a parameter as in"));
  EXPECT_THAT(message_of("ellipse,a=2,"), HasSubstr("'' in 'ellipse,a=2,'"));
  EXPECT_THAT(message_of("ellipse,a=2,a=3"), HasSubstr("parameter a is given twice, as '2' and '3'"));
}

TEST(Gallery, shapes_that_are_not_regular_are_refused) {
  EXPECT_THAT(message_of("limacon,a=1,b=-1"), AllOf(HasSubstr("a = 1, b = -1"), HasSubstr("cusp where a = |b|")));
  EXPECT_THAT(message_of("superellipse,n=2.5"), HasSubstr("n must be 2 or at least 3"));
  EXPECT_THAT(message_of("ellipse,a=1,b=1e-9"), HasSubstr("too slim"));
  EXPECT_THAT(message_of("gear,r=1,depth=1"), HasSubstr("depth must be below r"));
  EXPECT_THAT(message_of("log-spiral,b=0"), HasSubstr("b must not be 0"));
  EXPECT_THAT(message_of("log-spiral,b=3,turns=5"), HasSubstr("take fewer turns"));
  EXPECT_THAT(message_of("exponential,from=1,to=1"), HasSubstr("from must be below to"));
  EXPECT_THAT(message_of("rounded-rectangle,r=1"), HasSubstr("twice r must be below width and height"));
}

TEST(Gallery, wing_digits_are_checked) {
  EXPECT_THAT(message_of("naca,digits=12"), HasSubstr("digits = 12"));
  EXPECT_THAT(message_of("naca,digits=24a2"), HasSubstr("four digits of a section"));
  EXPECT_THAT(message_of("naca,digits=2400"), HasSubstr("thickness in percent and must not be 00"));
  EXPECT_THAT(message_of("naca,digits=2012"), HasSubstr("both 0 (symmetric) or neither"));
}

TEST(Gallery, blanks_and_signs_are_tolerated) {
  EXPECT_EQ(gallery(" ellipse , a = +2.5 ").curves[0].front(), Vec2(2.5, 0));
}

// ---- docs/gallery.md is this table.

std::string documented(const GalleryShape& shape) {
  std::vector<std::string> parameters;
  for (const auto& parameter : shape.parameters) {
    const bool is_text = parameter.kind == rollfix::ParameterKind::text;
    parameters.push_back(fmt::format("- `{}={}`: {}{}\n", parameter.name, parameter.default_value, parameter.meaning,
                                     is_text ? "" : "; " + allowed_values(parameter)));
  }
  return fmt::format("## {}\n{}{}.\n\n{}\ns = 0: {}. Of note: {}.\n", shape.name, shape.closed ? "" : "Open. ",
                     shape.formula, fmt::join(parameters, ""), shape.start, shape.remark);
}

std::string table_row(const GalleryShape& shape) {
  std::string settings;
  for (const auto& parameter : shape.parameters) settings += "," + parameter.name + "=" + parameter.default_value;
  const char* const ends = shape.closed ? "closed" : "open";
  return fmt::format("| `gallery:{}{}` | {} | {} |\n", shape.name, settings, ends, shape.smooth ? "no" : "yes");
}

TEST(Gallery, documentation_says_what_the_table_says) {
  std::ifstream file(checked_out("docs/gallery.md"));
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  for (const GalleryShape& shape : gallery_shapes()) {
    EXPECT_THAT(text, HasSubstr(documented(shape)));
    EXPECT_THAT(text, HasSubstr(table_row(shape)));
  }
}

TEST(Gallery, names_are_unique) {
  std::set<std::string> names;
  for (const GalleryShape& shape : gallery_shapes()) EXPECT_TRUE(names.insert(shape.name).second) << shape.name;
}

}  // namespace
}  // namespace gallery_test
