#pragma once

#include <vector>

#include "held_question.hpp"
#include "hold_fit.hpp"
#include "hold_modes.hpp"

namespace rollfix::hold {

/// A set of first contacts, with some in it that fit.
struct WitnessedSet {
  HeldSet set;
  HeldState state;
};

/// Sets in which something fits, and boxes of which that is not known.
struct Witnessed {
  std::vector<WitnessedSet> sets;
  std::vector<Box> undecided;
};

/// Without noise: in every set first contacts that fit at all instants that are searched with; sets without are cut
/// smaller, until they are gone or told. `fit`: of those instants.
Witnessed witnessed(HeldQuestion& question, HoldFit& fit, Boxes boxes);

}  // namespace rollfix::hold
