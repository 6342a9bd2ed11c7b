#pragma once

#include <optional>

#include "contact_look.hpp"
#include "hold_fit.hpp"

namespace rollfix::hold {

/// Where contacts are exact they are still blurred by this share of the perimeter, so that corners have a slope.
inline constexpr double kLeastBlur = 1e-7;
/// Of a standard deviation of the heading: poses of a row that differ by less are one.
inline constexpr double kSamePose = 0.05;
/// A pose by whose square a row is so much worse is five standard deviations off.
inline constexpr double kFitsToo = 25;

using RowBlock = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 2 * kMostFingers>;

/// Where a contact is on the part, and how far it may be off: whatever the part's pose.
struct HoldFit::Sight {
  BlurredPlace at;
  Vec2 point = Vec2::Zero();                              // if it is evidence
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // C^-1, 0 for what is not measured
  double log_size = 0;                                    // log det C, corners by their share
  double blur_size = 0;                                   // of it what corners add
  double angles = 1;                                      // numbers that the angle counts as
  double turn_variance = 0;                               // of r without n, with what a corner adds
  double s = 0;
  // Where the normal turns unevenly over the contact's error n: without n.
  std::optional<Eigen::Matrix3d> bare_information{};
  double bare_log_size = 0;
  double error = 0;  // standard deviation of n
};

/// A contact's residuals with their derivatives: of d (two rows) and of r.
struct HoldFit::Look : Sight {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Zero();
  Eigen::Vector3d by_place = Eigen::Vector3d::Zero();
};

/// A wheel's residuals, of closure, encoder and line of force, with their derivatives; what is not measured is 0.
struct HoldFit::PinLook {
  NearPin near;
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Zero();  // a row of each residual
  Eigen::Vector3d information = Eigen::Vector3d::Zero();
  double by_radius = 0;  // of the first by the radius, of the second by the encoder's zero
  double by_spin = 0;
  double log_size = 0;
};

struct HoldFit::RowEquations {
  Eigen::Matrix3d pose = Eigen::Matrix3d::Zero();
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  RowBlock mixed;
  UnknownsMatrix own;
  Unknowns own_slope;
  double square = 0;
  double right_square = 0;  // see HeldState, as are the next two
  double prior_square = 0;
  double strays = 0;
  double log_size = 0;
  double blur_size = 0;
};

}  // namespace rollfix::hold
