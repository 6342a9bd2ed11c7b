#pragma once

#include <vector>

#include "rollfix/part.hpp"
#include "weights.hpp"

namespace rollfix {

// Outlines that are the same are so to this share of the perimeter.
inline constexpr double kSameScale = 1e-9;

/// Whether two parts are the same outline as far as a roll can tell, seen from one of the places on each on.
bool are_congruent(const Part& one, const std::vector<double>& from, const Part& other,
                   const std::vector<double>& other_from, const Likeness& likeness);

}  // namespace rollfix
