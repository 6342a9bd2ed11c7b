#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/outline/curve.hpp"
#include "rollfix/part/part.hpp"
#include "rollfix/per_finger.hpp"

namespace rollfix {

/// The part's poses at some rows of a log, and how badly what was felt there fits the part's shape: without noise the
/// residuals vanish for the true first contacts, and hardly ever for others. One entry per row.
struct Poses {
  std::vector<Pose> pose;             // headings are unwrapped; the one at the first contact is in (-pi, pi]
  std::vector<double> residual;       // length: how far the contacts in the world are from where the part has them
  std::vector<double> turn_residual;  // radians: how far the headings are apart that the contacts' normals ask for
};

/// The part's poses when the first contacts are at `start`, in the direction in which the part is stored.
///  * Under one finger the part is at rest, and each pose is what that row says alone; `residual` compares its chord
///  from
///    the first contact with the part's, `turn_residual` its heading with the first.
///  * Under two it is free to move, and the poses are means of what both say. `residual` compares the vector from
///  contact
///    a to contact b with the part's, which is also how far apart the fingers would have the part; `turn_residual` is
///    the facing equation's.
/// Nothing where the log does not have each finger's orientation and its centre x, y, or no finger is known. `noise`:
/// by which a contact may be on a corner of its finger, where the heading is between bounds.
std::optional<Poses> poses(const Part& part, const std::vector<Finger>& fingers, const Log& log,
                           const PerFinger<double>& start, const std::vector<std::size_t>& rows,
                           const Noise& noise = {});

}  // namespace rollfix
