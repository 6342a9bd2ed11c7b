#pragma once

#include <cstddef>
#include <vector>

#include "cell_search.hpp"
#include "pose_fit.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// A touch's likelihood in a pose, wherever near a place its contact is: contacts are as likely on every length of the
/// boundary, so it is the integral along it, which ends and turns at corners with the boundary.
struct TiltedTouch {
  double log_likelihood = 0;
  Normals normals;  // its first two derivatives by the pose: mean and spread of what the single places say
};

TiltedTouch tilted_touch(const PoseFit& fit, const Pose& pose, std::size_t touch, const PathPlace& nearest);

/// Length of boundary that u is worth: none at a corner for a point.
inline double length_per_u(const CentrePath& path, std::size_t stretch) {
  return path.stretches()[stretch].corner ? path.radius() : 1;
}

/// The posterior at one place of the first touch: of the pose a normal distribution.
struct PosteriorNode {
  std::size_t group = 0;                                 // of the cells
  Pose pose;                                             // mean
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of x, y, heading
  double log_density = 0;                                // by the first touch's place; ...
  double log_weight = 0;                                 // ... times the length of boundary that the node stands for
  double square = 0;                                     // least sum of squares with that place, and ...
  Pose best;                                             // ... the pose that has it
};

/// Groups of cells, and the nodes on them, that are one mode: between modes the density falls far below both.
struct PoseMode {
  std::vector<std::size_t> groups;
  std::vector<std::size_t> nodes;  // never empty
  double probability = 0;
};

/// The posterior over cells.
struct Posterior {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  std::vector<PosteriorNode> nodes;
  /// Of a group from which least squares lead to a pose in another one: that one. The group goes with it if it has no
  /// pose of its own. kNone of all others.
  std::vector<std::size_t> owner;
  /// Components whose best pose fits so much worse than that of another that they were not looked at.
  std::size_t hopeless = 0;
  /// There were more places to look at than asked for: it ends before them.
  bool is_too_long = false;
};

/// p(pose, place of the first touch), with all other places summed over: a grid over the places of the first touch, and
/// the normal distribution of the pose about the best one in each (Laplace's method). See docs/touch.md.
/// `most_places`: of the first touch, each with its groups.
Posterior posterior_of(PoseFit& fit, const CellSets& sets, std::size_t first_touch, std::size_t most_places);

/// The modes, the most probable first.
std::vector<PoseMode> modes_of(const CellSets& sets, const Posterior& posterior);

/// The same where each group of nodes is a mode, without cells.
std::vector<PoseMode> modes_of(const std::vector<PosteriorNode>& nodes);

/// The middle interval that holds this share of a mixture's weight.
Interval middle_share(const std::vector<MixtureTerm>& terms, double share);

/// Squares that exceed the least known by more are worth exp(-25) of it: what has them is not looked at closely.
inline constexpr double kHopeless = 50;

/// Of each group of cells whether its component fits so badly, next to the best, that it has no probability to speak
/// of. Each is started from in its middle, and those that seem to from more and more cells.
std::vector<bool> hopeless_groups(PoseFit& fit, const CellSets& sets, std::size_t first_touch);

}  // namespace rollfix::touch
