#pragma once

#include <optional>
#include <vector>

#include "pose_sets.hpp"
#include "posterior.hpp"

namespace rollfix::touch {

/// Whether what is known of the pose beforehand says where the part is.
bool knows_place(const TouchProblem& problem);

/// The posterior by one touch that has a place, or by several at one place without normals, and by what is known
/// beforehand: the nodes of a group hang together. REQUIRES that it knows the place.
std::vector<PosteriorNode> nodes_by_prior(const Asked& asked);

/// The posterior as a list of poses.
struct WeighedPoses {
  std::vector<TouchPose> poses;        // the most probable first
  std::optional<TouchFit> fit;         // of the one that fits best
  std::size_t improbable = 0;          // sets that are not listed, ...
  double rest = 0;                     // ... and their probability
  std::optional<double> log_evidence;  // but for what rolls say of themselves, and contacts' own places
  bool is_too_long = false;            // so many places that they were not weighed
};

// Sets of poses that are less probable are counted, not listed.
inline constexpr double kLeastProbability = 1e-4;

/// The most probable first; those that are as probable, as of a symmetric part, by their headings.
void put_in_order(std::vector<TouchPose>& poses);

/// The boundary's length as far as the finger gets to it, of a corner that of the finger's arc around it.
double length_in_reach(const CentrePath& path);

/// With noise: what is less probable than a bound is not looked at, and modes that end in one pose are one.
WeighedPoses weighed_poses(const Asked& asked, const CellSets& sets, std::size_t budget);

/// By one touch and what is known of the pose beforehand.
WeighedPoses weighed_by_prior(const Asked& asked);

}  // namespace rollfix::touch
