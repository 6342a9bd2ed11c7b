#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/contact/reading.hpp"
#include "rollfix/locate/placement.hpp"
#include "rollfix/part/part.hpp"
#include "rollfix/part/reach.hpp"

namespace rollfix {

/// Why a finger can't go on.
struct Obstruction {
  double s = 0;                 // where the contact is when it can't, in [0, P)
  bool concave_corner = false;  // it would have to roll over a concave corner there; else it would ...
  Hit hit;                      // ... enter the part: the deepest that it comes to
};

/// A placement that the readings allow and the fingers do not: one of them leaves its reach, or they overlap.
struct Impossible {
  enum class Reason { reach, overlap };
  Placement placement;
  Reason reason = Reason::reach;
  std::size_t finger = 0;   // the one that leaves its reach, and ...
  Obstruction obstruction;  // ... where
  std::size_t instant = 0;  // when they overlap: 0 at the first contacts, then the readings, then the rows ...
  double depth = 0;         // ... and by how much there, length, from the placement's own start
};

/// Can a finger that first touches somewhere in `starts` roll over all of `roll` (lo <= 0 <= hi, from the first
/// contact) within its reach? Never no where it is yes: what is rounded counts as within reach.
bool can_roll(const Reach& reach, const Interval& starts, const Interval& roll);

/// Where a roll from s leaves the reach; nothing when it does not.
std::optional<Obstruction> obstruction_of(const Part& part, const Reach& reach, double s, const Interval& roll);

/// Takes the placements out of a list that no roll within reach can have: all of their extent is impossible.
/// `reach`: of each finger. `readings`: what was searched with; `more`: other instants of the same roll, of a log all
/// its rows. The contact has been everywhere in between. `length_error`: how far a length may be off, so that a finger
/// that rolled until it met something is not taken to have gone further, nor one beside a corner to have pivoted. Two
/// disks overlap where their centres are closer together than their radii (less the larger slack), a disk and a jaw
/// where the disk is beyond the jaw's line, which has no ends; looked at where both are at the same instant: at the
/// first contacts and at each of the others. Jaws are not compared with each other, nor are fingers at different
/// heights, which `may_overlap`.
std::vector<Impossible> drop_unreachable(const Part& part, const PerFinger<Reach>& reach,
                                         const std::vector<Reading>& readings, std::vector<Placement>& placements,
                                         const std::vector<Reading>& more = {}, double length_error = 0,
                                         bool may_overlap = false);

}  // namespace rollfix
