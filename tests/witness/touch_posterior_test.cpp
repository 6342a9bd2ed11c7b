#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "outline/turn.hpp"
#include "touch/touch_cases.hpp"

// Probabilities, means and standard deviations of poses, against sums over a grid of poses and all of the boundary.
namespace touch_posterior_test {

using namespace touch_cases;

constexpr int kBoundary = 4000;  // its points are less than a standard deviation apart
constexpr int kSide = 13;        // of the grid, in steps of ...
constexpr double kStep = 0.75;   // ... so many standard deviations

/// The likelihood of places, each touch anywhere on the boundary.
class Likelihood {
 public:
  explicit Likelihood(const TouchProblem& problem) : problem_(problem) {
    for (int k = 0; k < kBoundary; ++k) {
      const double s = problem.part.perimeter() * (k + 0.5) / kBoundary;
      tangents_.push_back(problem.part.tangent(s));
      points_.push_back(problem.part.point(s));
    }
  }

  double at(const Pose& pose) const {
    double product = 1;
    for (const MeasuredTouch& touch : problem_.touches) {
      const Vec2 place = Pose{0, 0, -pose.heading}.turned(touch.at - Vec2(pose.x, pose.y));
      double sum = 0;
      for (std::size_t k = 0; k < points_.size(); ++k) {
        double square = (points_[k] - place).squaredNorm() / std::pow(problem_.noise->position, 2);
        if (square > 60) continue;
        if (touch.normal) {
          const double normal = tangents_[k] - 0.5 * std::numbers::pi + pose.heading;
          square += std::pow(std::remainder(*touch.normal - normal, kFullTurn) / problem_.noise->angle, 2);
        }
        sum += std::exp(-0.5 * square);
      }
      product *= sum;
    }
    return product;
  }

 private:
  const TouchProblem& problem_;
  std::vector<Vec2> points_;
  std::vector<double> tangents_;
};

struct Summed {
  double weight = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // in standard deviations of the answer, from its mean
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

Summed summed(const Likelihood& likelihood, const TouchPose& pose) {
  const Eigen::Matrix3d axes = Eigen::LLT<Eigen::Matrix3d>(pose.spread.covariance).matrixL();
  const Pose& mean = pose.spread.mean;
  Summed all;
  for (int k = 0; k < kSide * kSide * kSide; ++k) {
    const Eigen::Vector3d at =
        kStep * Eigen::Vector3d(k % kSide - kSide / 2, k / kSide % kSide - kSide / 2, k / (kSide * kSide) - kSide / 2);
    const Eigen::Vector3d off = axes * at;
    const double weight = likelihood.at({mean.x + off(0), mean.y + off(1), mean.heading + off(2)});
    all.weight += weight;
    all.mean += weight * at;
    all.second += weight * at * at.transpose();
  }
  all.mean /= all.weight;
  all.second = (all.second / all.weight - all.mean * all.mean.transpose()).eval();
  all.weight *= axes.determinant();
  return all;
}

void expect_alike(const TouchProblem& problem) {
  const TouchAnswer answer = rollfix::solve(problem);
  ASSERT_GT(answer.poses.size(), 1U);
  const Likelihood likelihood(problem);
  std::vector<Summed> sums;
  double total = 0;
  for (const TouchPose& pose : answer.poses) {
    sums.push_back(summed(likelihood, pose));
    total += sums.back().weight;
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (answer.poses[k].probability < 0.05) continue;
    SCOPED_TRACE("pose " + std::to_string(k));
    EXPECT_NEAR(answer.poses[k].probability, sums[k].weight / total, 0.02);
    EXPECT_LE(sums[k].mean.cwiseAbs().maxCoeff(), 0.1);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(sums[k].second(i, i)), 1, 0.07);
  }
}

TouchProblem touched(const Part& part, std::size_t count, std::size_t normals, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  TouchProblem problem =
      random_case(part, {count, normals, 0, 1e-3 * diagonal(part), rollfix::kDegree}, generator).problem;
  problem.diagnose = false;
  return problem;
}

TEST(TouchPosterior, OfPlacesOnASplineIsTheSumOverPosesAndTheBoundary) {
  expect_alike(touched(rollfix::load_part("gallery:spline,n=9,seed=2,wobble=0.25"), 4, 0, 5));
}

TEST(TouchPosterior, OfNormalsOnASplineIsTheSumOverPosesAndTheBoundary) {
  expect_alike(touched(rollfix::load_part("gallery:spline,n=9,seed=3,wobble=0.25"), 2, 2, 5));
}

TEST(TouchPosterior, OfPlacesOnStraightSidesIsTheSumOverPosesAndTheBoundary) {
  expect_alike(touched(bracket(), 3, 0, 8));
}

/// Along the curve of poses that two places leave, the search stops at cells far coarser than the noise.
TEST(TouchPosterior, OfTwoPlacesThatAreNearlyExactIsACurveThatHoldsTheTruth) {
  std::mt19937_64 generator(4);
  const Part part = bracket();
  Case one = random_case(part, {2, 0, 0, 1e-5 * diagonal(part), 0}, generator);
  const TouchAnswer answer = rollfix::solve(one.problem);
  EXPECT_EQ(answer.status, rollfix::Status::complete);
  ASSERT_FALSE(answer.poses.empty());
  const auto holds = [&](const TouchPose& pose) { return pose.continuum && in_extent(pose, one.truth); };
  EXPECT_TRUE(std::any_of(answer.poses.begin(), answer.poses.end(), holds));
  for (const TouchPose& pose : answer.poses) EXPECT_LE(pose.worst, 1);
}

}  // namespace touch_posterior_test
