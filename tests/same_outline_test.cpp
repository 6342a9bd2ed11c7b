// One outline in three formats: the same placements, within what each says of its own accuracy.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "files/formats.hpp"
#include "random.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

namespace same_outline_test {
namespace {

using rollfix::Part;
using rollfix::Vec2;

constexpr double kPi = shapes::kPi;

/// An egg of four arcs that join smoothly: radius 3 below, 1 on top, 5 on the flanks. It starts at the bottom.
struct Egg {
  static constexpr double kBottom = 3;
  static constexpr double kTop = 1;
  static constexpr double kFlank = 5;
  double height = 0;  // of the top arc's centre above the bottom arc's
  double side = 0;    // the right flank's centre lies this far to the left on the bottom arc's level ...
  double turn = 0;    // ... and the flank arcs sweep this angle

  Egg() {
    side = kFlank - kBottom;
    height = std::sqrt((kFlank - kTop) * (kFlank - kTop) - side * side);
    turn = std::atan2(height, side);
  }
  Vec2 top_centre() const { return {0, height}; }
  Vec2 shoulder() const { return top_centre() + kTop * Vec2(std::cos(turn), std::sin(turn)); }
};

std::string dxf_arc(const Vec2& centre, double radius, double from, double to) {
  const double degree = 180 / kPi;
  return fmt::format("0\nARC\n8\n0\n10\n{}\n20\n{}\n40\n{}\n50\n{}\n51\n{}\n", centre.x(), centre.y(), radius,
                     from * degree, to * degree);
}

Part from_drawing(const rollfix::Drawing& drawing) { return Part(rollfix::loops(drawing).closed.at(0).outline); }

Part egg_as_dxf() {
  const Egg egg;
  const std::string arcs =
      dxf_arc({0, 0}, Egg::kBottom, -kPi / 2, 0) + dxf_arc({-egg.side, 0}, Egg::kFlank, 0, egg.turn) +
      dxf_arc(egg.top_centre(), Egg::kTop, egg.turn, kPi - egg.turn) +
      dxf_arc({egg.side, 0}, Egg::kFlank, kPi - egg.turn, kPi) + dxf_arc({0, 0}, Egg::kBottom, kPi, 1.5 * kPi);
  return from_drawing(rollfix::files::parse_dxf("0\nSECTION\n2\nENTITIES\n" + arcs + "0\nENDSEC\n0\nEOF\n", "egg.dxf"));
}

Part egg_as_svg() {
  const Egg egg;
  const Vec2 s = egg.shoulder();
  // y points down in an SVG: a turn to the left has sweep flag 0.
  const std::string d =
      fmt::format("M0 3 A3 3 0 0 0 3 0 A5 5 0 0 0 {} {} A1 1 0 0 0 {} {} A5 5 0 0 0 -3 0 A3 3 0 0 0 0 3 Z", s.x(),
                  -s.y(), -s.x(), -s.y());
  return from_drawing(rollfix::files::parse_svg(
      fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg"><path d="{}"/></svg>)", d), "egg.svg"));
}

Part egg_as_points(const Part& exact, int count) {
  std::vector<Vec2> points;
  for (int k = 0; k < count; ++k) points.push_back(exact.point(exact.perimeter() * k / count));
  return Part(rollfix::outline_through(points, "egg.csv"));
}

/// The spline through dense points is off by this much at most: measured on a curve from joint to joint, where the
/// curvature jumps, it is largest.
struct Deviation {
  double place = 0;  // length
  double turn = 0;   // radians
};

Deviation deviation(const Part& one, const Part& other) {
  Deviation most;
  constexpr int kSamples = 100000;  // many in each of the spline's spans: the deviation peaks within one
  for (int k = 0; k < kSamples; ++k) {
    const double s = std::min(one.perimeter(), other.perimeter()) * (k + 0.5) / kSamples;
    most.place = std::max(most.place, (one.point(s) - other.point(s)).norm());
    const double difference = one.turning().angle(s) - other.turning().angle(s);
    most.turn = std::max(most.turn, std::abs(std::remainder(difference, 2 * kPi)));
  }
  return most;
}

/// Every place that fits on one part fits on the other within the deviation, and none is left over.
void expect_same_placements(const Part& one, const Part& other, const Deviation& off, std::uint64_t stream) {
  std::mt19937_64 generator = test_generator(stream);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < test_count(200); ++k) {
    const double s = one.perimeter() * share(generator);
    const rollfix::Reading reading = shapes::reading_from(one, s, one.perimeter() * (0.05 + 0.4 * share(generator)));
    rollfix::LocateOptions options;
    options.tolerance = 1e-9;
    const rollfix::Search found = rollfix::locate(one, reading, options);
    options.tolerance = 1e-9 + 2 * off.turn + off.place;  // both ends, and the curvature times what the length is off
    const rollfix::Search near = rollfix::locate(other, reading, options);
    for (const rollfix::Placement& placement : found.placements) {
      EXPECT_TRUE(shapes::holds(other, near, placement.start[0], 1e-9 + off.place)) << placement.start[0];
    }
    options.tolerance *= 2;
    const rollfix::Search wide = rollfix::locate(one, reading, options);
    for (const rollfix::Placement& placement : near.placements) {
      EXPECT_TRUE(shapes::holds(one, wide, placement.start[0], 1e-9 + off.place)) << placement.start[0];
    }
  }
}

TEST(SameOutline, as_dxf_and_as_svg_is_the_same_to_rounding) {
  const Part dxf = egg_as_dxf();
  const Part svg = egg_as_svg();
  EXPECT_NEAR(dxf.perimeter(), svg.perimeter(), 1e-9);
  const Deviation off = deviation(dxf, svg);
  EXPECT_LT(off.place, 1e-9);
  EXPECT_LT(off.turn, 1e-9);
  expect_same_placements(dxf, svg, off, 1);
}

TEST(SameOutline, as_dense_points_is_the_same_within_the_deviation) {
  const Part dxf = egg_as_dxf();
  const Part points = egg_as_points(dxf, 2000);
  const Deviation off = deviation(dxf, points);
  EXPECT_LT(off.place, 1e-5);
  EXPECT_LT(off.turn, 2e-3);  // where the curvature jumps by 0.8, over a spacing of 0.007
  expect_same_placements(dxf, points, off, 2);
}

TEST(SameOutline, has_the_length_and_the_turn_of_its_arcs) {
  const Egg egg;
  const Part part = egg_as_dxf();
  const double flank = egg.turn;
  EXPECT_NEAR(part.perimeter(), kPi * Egg::kBottom + 2 * flank * Egg::kFlank + (kPi - 2 * flank) * Egg::kTop, 1e-9);
  EXPECT_TRUE(part.corners().empty() || std::abs(part.corners().front().turn) < 1e-9);
}

}  // namespace
}  // namespace same_outline_test
