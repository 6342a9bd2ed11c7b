// Touches any of which may be an outlier: the program's sums over sets of outliers against sums over a grid of poses,
// with every touch's likelihood in closed form.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "outline/turn.hpp"
#include "random.hpp"
#include "rollfix/touch.hpp"
#include "touch/touch_cases.hpp"

namespace touch_outlier_sums_test {

namespace {

using namespace touch_cases;

constexpr double kShare = 0.02;  // of touches, as docs/touch.md says

/// Likelihood of a touch by a point, anywhere on a polygon's sides, given the pose.
class Polygon {
 public:
  Polygon(const std::vector<Vec2>& corners, const rollfix::Noise& noise) : corners_(corners), noise_(noise) {
    for (std::size_t k = 0; k < corners.size(); ++k) perimeter_ += (end(k) - corners[k]).norm();
  }
  double perimeter() const { return perimeter_; }

  double likelihood(const MeasuredTouch& touch, const Pose& pose) const {
    const Vec2 off(touch.at.x() - pose.x, touch.at.y() - pose.y);
    const Vec2 at = Pose{0, 0, -pose.heading}.turned(off);
    double sum = 0;
    for (std::size_t k = 0; k < corners_.size(); ++k) sum += of_side(k, at, touch, pose.heading);
    return sum / perimeter_;
  }
  double of_outlier(const MeasuredTouch& touch) const {
    return 1 / (perimeter_ * perimeter_) / (touch.normal ? kFullTurn : 1);
  }

 private:
  Vec2 end(std::size_t k) const { return corners_[(k + 1) % corners_.size()]; }
  static double density(double off, double sd) {
    return std::exp(-0.5 * off * off / (sd * sd)) / (sd * std::sqrt(kFullTurn));
  }
  double of_side(std::size_t k, const Vec2& at, const MeasuredTouch& touch, double heading) const {
    const Vec2 along = (end(k) - corners_[k]).normalized();
    const double away = (at - corners_[k]).dot(outward(std::atan2(along.y(), along.x())));
    if (std::abs(away) > 6 * noise_.position) return 0;
    const auto below = [&](const Vec2& corner) {
      return 0.5 * std::erfc((at - corner).dot(along) / noise_.position / std::numbers::sqrt2);
    };
    double value = density(away, noise_.position) * (below(end(k)) - below(corners_[k]));
    if (!touch.normal) return value;
    const double normal = std::atan2(along.y(), along.x()) - 0.5 * std::numbers::pi + heading;
    return value * density(std::remainder(*touch.normal - normal, kFullTurn), noise_.angle);
  }

  const std::vector<Vec2>& corners_;
  const rollfix::Noise& noise_;
  double perimeter_ = 0;
};

/// What a sum over poses says.
struct Summed {
  std::vector<double> outlier;  // of each touch
  double near_first = 0;        // probability within four standard deviations of the answer's first pose
};

/// A touch of a part of size `size` says nothing with probability kShare, whatever the others do. If no touch counts
/// the part is anywhere on a square as large as its perimeter.
Summed summed(const TouchProblem& problem, const std::vector<Vec2>& corners, const TouchAnswer& answer) {
  const Polygon polygon(corners, *problem.noise);
  const std::size_t count = problem.touches.size();
  const double size = diagonal(problem.part);
  const double step = 0.6 * problem.noise->position;
  const int turns = static_cast<int>(kFullTurn / (0.6 * problem.noise->angle));
  std::vector<double> stray(count);
  double nothing = polygon.perimeter() * polygon.perimeter() * kFullTurn;
  for (std::size_t k = 0; k < count; ++k) nothing *= stray[k] = kShare * polygon.of_outlier(problem.touches[k]);
  double all = nothing, near = 0;
  std::vector<double> outlier(count, nothing);
  Vec2 least = problem.touches.front().at, most = least;
  for (const MeasuredTouch& touch : problem.touches) {
    least = least.cwiseMin(touch.at - Vec2(size, size));
    most = most.cwiseMax(touch.at + Vec2(size, size));
  }
  const TouchPose* const first = answer.poses.empty() ? nullptr : &answer.poses.front();
  std::vector<double> mixed(count);
  for (int turn = 0; turn < turns; ++turn) {
    for (double x = least.x(); x < most.x(); x += step) {
      for (double y = least.y(); y < most.y(); y += step) {
        const Pose pose{x, y, turn * kFullTurn / turns};
        double product = 1, without = 1;
        for (std::size_t k = 0; k < count; ++k) {
          mixed[k] = stray[k] + (1 - kShare) * polygon.likelihood(problem.touches[k], pose);
          product *= mixed[k];
          without *= stray[k];
        }
        if (product <= without * (1 + 1e-12)) continue;
        const double volume = step * step * kFullTurn / turns;
        all += volume * (product - without);
        for (std::size_t k = 0; k < count; ++k) outlier[k] += volume * (product * stray[k] / mixed[k] - without);
        if (first == nullptr) continue;
        const Eigen::Vector3d off(x - first->spread.mean.x, y - first->spread.mean.y,
                                  std::remainder(pose.heading - first->spread.mean.heading, kFullTurn));
        if (off.dot(first->spread.covariance.inverse() * off) <= 16) near += volume * (product - without);
      }
    }
  }
  for (double& one : outlier) one /= all;
  return {outlier, near / all};
}

}  // namespace

TEST(TouchOutlierSums, AreAsProbableAsASumOverAllPosesSays) {
  const int count = test_count(3);
  for (int c = 0; c < count; ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 7300);
    std::vector<Vec2> corners{{0, 0}, {2, 0}, {2, 0.8}, {0.9, 1.6}, {0, 1.2}};
    const Making making{3U + static_cast<std::size_t>(c % 2), 4, 0, 0.06, 8 * rollfix::kDegree};
    TouchProblem problem = random_case(polygon(corners), making, generator).problem;
    problem.robust = true;
    problem.touches[0].at += scatter(generator, 0.3);  // about as probable as an outlier, or not
    const TouchAnswer answer = solve(problem);
    const Summed wanted = summed(problem, corners, answer);
    for (std::size_t k = 0; k < problem.touches.size(); ++k) {
      EXPECT_NEAR(answer.outlier[k], wanted.outlier[k], 0.02 + 0.05 * wanted.outlier[k]) << c << ", touch " << k;
    }
    ASSERT_FALSE(answer.poses.empty());
    EXPECT_NEAR(answer.poses.front().probability, wanted.near_first, 0.05) << c;
  }
}

}  // namespace touch_outlier_sums_test
