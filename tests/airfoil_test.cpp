// Airfoil files in both common orders.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

namespace airfoil_test {
namespace {

using rollfix::parse_points;
using rollfix::Part;
using rollfix::Vec2;
using shapes::kPi;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

struct Surfaces {
  std::vector<Vec2> above;  // from the nose to the trailing edge
  std::vector<Vec2> below;
};

/// A NACA wing section of four digits: camber m at p, thickness t; `edge` is the trailing edge's half thickness.
Surfaces naca(double m, double p, double t, int above, int below, double edge = 0) {
  const auto point = [&](double x, double side) -> Vec2 {
    const double x2 = x * x;
    const double half = 5 * t * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x2 + 0.2843 * x2 * x - 0.1036 * x2 * x2);
    const double camber =
        x < p ? m / (p * p) * (2 * p * x - x2) : m / ((1 - p) * (1 - p)) * (1 - 2 * p + 2 * p * x - x2);
    return {x, camber + side * (half + edge * x)};
  };
  const auto place = [](int k, int count) { return 0.5 * (1 - std::cos(kPi * k / (count - 1))); };
  Surfaces wing;
  for (int k = 0; k < above; ++k) wing.above.push_back(point(place(k, above), 1));
  for (int k = 0; k < below; ++k) wing.below.push_back(point(place(k, below), -1));
  wing.above.front() = wing.below.front() = {0, 0};
  if (edge == 0) wing.above.back() = wing.below.back() = {1, 0};
  return wing;
}

std::string line(const Vec2& point) { return fmt::format("{:.7f} {:.7f}\n", point.x(), point.y()); }

std::string lednicer(const Surfaces& wing) {
  std::string text = fmt::format("NACA wing\n {}.  {}.\n\n", wing.above.size(), wing.below.size());
  for (const Vec2& point : wing.above) text += line(point);
  text += "\n";
  for (const Vec2& point : wing.below) text += line(point);
  return text;
}

std::string selig(const Surfaces& wing) {
  std::string text = "NACA wing\n";
  for (std::size_t k = wing.above.size(); k-- > 0;) text += line(wing.above[k]);
  for (std::size_t k = 1; k < wing.below.size(); ++k) text += line(wing.below[k]);
  return text;
}

std::string note_of(const std::string& text) {
  std::vector<std::string> notes;
  parse_points(text, "wing.dat", {}, &notes);
  return notes.empty() ? "" : notes.front();
}

std::string message_of(const std::string& text) {
  try {
    parse_points(text, "wing.dat");
  } catch (const rollfix::InputError& error) {
    return error.what();
  }
  return "no error";
}

Part part_of(const std::string& text) {
  return Part(rollfix::outline_through(parse_points(text, "wing.dat"), "wing.dat"));
}

const Surfaces kWing = naca(0.02, 0.4, 0.12, 61, 53);
const Surfaces kBlunt = naca(0.04, 0.3, 0.15, 41, 41, 0.004);

TEST(Airfoil, both_orders_give_the_same_points_with_sharp_and_with_blunt_trailing_edges) {
  EXPECT_EQ(parse_points(lednicer(kWing), "wing.dat"), parse_points(selig(kWing), "wing.dat"));
  EXPECT_EQ(parse_points(lednicer(kBlunt), "wing.dat"), parse_points(selig(kBlunt), "wing.dat"));
}

TEST(Airfoil, starts_at_the_trailing_edge_and_goes_over_the_top) {
  const std::vector<Vec2> points = parse_points(lednicer(kWing), "wing.dat");
  ASSERT_EQ(points.size(), 61U + 53U - 2U);
  EXPECT_EQ(points.front(), Vec2(1, 0));
  EXPECT_EQ(points[60], Vec2(0, 0));
  EXPECT_GT(points[30].y(), 0.05);
  EXPECT_LT(points[90].y(), 0);
}

TEST(Airfoil, both_orders_give_the_same_placements) {
  const Part from_lednicer = part_of(lednicer(kWing));
  const Part from_selig = part_of(selig(kWing));
  const rollfix::Reading reading = shapes::reading_from(from_selig, 0.7, 0.5);
  const auto expected = shapes::starts(rollfix::locate(from_selig, {reading}));
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(shapes::starts(rollfix::locate(from_lednicer, {reading})), expected);
}

TEST(Airfoil, trailing_edge_is_one_corner_when_sharp_and_two_with_a_line_when_blunt) {
  EXPECT_EQ(part_of(lednicer(kWing)).corners().size(), 1U);
  const Part blunt = part_of(lednicer(kBlunt));
  ASSERT_EQ(blunt.corners().size(), 2U);
  const double last = blunt.perimeter() - blunt.corners()[1].s;
  EXPECT_NEAR(last, (kBlunt.above.back() - kBlunt.below.back()).norm(), 1e-6);
}

TEST(Airfoil, note_says_which_order_was_found) {
  EXPECT_THAT(note_of(lednicer(kWing)),
              StartsWith("wing.dat: an airfoil in Lednicer's order, 61 points above and 53 below"));
  EXPECT_THAT(note_of(selig(kWing)), HasSubstr("Selig's order"));
  EXPECT_THAT(note_of("part\n0 0\n1 0\n1 1\n0.5 2\n0 1\n-1 0.5\n"), IsEmpty());
}

TEST(Airfoil, whole_numbers_that_are_points_stay_points) {
  const std::string pixels = "3 4\n9 0\n8 1\n7 2\n6 3\n5 9\n4 4\n2 4\n";  // 3 + 4 points follow the first
  EXPECT_EQ(parse_points(pixels, "scan.txt").size(), 8U);
  EXPECT_EQ(parse_points("2 2\n0 0\n1 0\n", "triangle.txt").size(), 3U);
}

TEST(Airfoil, counts_that_do_not_match_are_refused_with_their_line) {
  std::string text = lednicer(kWing);
  text.replace(text.find("61."), 3, "60.");
  EXPECT_THAT(message_of(text), AllOf(StartsWith("wing.dat:2: '60 53' looks like the numbers of points"),
                                      HasSubstr("114 points follow"), HasSubstr("Selig")));
}

TEST(Airfoil, blocks_that_start_at_different_points_are_refused) {
  EXPECT_THAT(message_of("wing\n3. 3.\n\n0 0\n.5 .1\n1 0\n\n0 -.01\n.5 -.05\n1 0\n"),
              AllOf(StartsWith("wing.dat:2: '3 3' looks like"), HasSubstr("start at different points")));
}

}  // namespace
}  // namespace airfoil_test
