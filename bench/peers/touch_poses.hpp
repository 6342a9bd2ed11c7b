#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "rollfix/part.hpp"
#include "rollfix/touch.hpp"

namespace bench {

/// An outline as a scan matcher has it: points with their normals, and of each cell of a grid which point is nearest.
class NearestPoints {
 public:
  explicit NearestPoints(const rollfix::Part& part);

  struct Place {
    rollfix::Vec2 point = rollfix::Vec2::Zero();
    rollfix::Vec2 tangent = rollfix::Vec2::Zero();
    double angle = 0;
    double curvature = 0;
  };
  /// Of the boundary, next to this point in the part's frame.
  Place nearest(const rollfix::Vec2& point) const;
  /// Anywhere on it.
  const Place& random(std::mt19937_64& generator) const;
  double diagonal() const { return diagonal_; }

 private:
  std::vector<Place> places_;
  std::vector<std::uint32_t> cells_;
  rollfix::Vec2 corner_ = rollfix::Vec2::Zero();
  double step_ = 1;
  double diagonal_ = 1;
};

/// Touches by a point, with the standard deviations of their places and normals.
struct TouchQuestion {
  const NearestPoints& outline;
  const std::vector<rollfix::MeasuredTouch>& touches;
  double place_sd = 0;
  double normal_sd = 0;  // radians
};

/// Whether every residual is within rollfix::kPossibleSigmas.
bool fits(const TouchQuestion& question, const rollfix::Pose& pose);

/// Each method begins with the first touch anywhere on the outline, its normal right where it has one. What fits comes
/// back, once or more often.
/// Levenberg-Marquardt (Ceres' TinySolver) on distances to the outline and on normals.
std::vector<rollfix::Pose> poses_by_least_squares(const TouchQuestion& question, int starts);
/// Besl and McKay (1992): nearest points, the rigid motion that fits them best, and again.
std::vector<rollfix::Pose> poses_by_icp(const TouchQuestion& question, int starts);
/// Particles of the pose, weighed by all touches as noise is brought down from a tenth of the part to what it is, drawn
/// again and shaken each time.
std::vector<rollfix::Pose> poses_by_particles(const TouchQuestion& question, int particles);

}  // namespace bench
