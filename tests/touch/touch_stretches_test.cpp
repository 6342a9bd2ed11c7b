#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/touch.hpp"
#include "touch_cases.hpp"

// Continua of poses: how many there are, how far each goes, and what single poses are beside it.
namespace touch_stretches_test {

using namespace touch_cases;
using Corners = std::vector<Vec2>;

constexpr double kPi = std::numbers::pi;

Vec2 side_along(const Corners& corners, std::size_t side) {
  return (corners[(side + 1) % corners.size()] - corners[side]).normalized();
}

Vec2 right_of(const Vec2& vector) { return {vector.y(), -vector.x()}; }

TouchProblem touched(const Corners& corners, const std::vector<Vec2>& world, double radius) {
  TouchProblem problem{polygon(corners), {}};
  for (const Vec2& at : world) problem.touches.push_back({at});
  if (radius > 0) problem.finger = rollfix::disk(radius);
  return problem;
}

// ---- how many ----

/// Of the pairs of places of a boundary that are so far apart: how many connected sets there are, by a grid of both
/// places and what hangs together of the squares on whose corners the distance is on both sides.
class PairsApart {
 public:
  PairsApart(const Part& part, double apart) : points_(part.polyline(0, part.perimeter(), kPlaces)) {
    points_.resize(kPlaces);
    square_.assign(kPlaces * kPlaces, false);
    for (int i = 0; i < kPlaces; ++i) {
      for (int j = 0; j < kPlaces; ++j) square_[index(i, j)] = crosses(i, j, apart);
    }
  }

  std::size_t sets() {
    std::size_t count = 0;
    for (int i = 0; i < kPlaces; ++i) {
      for (int j = 0; j < kPlaces; ++j) count += take(i, j) ? 1 : 0;
    }
    return count;
  }

 private:
  static constexpr int kPlaces = 500;

  static std::size_t index(int i, int j) {
    return static_cast<std::size_t>((i + kPlaces) % kPlaces * kPlaces + (j + kPlaces) % kPlaces);
  }
  double distance(int i, int j) const {
    return (points_[static_cast<std::size_t>(i % kPlaces)] - points_[static_cast<std::size_t>(j % kPlaces)]).norm();
  }
  bool crosses(int i, int j, double apart) const {
    const bool is_far = distance(i, j) > apart;
    return is_far != (distance(i + 1, j) > apart) || is_far != (distance(i, j + 1) > apart) ||
           is_far != (distance(i + 1, j + 1) > apart);
  }

  /// Takes all that hangs together with a square, if it is one.
  bool take(int i, int j) {
    if (!square_[index(i, j)]) return false;
    std::vector<std::pair<int, int>> waiting{{i, j}};
    square_[index(i, j)] = false;
    while (!waiting.empty()) {
      const auto [row, column] = waiting.back();
      waiting.pop_back();
      for (int k = 0; k < 9; ++k) {
        const int next_row = (row + k / 3 - 1 + kPlaces) % kPlaces,
                  next_column = (column + k % 3 - 1 + kPlaces) % kPlaces;
        if (!square_[index(next_row, next_column)]) continue;
        square_[index(next_row, next_column)] = false;
        waiting.emplace_back(next_row, next_column);
      }
    }
    return true;
  }

  std::vector<Vec2> points_;
  std::vector<bool> square_;
};

const Corners kBracket{{0, 0}, {60, 0}, {60, 18}, {25, 18}, {20, 23}, {20, 45}, {8, 45}, {0, 37}};

/// As many stretches as by the grid, whatever the noise.
void expect_as_many_as_by_pairs(double apart, double noise) {
  TouchProblem problem = touched(kBracket, {{0, 0}, {apart, 0}}, 0);
  problem.noise.emplace().position = noise;
  const TouchAnswer answer = rollfix::solve(problem);
  const std::size_t sets = PairsApart(problem.part, apart).sets();
  EXPECT_EQ(answer.poses.size(), sets) << apart << ' ' << noise << ' ' << answer.verdict_text();
  EXPECT_EQ(answer.verdict.stretches, sets) << apart << ' ' << noise;
}

TEST(TouchStretches, TwoPlacesLeaveOneForEachSetOfPairsThatAreSoFarApart) { expect_as_many_as_by_pairs(30, 0.02); }

TEST(TouchStretches, TheirNumberIsThatOfTheGeometryHoweverExactTheTouchesAre) { expect_as_many_as_by_pairs(55, 0.001); }

// ---- how far ----

/// What is left of a polygon where normal . x <= most.
Corners cut(const Corners& from, const Vec2& normal, double most) {
  Corners left;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const Vec2 &a = from[k], &b = from[(k + 1) % from.size()];
    const double above_a = normal.dot(a) - most, above_b = normal.dot(b) - most;
    if (above_a <= 0) left.push_back(a);
    if (above_a * above_b < 0) left.push_back(a + above_a / (above_a - above_b) * (b - a));
  }
  return left;
}

