#pragma once

#include <optional>

#include "rollfix/contact/pose.hpp"
#include "rollfix/json_output.hpp"

namespace rollfix::app {

/// A placement's `pose`: [[x, y, heading], ...], one per row; null where the log does not tell.
Json pose_json(const std::optional<Poses>& poses);

/// A placement's `pose_residual`: the largest of the rows', as {"length": L, "turn": radians}; null likewise.
Json pose_residual_json(const std::optional<Poses>& poses);

}  // namespace rollfix::app
