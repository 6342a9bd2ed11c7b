#pragma once

#include "finger_corners.hpp"
#include "observation.hpp"
#include "rollfix/solve.hpp"

namespace rollfix {

/// What rows on corners of the fingers say.
struct CornerRowsSay {
  bool are_heeded = false;  // some places became less probable
  bool fits_badly = false;  // with every place
};

/// With noise, of an answer that was weighed without them: what rows on corners of the fingers say of each place.
/// Places that none of their turns allow become less probable, and those that are next to impossible are no longer
/// listed. Of the rows before the first one off the corners the first alone is looked at, of one
/// finger.
CornerRowsSay weigh_corner_rows(const Problem& problem, const LeadingRows& leading, const Observation& observed,
                                Answer& answer);

}  // namespace rollfix