/// A ball on the sides of a plate whose upper side leans by a small angle.
struct LeaningPlate {
  double lean = 0;
  double radius = 2;
  double tolerance = 1e-3;
  Pose truth{5, -3, 0.4};

  Corners corners() const { return {{0, 0}, {60, 0}, {50, 20}, {0, 20 + 50 * lean}}; }
  std::vector<std::size_t> sides() const { return {0, 0, 2, 2}; }
  std::vector<Vec2> places() const {
    const Corners all = corners();
    const double top = (all[3] - all[2]).norm();
    std::vector<Vec2> world;
    for (const auto& [side, along] :
         std::array<std::pair<std::size_t, double>, 4>{{{0, 20}, {0, 35}, {2, 0.1 * top}, {2, 0.4 * top}}}) {
      const Vec2 direction = side_along(all, side);
      world.push_back(truth.world(all[side] + along * direction + radius * right_of(direction)));
    }
    return world;
  }
  TouchAnswer answer() const {
    TouchProblem problem = touched(corners(), places(), radius);
    problem.tolerance = rollfix::TouchTolerance{tolerance, 0.1};
    return rollfix::solve(problem);
  }
};

/// How far the poses with the ball beside the sides, within the tolerance, go along the true heading. With one heading
/// they are a polygon; all headings are gone through.
double scanned_slide(const LeaningPlate& plate) {
  constexpr int kHeadings = 4000;
  const Corners corners = plate.corners();
  const std::vector<Vec2> world = plate.places();
  const Vec2 toward = Pose{0, 0, plate.truth.heading}.turned({1, 0});
  const double most = 4 * std::abs(plate.lean) + plate.tolerance;
  double lo = 1e9, hi = -1e9;
  for (int k = -kHeadings; k <= kHeadings; ++k) {
    const Pose turn{0, 0, plate.truth.heading + most * k / kHeadings};
    Corners left{{-200, -200}, {200, -200}, {200, 200}, {-200, 200}};
    for (std::size_t i = 0; i < world.size(); ++i) {
      const std::size_t side = plate.sides()[i];
      const Vec2 out = right_of(side_along(corners, side));
      const Vec2 normal = turn.turned(out);
      const double at = normal.dot(world[i]) - (out.dot(corners[side]) + plate.radius);
      left = cut(cut(left, normal, at + plate.tolerance), -normal, plate.tolerance - at);
    }
    for (const Vec2& place : left) {
      lo = std::min(lo, toward.dot(place));
      hi = std::max(hi, toward.dot(place));
    }
  }
  return hi - lo;
}

/// No less than by the scan, and hardly more.
void expect_slide_as_scanned(const LeaningPlate& plate) {
  const TouchAnswer answer = plate.answer();
  const double scanned = scanned_slide(plate);
  const auto holds = [&](const TouchPose& pose) { return in_extent(pose, plate.truth); };
  const auto pose = std::find_if(answer.poses.begin(), answer.poses.end(), holds);
  ASSERT_NE(pose, answer.poses.end());
  const std::optional<rollfix::Slide> slide = rollfix::slide_of(answer, *pose);
  ASSERT_TRUE(slide.has_value());
  EXPECT_GE(slide->length, scanned * (1 - 1e-6));
  EXPECT_LE(slide->length, scanned * 1.005);
}

TEST(TouchStretches, SidesThatAreNotQuiteParallelHoldThePartBeforeTheyEnd) {
  expect_slide_as_scanned({.lean = 0.005, .tolerance = 1e-3});
  expect_slide_as_scanned({.lean = 0.005, .tolerance = 1e-5});
  expect_slide_as_scanned({.lean = -0.004, .tolerance = 1e-4});
}

TEST(TouchStretches, ABallThatIsLargerHasNoOtherSlide) {
  expect_slide_as_scanned({.lean = 0.005, .radius = 7, .tolerance = 1e-3});
  expect_slide_as_scanned({.lean = 0.005, .radius = 0, .tolerance = 1e-3});
}

// ---- beside ----

const Corners kPlate{{0, 0}, {60, 0}, {60, 20}, {0, 20}};

