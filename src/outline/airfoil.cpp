#include "outline/airfoil.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "rollfix/error.hpp"
#include "rollfix/outline/points.hpp"

namespace rollfix {

namespace {

/// Airfoils are drawn with a chord of 1. Within this of the origin everything of them lies, flaps included.
constexpr double kMostChordCoordinate = 1.5;
/// A chord this near to 1 is 1, and a trailing edge this near to its end is at its end.
constexpr double kChordSlack = 0.02;
/// Fewer points are not taken for an airfoil's.
constexpr std::size_t kLeastAirfoilPoints = 6;

bool is_count(double value) { return value > 1 && value == std::floor(value); }

/// Whether a blank line (or a comment) stands before this point.
bool starts_a_block(const NumberedPoints& data, std::size_t index) {
  return data.lines[index] > data.lines[index - 1] + 1;
}

bool is_far_from_the_rest(const NumberedPoints& data) {
  return data.points.size() > kLeastAirfoilPoints &&
         std::all_of(data.points.begin() + 1, data.points.end(),
                     [](const Vec2& point) { return point.cwiseAbs().maxCoeff() <= kMostChordCoordinate; });
}

[[noreturn]] void refuse(const NumberedPoints& data, const std::string& name, const std::string& found) {
  const Vec2& counts = data.points.front();
  throw InputError(fmt::format(
      "{}:{}: '{} {}' looks like the numbers of points above and below an airfoil (Lednicer's order), {}; expected as "
      "many points as it says, each surface from the nose on, or the points of one loop without it (Selig's order)",
      name, data.lines.front(), counts.x(), counts.y(), found));
}

/// The number of points above, or 0 when this is not Lednicer's order.
std::size_t lednicer_count(const NumberedPoints& data, const std::string& name) {
  const Vec2& counts = data.points.front();
  if (!is_count(counts.x()) || !is_count(counts.y())) return 0;
  const std::size_t rest = data.points.size() - 1;
  if (counts.sum() != static_cast<double>(rest)) {
    if (is_far_from_the_rest(data) && starts_a_block(data, 1)) {
      refuse(data, name, fmt::format("and {} points follow", rest));
    }
    return 0;
  }
  const auto above = static_cast<std::size_t>(counts.x());
  const Vec2& nose = data.points[1];
  const Vec2& second_nose = data.points[1 + above];
  double size = 0;
  for (std::size_t i = 1; i < data.points.size(); ++i) size = std::max(size, (data.points[i] - nose).norm());
  if ((second_nose - nose).norm() <= kSamePoint * size) return above;
  if (starts_a_block(data, 1) && starts_a_block(data, 1 + above)) {
    refuse(data, name,
           fmt::format("and the two blocks start at different points, ({}, {}) and ({}, {})", nose.x(), nose.y(),
                       second_nose.x(), second_nose.y()));
  }
  return 0;
}

/// From the trailing edge over the top to the nose, and on below; the nose once.
void reorder(NumberedPoints& data, std::size_t above) {
  NumberedPoints loop;
  loop.has_title = data.has_title;
  const auto take = [&](std::size_t i) {
    loop.points.push_back(data.points[i]);
    loop.lines.push_back(data.lines[i]);
  };
  for (std::size_t i = above; i >= 1; --i) take(i);
  for (std::size_t i = above + 2; i < data.points.size(); ++i) take(i);
  data = std::move(loop);
}

bool is_selig(const NumberedPoints& data) {
  const std::vector<Vec2>& points = data.points;
  if (!data.has_title || points.size() < kLeastAirfoilPoints) return false;
  const auto by_x = [](const Vec2& a, const Vec2& b) { return a.x() < b.x(); };
  const auto nose = std::min_element(points.begin(), points.end(), by_x);
  const auto tail = std::max_element(points.begin(), points.end(), by_x);
  const bool has_unit_chord = std::abs(tail->x() - nose->x() - 1) <= kChordSlack && std::abs(nose->x()) <= kChordSlack;
  const bool starts_and_ends_at_tail =
      tail->x() - points.front().x() <= kChordSlack && tail->x() - points.back().x() <= kChordSlack;
  if (!has_unit_chord || !starts_and_ends_at_tail) return false;
  const bool goes_there_and_back =
      std::is_sorted(nose, points.end(), by_x) && std::is_sorted(std::make_reverse_iterator(nose), points.rend(), by_x);
  double area = 0;
  for (std::size_t i = 0; i < points.size(); ++i) area += cross(points[i], points[(i + 1) % points.size()]);
  return goes_there_and_back && area > 0;
}

}  // namespace

std::string order_airfoil(NumberedPoints& data, const std::string& name) {
  if (data.points.empty()) return {};
  const std::size_t above = lednicer_count(data, name);
  if (above > 0) {
    const std::size_t below = data.points.size() - 1 - above;
    reorder(data, above);
    return fmt::format(
        "an airfoil in Lednicer's order, {} points above and {} below; taken from the trailing edge over the top",
        above, below);
  }
  return is_selig(data) ? "an airfoil in Selig's order, from the trailing edge over the top" : "";
}

}  // namespace rollfix
