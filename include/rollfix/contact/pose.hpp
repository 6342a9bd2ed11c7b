#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/contact/pair_log.hpp"
#include "rollfix/outline/curve.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// The part's poses at some rows of a log, and how badly what was felt there fits the part's shape: without noise the
/// residuals vanish for the true first contacts, and hardly ever for others. One entry per row.
struct Poses {
  std::vector<Pose> pose;             // headings are unwrapped; the one at the first contact is in (-pi, pi]
  std::vector<double> residual;       // length: how far the contacts in the world are from where the part has them
  std::vector<double> turn_residual;  // radians: how far the headings are apart that the contacts' normals ask for
};

/// The poses of a part at rest on which a finger rolls, when its first contact is at s. Each is what that row says
/// alone; `residual` compares its chord from the first contact with the part's, `turn_residual` its heading with the
/// first. Nothing where the log does not have the finger's orientation and its centre x, y.
std::optional<Poses> poses(const Part& part, const Finger& finger, const Log& log, double s,
                           const std::vector<std::size_t>& rows);

/// The poses of a part that is free to move, when the first contacts are at s and t: means of what both fingers say.
/// `residual` compares the vector from contact a to contact b with the part's, which is also how far apart the fingers
/// would have the part; `turn_residual` is the facing equation's. Nothing where a log does not have the orientation
/// and the centre.
std::optional<Poses> poses(const Part& part, const FingerPair& fingers, const PairLog& log,
                           const std::array<double, 2>& start, const std::vector<std::size_t>& rows);

}  // namespace rollfix