/// Poses with three points on three lines of a polygon, between their ends: normals that add up to nothing, l1 n1 + l2
/// n2 + l3 n3 = 0, leave an equation of the heading alone, a cos + b sin = c. Not where all lines are parallel.
void add_poses_on(const std::array<std::size_t, 3>& sides, const Corners& corners, const std::vector<Vec2>& world,
                  std::vector<Pose>& poses) {
  std::array<Vec2, 3> out;
  std::array<double, 3> at{};
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = right_of(side_along(corners, sides[i]));
    at[i] = out[i].dot(corners[sides[i]]);
  }
  const std::array<double, 3> share{rollfix::cross(out[1], out[2]), rollfix::cross(out[2], out[0]),
                                    rollfix::cross(out[0], out[1])};
  double a = 0, b = 0, c = 0;
  for (std::size_t i = 0; i < 3; ++i) {  // n . R(-phi) q = cos (n . q) + sin (n x q)
    a += share[i] * out[i].dot(world[i]);
    b += share[i] * rollfix::cross(out[i], world[i]);
    c += share[i] * at[i];
  }
  const double size = std::hypot(a, b);
  if (size < 1e-9 || std::abs(c) > size) return;
  for (const double sign : {-1.0, 1.0}) {
    const double heading = std::atan2(b, a) + sign * std::acos(c / size);
    const Pose back{0, 0, -heading};
    const std::size_t other = std::abs(share[2]) > 1e-9 ? 1 : 2;
    const std::size_t one = other == 2 && std::abs(share[1]) < 1e-9 ? 1 : 0;
    Eigen::Matrix2d lines;
    lines << out[one].transpose(), out[other].transpose();
    const Vec2 moved = lines.inverse() * Vec2(at[one] - out[one].dot(back.turned(world[one])),
                                              at[other] - out[other].dot(back.turned(world[other])));
    bool is_on = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2 from = corners[sides[i]];
      const double along = side_along(corners, sides[i]).dot(back.turned(world[i]) + moved - from);
      is_on = is_on && along >= 0 && along <= (corners[(sides[i] + 1) % corners.size()] - from).norm();
    }
    const Vec2 origin = Pose{0, 0, heading}.turned(-moved);
    if (is_on) poses.push_back({origin.x(), origin.y(), rollfix::nearest_angle(heading)});
  }
}

bool is_near(const Pose& one, const Pose& other, double slack) {
  return std::hypot(one.x - other.x, one.y - other.y) < slack &&
         std::abs(rollfix::nearest_angle(one.heading - other.heading)) < slack;
}

/// Those that are no part of a stretch along the plate.
std::vector<Pose> single_poses(const std::vector<Vec2>& world) {
  std::vector<Pose> all;
  for (std::size_t k = 0; k < 64; ++k) add_poses_on({k / 16, k / 4 % 4, k % 4}, kPlate, world, all);
  std::vector<Pose> single;
  for (const Pose& pose : all) {
    const bool is_along = std::abs(std::sin(pose.heading)) < 1e-6;
    const auto is_same = [&](const Pose& other) { return is_near(pose, other, 1e-6); };
    if (!is_along && std::none_of(single.begin(), single.end(), is_same)) single.push_back(pose);
  }
  return single;
}

/// Two places on the lower side, one on the upper: both lie along it either way round, and elsewhere too.
const std::vector<Vec2> kThree{{26, 0}, {35, 0}, {32, 20}};

/// Poses of sets that go further than this along some axis, or of the others.
std::vector<Pose> listed(const TouchAnswer& answer, bool wide) {
  constexpr double kWide = 1;
  std::vector<Pose> poses;
  for (const TouchPose& pose : answer.poses) {
    if ((std::max(pose.extent[0].width(), pose.extent[1].width()) > kWide) == wide) poses.push_back(pose.pose);
  }
  return poses;
}

TEST(TouchStretches, PosesBesideThemAreFoundAndNoOthers) {
  TouchProblem problem = touched(kPlate, kThree, 0);
  problem.tolerance = rollfix::TouchTolerance{1e-5, 0.1};  // far too many cells: the stretches' stay coarser
  problem.budget = 3000000;
  const TouchAnswer answer = rollfix::solve(problem);
  const std::vector<Pose> single = single_poses(kThree), found = listed(answer, false);
  EXPECT_EQ(listed(answer, true).size(), 2U);
  EXPECT_GE(single.size(), 2U);
  EXPECT_EQ(found.size(), single.size());
  for (const Pose& pose : single) {
    EXPECT_EQ(std::count_if(found.begin(), found.end(), [&](const Pose& one) { return is_near(one, pose, 1e-3); }), 1);
  }
}

TEST(TouchStretches, WithNoiseAPoseBesideOneIsListedWithIt) {
  TouchProblem problem = touched(kPlate, kThree, 0);
  problem.noise.emplace().position = 1e-4;
  // So many standard deviations off a stretch weighs what its length does.
  const Pose pose = single_poses(kThree).front();
  problem.pose = rollfix::PosePrior{{0, 0, pose.heading}, std::abs(std::remainder(pose.heading, kPi)) / 5};
  const TouchAnswer answer = rollfix::solve(problem);
  const std::vector<Pose> found = listed(answer, false);
  EXPECT_EQ(std::count_if(found.begin(), found.end(), [&](const Pose& one) { return is_near(one, pose, 0.01); }), 1);
  EXPECT_EQ(listed(answer, true).size(), 1U);
}

}  // namespace touch_stretches_test
