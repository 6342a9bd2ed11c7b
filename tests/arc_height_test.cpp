// How far an arc can be from its chord: places of spirals that turn by little and by much.
#include "part/arc_height.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "random.hpp"

namespace arc_height_test {
namespace {

using Point = std::complex<double>;

/// e^((b + i) u): its tangent turns by what u changes by. b = 0 is a circle.
struct LogSpiral {
  double b;
  Point at(double u) const { return std::exp(Point(b, 1) * u); }
  double length(double from, double to) const {
    return b == 0 ? to - from : std::sqrt(1 + b * b) / b * (std::exp(b * to) - std::exp(b * from));
  }
};

double distance_from_chord(const Point& start, const Point& end, const Point& point) {
  const Point along = end - start;
  const double share = std::clamp((std::conj(along) * (point - start)).real() / std::norm(along), 0.0, 1.0);
  return std::abs(point - start - share * along);
}

double furthest(const LogSpiral& curve, double from, double to) {
  double most = 0;
  for (int k = 0; k <= 400; ++k) {
    const Point point = curve.at(from + (to - from) * k / 400);
    most = std::max(most, distance_from_chord(curve.at(from), curve.at(to), point));
  }
  return most;
}

double bound_of(const LogSpiral& curve, double from, double to) {
  return rollfix::part::arc_height(std::abs(curve.at(to) - curve.at(from)), curve.length(from, to), to - from);
}

TEST(ArcHeight, is_a_bound_whatever_the_arc_turns_by) {
  std::mt19937_64 generator = test_generator(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < test_count(1000); ++k) {
    const LogSpiral curve{3 * unit(generator)};
    const double from = -5 * unit(generator), to = from + 9 * std::pow(unit(generator), 2);
    if (to - from < 1e-3) continue;
    EXPECT_LE(furthest(curve, from, to), bound_of(curve, from, to)) << curve.b << ", " << from << " to " << to;
  }
}

TEST(ArcHeight, of_a_short_arc_is_near_what_it_is) {
  const LogSpiral circle{0};
  EXPECT_LT(bound_of(circle, 0, 0.1), 2.01 * furthest(circle, 0, 0.1));
}

TEST(ArcHeight, of_a_whole_circle_has_room_for_it) { EXPECT_GE(rollfix::part::arc_height(0, 6.2832, 6.2832), 2); }

}  // namespace
}  // namespace arc_height_test
