// Lengths with units: what they are worth, in parts that state their own and in parts that do not.
#include "rollfix/units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "refusal.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/files.hpp"
#include "rollfix/outline.hpp"
#include "text/units.hpp"

namespace rollfix::units_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

double in(const std::string& text, const std::string& unit) { return in_unit(*parse_length(text), unit, "test"); }

TEST(Units, lengths_are_converted_as_their_definitions_say) {
  EXPECT_EQ(in("8mm", "mm"), 8);
  EXPECT_DOUBLE_EQ(in("0.3in", "mm"), 7.62);
  EXPECT_EQ(in("0.5cm", "mm"), 5);
  EXPECT_EQ(in("0.1m", "mm"), 100);
  EXPECT_EQ(in("1 ft", "in"), 12);
  EXPECT_EQ(in("25.4mm", "in"), 1);
  EXPECT_EQ(in("-2.5e1 mm", "cm"), -2.5);
  EXPECT_EQ(in("1 inch", "um"), 25400);
  EXPECT_DOUBLE_EQ(in("3937us-ft", "m"), 1200);
}

TEST(Units, a_bare_number_is_in_the_parts_unit_whatever_that_is) {
  EXPECT_EQ(in("8", ""), 8);
  EXPECT_EQ(in("8", "in"), 8);
  EXPECT_EQ(in("8", "px"), 8);
}

TEST(Units, what_is_no_length_is_none) {
  for (const char* const text : {"", "mm", "8deg", "8ms", "8 mmm", "8mm2", "1,5mm"}) {
    EXPECT_FALSE(parse_length(text)) << text;
  }
}

TEST(Units, a_unit_needs_the_parts_with_the_cure) {
  EXPECT_THAT(refusal_of([] { in("8mm", ""); }), AllOf(HasSubstr("states no unit"), HasSubstr("`unit` mm")));
  EXPECT_THAT(refusal_of([] { in("8mm", "px"); }), AllOf(HasSubstr("'px'"), HasSubstr("`unit`")));
}

TEST(Units, times_and_angles_become_seconds_and_radians) {
  EXPECT_EQ(conversion_to_plain(*unit_named("ms"))(250), 0.25);
  EXPECT_EQ(conversion_to_plain(*unit_named("us"))(3), 3e-6);
  EXPECT_EQ(conversion_to_plain(*unit_named("degrees"))(180), std::numbers::pi);
}

TEST(Units, a_scaled_outline_is_the_same_shape) {
  for (const char* const name : {"ellipse", "stadium", "cam", "naca"}) {
    const Outline one = gallery(name);
    const Outline two = scaled(one, 25.4, "mm");
    EXPECT_TRUE(check(two).empty()) << name;
    const Part small(one);
    const Part large(two);
    EXPECT_NEAR(large.perimeter(), 25.4 * small.perimeter(), 1e-11 * large.perimeter()) << name;
    EXPECT_EQ(large.corners().size(), small.corners().size()) << name;
    for (const double share : {0.1, 0.3, 0.8}) {
      EXPECT_NEAR(large.turning().angle(share * large.perimeter()), small.turning().angle(share * small.perimeter()),
                  1e-9)
          << name;
    }
  }
}

TEST(Units, a_scaled_curve_is_saved_and_made_again) {
  const Curve curve = scaled(Arc({1, 2}, 3, 0.5, 1), 25.4);
  const Curve again = curve_from(*curve.record());
  EXPECT_EQ(again.position(0.3), curve.position(0.3));
  EXPECT_THROW(curve_from({"scaled line", {0, 0, 1, 1, -1}}), InputError);
}

TEST(Units, points_state_their_unit_in_the_header_or_take_the_one_that_is_stated) {
  const std::string text = "x [in],y [in]\n0,0\n1,0\n0,1\n";
  std::string unit;
  EXPECT_EQ(parse_points(text, "part.csv", {}, nullptr, &unit)[1], Vec2(1, 0));
  EXPECT_EQ(unit, "in");
  OutlineOptions options;
  options.unit = "mm";
  EXPECT_EQ(parse_points(text, "part.csv", options, nullptr, &unit)[1], Vec2(25.4, 0));
  EXPECT_EQ(unit, "mm");
  EXPECT_EQ(parse_points("0 0\n1 0\n0 1\n", "part.csv", options, nullptr, &unit)[1], Vec2(1, 0));
  EXPECT_EQ(unit, "mm");
}

TEST(Units, a_saved_part_keeps_its_unit) {
  LoadOptions options;
  options.points.unit = "inches";
  const LoadedPart loaded = load_part("gallery:ellipse", options);
  EXPECT_EQ(loaded.unit, "in");
  EXPECT_EQ(loaded.part.unit(), "in");
  EXPECT_EQ(parse_part(format_part(loaded.part), "saved.json").unit(), "in");
  options.points.unit = "deg";
  EXPECT_THAT(refusal_of([&] { load_part("gallery:ellipse", options); }), HasSubstr("expected a unit of length"));
}

}  // namespace
}  // namespace rollfix::units_test
