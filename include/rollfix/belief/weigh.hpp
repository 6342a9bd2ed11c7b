#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/belief/belief.hpp"
#include "rollfix/locate/locate.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// What the samples of a whole roll make of the places that a few readings of it allow.
struct Weighed {
  std::vector<Placement> placements;  // the most probable first
  std::vector<Mode> modes;            // of each
  std::vector<Placement> improbable;  // within the tolerance for the readings, but not for all the samples
};

/// Takes the placements of a search together with what is known of each place: a placement for each mode, which starts
/// where the posterior's density is largest. The search, with Belief::tolerance() at least, says what kind it is and
/// which exact roots it holds; its placements without a mode are improbable. `readings`: what was searched with.
Weighed weigh(const Part& part, const std::vector<Reading>& readings, const Search& found, Belief& belief);

}  // namespace rollfix
