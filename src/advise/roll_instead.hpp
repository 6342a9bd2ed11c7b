#pragma once

#include <optional>
#include <vector>

#include "rollfix/advise.hpp"
#include "touch/likely_poses.hpp"
#include "touch/nearest.hpp"

namespace rollfix::touch {

/// The roll from the last touch that tells most of these poses apart, by how much the tangent turns along it. None: the
/// finger is a point, no angle is measured, or no roll gains anything.
std::optional<RollGain> roll_instead(const TouchAnswer& answer, const std::vector<LikelyPose>& poses,
                                     PartDistance& part);

}  // namespace rollfix::touch
