#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <string>

#include "random.hpp"
#include "touch/touch_cases.hpp"

// Poses that are found by other means are among those of the search.
namespace touch_other_searches_test {

using namespace touch_cases;

/// The boundary as points with tangents: the distance of a place from it, by looking at each.
class Points {
 public:
  explicit Points(const Part& part) {
    for (int k = 0; k < kCount; ++k) {
      const double s = part.perimeter() * (k + 0.5) / kCount;
      points_.push_back(part.point(s));
      tangents_.push_back(part.tangent(s));
    }
  }

  struct Nearest {
    double along = 0;  // from the point, along its tangent and its normal
    double across = 0;
    double tangent = 0;
    double distance = 0;
  };
  Nearest nearest(const Vec2& place) const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < points_.size(); ++k) {
      if ((points_[k] - place).squaredNorm() < (points_[best] - place).squaredNorm()) best = k;
    }
    const Vec2 off = place - points_[best];
    const Vec2 tangent(std::cos(tangents_[best]), std::sin(tangents_[best]));
    return {off.dot(tangent), off.dot(outward(tangents_[best])), tangents_[best], off.norm()};
  }

 private:
  static constexpr int kCount = 3000;
  std::vector<Vec2> points_;
  std::vector<double> tangents_;
};

Vec2 in_part(const Pose& pose, const Vec2& world) {
  return Pose{0, 0, -pose.heading}.turned(world - Vec2(pose.x, pose.y));
}

/// Point to line, a few rounds: places only.
Pose fitted(const Points& points, const std::vector<MeasuredTouch>& touches, Pose pose) {
  for (int round = 0; round < 40; ++round) {
    Eigen::Matrix3d matrix = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const MeasuredTouch& touch : touches) {
      const Vec2 place = in_part(pose, touch.at);
      const Points::Nearest near = points.nearest(place);
      const Vec2 normal = pose.turned(outward(near.tangent));
      const Vec2 arm = touch.at - Vec2(pose.x, pose.y);
      // across = normal . (touch - pose): how it changes with the pose's x, y, heading.
      const Eigen::Vector3d row(-normal.x(), -normal.y(), -normal.dot(Vec2(-arm.y(), arm.x())));
      matrix += row * row.transpose();
      right -= row * near.across;
    }
    const Eigen::Vector3d step = matrix.inverse() * right;
    if (!step.allFinite()) return pose;
    const double most = std::max(1.0, std::abs(step(2)) / 0.3);
    pose = {pose.x + step(0) / most, pose.y + step(1) / most, pose.heading + step(2) / most};
    if (step.norm() < 1e-12) break;
  }
  return pose;
}

double worst(const Points& points, const std::vector<MeasuredTouch>& touches, const Pose& pose) {
  double most = 0;
  for (const MeasuredTouch& touch : touches) {
    most = std::max(most, points.nearest(in_part(pose, touch.at)).distance);
  }
  return most;
}

bool is_known(const TouchAnswer& answer, const Pose& pose) {
  return std::any_of(answer.poses.begin(), answer.poses.end(),
                     [&](const TouchPose& one) { return in_extent(one, pose); });
}

TouchProblem with_tolerance(const Case& one, double tolerance) {
  TouchProblem problem = one.problem;
  problem.noise.reset();
  problem.tolerance = rollfix::TouchTolerance{tolerance, 0};
  return problem;
}

TEST(TouchOtherSearches, FittingFromRandomStartsFindsNoPoseThatIsNotListed) {
  int compared = 0;
  for (int c = 0; c < test_count(6); ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 300);
    const Part part = c % 2 == 0 ? rollfix::load_part("gallery:spline,n=9,wobble=0.25,seed=" + std::to_string(c + 1))
                                 : random_polygon(generator);
    const double tolerance = 0.004 * diagonal(part);
    const Case one = random_case(part, {4, 0, 0, tolerance / 4.5, 0}, generator);
    const TouchAnswer answer = rollfix::solve(with_tolerance(one, tolerance));
    const Points points(part);
    for (int start = 0; start < 60; ++start) {
      const MeasuredTouch& first = one.problem.touches.front();
      Pose from{0, 0, uniform(generator, -3.2, 3.2)};
      const Vec2 place = first.at - from.turned(part.point(uniform(generator, 0, part.perimeter())));
      const Pose found = fitted(points, one.problem.touches, {place.x(), place.y(), from.heading});
      if (worst(points, one.problem.touches, found) > 0.95 * tolerance) continue;
      ++compared;
      EXPECT_TRUE(is_known(answer, found) || answer.status == rollfix::Status::incomplete)
          << "case " << c << ": " << found.x << ", " << found.y << ", " << found.heading;
    }
  }
  EXPECT_GT(compared, 0);
}

/// Halves boxes of poses until they are refuted by the distance alone, or small.
class Boxes {
 public:
  Boxes(const Points& points, const std::vector<MeasuredTouch>& touches, double tolerance)
      : points_(points), touches_(touches), tolerance_(tolerance) {}

  /// Centres of small boxes that fit themselves.
  std::vector<Pose> search(const Pose& middle, double place, double turn) {
    visit(middle, place, turn);
    return found_;
  }

 private:
  void visit(const Pose& middle, double place, double turn) {
    for (const MeasuredTouch& touch : touches_) {
      const double arm = (touch.at - Vec2(middle.x, middle.y)).norm();
      const double slack = std::numbers::sqrt2 * place + arm * turn + tolerance_;
      if (points_.nearest(in_part(middle, touch.at)).distance > 1.01 * slack) return;
    }
    if (place < 0.3 * tolerance_) {
      if (worst(points_, touches_, middle) <= 0.95 * tolerance_) found_.push_back(middle);
      return;
    }
    for (int k = 0; k < 8; ++k) {
      const auto side = [&](int bit) { return (k >> bit & 1) != 0 ? 0.5 : -0.5; };
      visit({middle.x + side(0) * place, middle.y + side(1) * place, middle.heading + side(2) * turn}, 0.5 * place,
            0.5 * turn);
    }
  }

  const Points& points_;
  const std::vector<MeasuredTouch>& touches_;
  double tolerance_;
  std::vector<Pose> found_;
};

TEST(TouchOtherSearches, BoxesOfPosesHoldNoneThatIsNotListed) {
  std::size_t compared = 0;
  for (int c = 0; c < test_count(2); ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 400);
    const Part part = c % 2 == 0 ? bracket() : rollfix::load_part("gallery:spline,n=9,wobble=0.25,seed=4");
    const double size = diagonal(part);
    const double tolerance = 0.03 * size;
    const Case one = random_case(part, {5, 0, 0, tolerance / 4.5, 0}, generator);
    const TouchAnswer answer = rollfix::solve(with_tolerance(one, tolerance));
    const Points points(part);
    // A part that is touched is no further from a touch than its own size.
    const Pose middle{one.problem.touches[0].at.x(), one.problem.touches[0].at.y(), 0};
    for (const Pose& pose :
         Boxes(points, one.problem.touches, tolerance).search(middle, 1.1 * size, std::numbers::pi)) {
      ++compared;
      EXPECT_TRUE(is_known(answer, pose) || answer.status == rollfix::Status::incomplete)
          << "case " << c << ": " << pose.x << ", " << pose.y << ", " << pose.heading;
    }
  }
  EXPECT_GT(compared, 0U);
}

}  // namespace touch_other_searches_test
