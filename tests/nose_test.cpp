// A corner is told from a sparsely sampled nose by its neighbours; an airfoil has corners at its trailing edge only.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "outline/corners.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace rollfix::nose_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// A symmetric NACA section with so many points on a side, evenly along the chord or denser towards its ends; from the
/// trailing edge over the top, without that again at the end.
std::vector<Vec2> section(double thickness, int count, bool evenly) {
  const auto half = [&](double x) {
    return 5 * thickness *
           (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x);
  };
  const auto place = [&](int k) {
    const double share = static_cast<double>(k) / (count - 1);
    return evenly ? share : (1 - std::cos(kPi * share)) / 2;
  };
  std::vector<Vec2> points{{1, 0}};
  for (int k = count - 2; k > 0; --k) points.emplace_back(place(k), half(place(k)));
  points.emplace_back(0, 0);
  for (int k = 1; k < count - 1; ++k) points.emplace_back(place(k), -half(place(k)));
  return points;
}

std::string file_of(const std::vector<Vec2>& points) {
  std::string text = "A section\n";
  for (const Vec2& point : points) text += fmt::format("{:.7f} {:.7f}\n", point.x(), point.y());
  return text + fmt::format("{:.7f} {:.7f}\n", points.front().x(), points.front().y());
}

/// As load_outline makes it of a file with this text.
Part part_of(const std::string& text, OutlineOptions options = {}) {
  std::string unit;
  const std::vector<Vec2> points = parse_points(text, "section.dat", options, nullptr, &unit, &options.airfoil);
  return Part(outline_through(points, "section.dat", options));
}

std::size_t corners_before(const Part& part, double x) {
  return static_cast<std::size_t>(std::count_if(part.corners().begin(), part.corners().end(),
                                                [&](const Corner& corner) { return part.point(corner.s).x() < x; }));
}

TEST(Nose, an_airfoil_file_has_corners_at_its_trailing_edge_only) {
  for (const double thickness : {0.06, 0.12, 0.2}) {
    for (const int count : {8, 12, 17, 30, 60}) {
      for (const bool evenly : {false, true}) {
        const Part part = part_of(file_of(section(thickness, count, evenly)));
        EXPECT_EQ(part.corners().size(), 1U) << thickness << " " << count << " " << evenly;
        EXPECT_EQ(corners_before(part, 0.98), 0U);
      }
    }
  }
}

TEST(Nose, a_corner_angle_that_is_given_counts_for_airfoils_as_well) {
  OutlineOptions options;
  options.corner_angle = kCornerAngle;
  EXPECT_EQ(corners_before(part_of(file_of(section(0.12, 12, false)), options), 0.98), 1U);
}

TEST(Nose, plain_points_around_a_nose_make_a_curve) {
  for (const double thickness : {0.1, 0.15, 0.2}) {
    for (const int count : {10, 14, 20}) {
      const std::vector<Vec2> points = section(thickness, count, false);
      EXPECT_EQ(corners_of_points(points, true, false), (std::vector<std::size_t>{0})) << thickness << " " << count;
    }
  }
}

TEST(Nose, the_curve_is_nearer_to_the_section_than_one_with_a_corner) {
  const Part truth(outline_through(section(0.12, 400, false), "truth", {}));
  const auto off = [&](const OutlineOptions& options) {
    const Part part(outline_through(section(0.12, 12, false), "sparse", options));
    double most = 0;
    for (int k = 0; k < 400; ++k) {
      const Vec2 point = truth.point(truth.perimeter() * (0.45 + 0.1 * k / 400));  // around the nose
      double least = 1;
      for (int i = 0; i < 2000; ++i) {
        least = std::min(least, (part.point(part.perimeter() * (0.4 + 0.2 * i / 2000)) - point).norm());
      }
      most = std::max(most, least);
    }
    return most;
  };
  OutlineOptions with_corner;
  with_corner.corner_angle = kCornerAngle;
  EXPECT_LT(off({}), 0.5 * off(with_corner));
}

/// Points along a polygon whose sides are straight or bulge, with its vertices among them: three inside a side at
/// least, for an arc with less looks like any curve.
std::vector<Vec2> along(const std::vector<Vec2>& vertices, const std::vector<double>& bulges, int count) {
  std::vector<Vec2> points;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Vec2& from = vertices[k];
    const Vec2 side = vertices[(k + 1) % vertices.size()] - from;
    const Vec2 outwards(side.y(), -side.x());
    const int parts = std::max(4, count / static_cast<int>(vertices.size()));
    for (int i = 0; i < parts; ++i) {
      const double share = static_cast<double>(i) / parts;
      points.push_back(from + share * side + 4 * bulges[k] * share * (1 - share) * outwards);
    }
  }
  return points;
}

std::vector<std::size_t> by_angle_alone(const std::vector<Vec2>& points) {
  const ChordTurns turns(points, true);
  std::vector<std::size_t> corners;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (std::abs(turns.at(k)) >= kCornerAngle) corners.push_back(k);
  }
  return corners;
}

TEST(Nose, polygons_keep_their_corners_whether_their_sides_are_straight_or_arcs) {
  std::mt19937_64 generator = test_generator(91);
  std::uniform_real_distribution<double> radius(0.5, 1.5);
  std::uniform_int_distribution<int> vertices(3, 7);
  std::uniform_int_distribution<int> bulge(0, 3);
  for (int k = 0; k < test_count(200); ++k) {
    const int m = vertices(generator);
    std::vector<Vec2> polygon;
    std::vector<double> bulges;
    for (int i = 0; i < m; ++i) {
      polygon.push_back(radius(generator) * Vec2(std::cos(2 * kPi * i / m), std::sin(2 * kPi * i / m)));
      bulges.push_back(k % 2 == 0 ? 0 : 0.06 * bulge(generator));
    }
    for (const int count : {20, 50, 200, 2000}) {
      const std::vector<Vec2> points = along(polygon, bulges, count);
      EXPECT_EQ(corners_of_points(points, true, false), by_angle_alone(points)) << k << " " << count;
    }
  }
}

TEST(Nose, vertices_alone_are_corners) {
  for (const int m : {3, 4, 5, 6}) {
    std::vector<Vec2> points;
    for (int k = 0; k < m; ++k) points.emplace_back(std::cos(2 * kPi * k / m), std::sin(2 * kPi * k / m));
    EXPECT_EQ(corners_of_points(points, true, false).size(), static_cast<std::size_t>(m));
  }
}

TEST(Nose, an_open_curve_has_none_at_its_ends) {
  const std::vector<Vec2> points{{0, 0}, {1, 0}, {1, 1}, {2, 1}};
  EXPECT_EQ(corners_of_points(points, false, false), (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(spline_with_corners(points, false, {1, 2}).size(), 3U);
}

}  // namespace
}  // namespace rollfix::nose_test
