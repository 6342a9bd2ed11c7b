#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "hold_fit.hpp"
#include "rollfix/part.hpp"

namespace rollfix::hold {

/// The boundary at a place that is known to some length only: a corner nearby is blurred by it.
struct BlurredPlace {
  double side = 0;          // Theta at the place itself, radians: how the point goes
  double angle = 0;         // mean of Theta, radians
  double bend = 0;          // its derivative by s, corners included
  double curvature = 0;     // without corners
  double variance = 0;      // of Theta, by corners
  double pivoting = 0;      // how probable it is that the finger pivots at a corner there, times how far the ...
                            // ... finger's own tangent is then off the side's: of a square, per coordinate
  bool has_corner = false;  // near enough to be seen
  double half_turn = 0;     // without blur: Theta is within this of `angle`
};

/// p(s); beyond an open boundary's end its tangent continues it, so that a fit that has left it can return.
Vec2 point_about(const Part& part, double s);

/// Theta on average over a normal distribution about s. `pivot`: the length that a radian of pivoting counts as, of a
/// disk its radius: its centre goes as far about a corner.
BlurredPlace blurred(const Part& part, double s, double sd, double pivot);

/// Theta at s + m less Theta at s; beyond an open boundary's end it stays.
double turn_from(const Part& part, double s, double m);
double curvature_at(const Part& part, double s);

/// Theta's range within `reach` of s: for measurements that are exact but for their digits.
BlurredPlace ranged(const Part& part, double s, double reach);

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
  double s = 0;                                           // the contact's place, z + L / (1 + e)
  // Where the normal turns unevenly over the contact's error n: without n.
  std::optional<Eigen::Matrix3d> bare_information{};
  double bare_log_size = 0;
  double error = 0;  // standard deviation of n
};

/// A contact's residuals with their derivatives: of d (two rows) and of r.
struct HoldFit::Look : Sight {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Zero();   // a row of each residual; columns A.x, A.y, phi
  Eigen::Vector3d by_place = Eigen::Vector3d::Zero();  // by s
};

/// A wheel's residuals, of closure, encoder and line of force, with their derivatives; what is not measured is 0.
struct HoldFit::PinLook {
  NearPin near;  // where the wheel touches
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Zero();      // a row of each residual
  Eigen::Vector3d information = Eigen::Vector3d::Zero();  // 1 / variance of each
  double by_radius = 0;  // of the first by the radius, of the second by the encoder's zero
  double by_spin = 0;
  double log_size = 0;
};

/// The normal equations of one row, and what it adds to chi-square and to the density.
struct HoldFit::RowEquations {
  Eigen::Matrix3d pose = Eigen::Matrix3d::Zero();   // P = sum of A^T C^-1 A, by x, y of A and the heading
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();  // minus half the gradient of the square by the pose
  RowBlock mixed;                                   // B; this and the next two only if asked for
  UnknownsMatrix own;                               // M
  Unknowns own_slope;                               // minus half the gradient by the unknowns
  double square = 0;                                // of all residuals, with priors of the first row
  double right_square = 0;                          // see HeldState, as are the next two
  double prior_square = 0;
  double strays = 0;
  double log_size = 0;   // sum of log det C over the measurements
  double blur_size = 0;  // of it what corners add
};

}  // namespace rollfix::hold
