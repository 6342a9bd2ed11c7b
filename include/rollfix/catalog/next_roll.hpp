#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/belief/advise.hpp"
#include "rollfix/catalog/identify.hpp"

namespace rollfix {

/// Which roll tells apart the parts, and the places on them, that remain.
struct NextRollOfParts {
  struct Place {
    std::size_t part = 0;   // its place in Identified::parts
    Contender contender;    // `probability`: of this part and this place; `label`: of all parts' places its own
    double turn_ahead = 0;  // along the advised roll if this is the place, radians; 0: none is advised
  };
  std::vector<Place> places;
  std::optional<Advice> advice{};  // none where there is nothing to tell apart
  std::string why{};               // where there is none, or no roll helps: why, in words; else empty

  bool helps() const { return advice && advice->helps; }
};

/// As next_roll(const Answer&) does of one part's places, of all parts that were found. Without noise all places of all
/// parts are as probable. Throws InputError: rolls that may have gone either way, and as `advise` does.
NextRollOfParts next_roll(const Identified& found, const std::optional<Interval>& travel = {});

}  // namespace rollfix
