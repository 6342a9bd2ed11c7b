#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/solve.hpp"
#include "steps.hpp"

namespace rollfix::answer {

// Without noise: a few rows of a log are searched with, and all of them are held against what was found.

/// How far the true place may be from the listed one, arc length. 0 of a continuum and of a corner: the listed place of
/// a continuum stands for others, and a corner is exact.
double width_of(const Placement& placement);

/// Rows that are off the place which stands for a continuum, the worst first: the search is to be asked about them as
/// well. None where all rows fit those places.
std::vector<std::size_t> rows_to_ask(const Problem& problem, const Observation& observed, const Answer& answer);

/// What all rows of a log say of the placements.
struct RowsChecked {
  std::vector<Placement> placements;   // those that the rows, or the contacts in the world, contradict are last
  bool fits_badly = false;             // with every place
  std::vector<Diagnosis> diagnoses{};  // why, where that was asked
};
/// REQUIRES a log, and poses where it has them.
RowsChecked check_rows(const Problem& problem, const Observation& observed, bool explains, const Answer& answer);

}  // namespace rollfix::answer
