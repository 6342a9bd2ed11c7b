#pragma once

#include <vector>

#include "fingers_apart.hpp"
#include "held_question.hpp"
#include "hold_fit.hpp"
#include "hold_modes.hpp"

namespace rollfix::hold {

/// A set of first contacts, with some in it that fit.
struct WitnessedSet {
  HeldSet set;
  HeldState state;
  bool overlaps = false;  // all that fits in it has fingers in each other
};

/// Sets in which something fits, and boxes of which that is not known.
struct Witnessed {
  std::vector<WitnessedSet> sets;
  std::vector<Box> doubtful;   // as small as they get, with nothing found in them that fits
  std::vector<Box> undecided;  // where the budget ran out
};

/// Without noise: in every set first contacts that fit at all instants that are searched with; sets without are cut
/// smaller, until they are gone or told. `fit`: of those instants. `apart`: null where fingers may be in each other.
Witnessed witnessed(HeldQuestion& question, HoldFit& fit, Boxes boxes, const FingersApart* apart = nullptr);

}  // namespace rollfix::hold
