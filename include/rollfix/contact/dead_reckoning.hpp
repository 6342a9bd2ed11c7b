#pragma once

#include <optional>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/log.hpp"

namespace rollfix {

/// Where a row of a roll is when all before it are added up.
struct ReckonedRow {
  double s = 0;      // length travelled since the row that comes first along the outline
  double angle = 0;  // direction of the tangent, radians, unwrapped
  Vec2 point = Vec2::Zero();
};

/// One finger's rows by growing length, as `teach` takes them: from row to row along an arc of a circle, nothing closed
/// and nothing averaged. In the world's frame as far as the log has psi, x and y, else from (0, 0) along x.
/// Throws InputError: two fingers, u and psi without a disk.
std::vector<ReckonedRow> dead_reckoned(const Log& log, const std::optional<Finger>& finger);

}  // namespace rollfix
