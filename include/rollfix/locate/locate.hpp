#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/contact/reading.hpp"
#include "rollfix/locate/placement.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// The least tolerance that is used, radians: |f| at a root, up to four tangents each with its rounding. Below it,
/// whether a root of one reading fits another would be decided by rounding.
inline constexpr double kLeastTolerance = 4e-12;

struct LocateOptions {
  double tolerance = 1e-9;       // radians: how far |f_k| may be from 0; at least kLeastTolerance is used
  std::size_t budget = 1000000;  // intervals (of two fingers boxes) to look at, beyond the part's own, before giving up
  // Of two fingers, the facing equation: Theta(s0) - Theta(t0) = facing mod 2 pi, facing = (u + psi)_a - (u + psi)_b.
  std::optional<double> facing{};
};

/// Every place on the part where a roll can have started, given one reading or several of the same roll, all measured
/// from the same first contacts. One finger on a part at rest: eqs. (4) and (5), by branch and prune on spirals. Two on
/// a part that is free to move: eqs. (8) and (9), by branch and prune on pairs of spirals; two readings are the least
/// without the facing equation, one with it. See docs/search.md.
/// Throws InputError: too few readings, readings of one finger and of two, a number that is not finite, a roll longer
/// than an open curve or than a million laps of a closed one, a facing of one finger or beyond 1e6 rad.
Search locate(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options = {});
Search locate(const Part& part, const Reading& reading, const LocateOptions& options = {});

}  // namespace rollfix
