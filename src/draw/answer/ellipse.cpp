#include "draw/answer/ellipse.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace rollfix::draw {
namespace {

constexpr int kEllipsePoints = 96;

Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes_of(const Eigen::Matrix2d& covariance) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(covariance);
  return solver;
}

}  // namespace

std::vector<Vec2> ellipse(const Vec2& mean, const Eigen::Matrix2d& covariance, double sigmas) {
  const auto solver = axes_of(covariance);
  const Vec2 half = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  std::vector<Vec2> points;
  for (int k = 0; k < kEllipsePoints; ++k) {
    const double angle = 2 * std::numbers::pi * k / kEllipsePoints;
    const Vec2 by(half.x() * std::cos(angle), half.y() * std::sin(angle));
    points.emplace_back(mean + sigmas * solver.eigenvectors() * by);
  }
  return points;
}

Vec2 half_axes(const Eigen::Matrix2d& covariance) {
  const Vec2 half = axes_of(covariance).eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return {half.y(), half.x()};
}

}  // namespace rollfix::draw
