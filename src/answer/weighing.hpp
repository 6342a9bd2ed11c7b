#pragma once

#include <vector>

#include "rollfix/solve.hpp"
#include "steps.hpp"

namespace rollfix::answer {

// With noise: what all rows of a log, or the readings where there is no log, make of the placements.

/// What the belief says now: its modes, whose probabilities, sums over many cells, are not carried beyond 1 by
/// rounding.
std::vector<Mode> modes_of(Belief& belief);

/// What all rows together say.
struct RowsWeighed {
  std::vector<Placement> placements;  // what nothing explains is not among them
  Weighing weighing;
  Status status = Status::complete;
  std::vector<Diagnosis> diagnoses{};
  bool centres_contradict = false;  // the belief does not know that the rows fit badly, but the fingers' centres say so
};
/// What the samples leave in place of what the search found. Unless it `explains`, nothing is said of what may be
/// wrong.
RowsWeighed weigh(const Problem& problem, const Observation& observed, bool explains, const Answer& searched,
                  Belief& belief);

/// The verdict, and how probable places are: after the fingers dropped some, or rows on their corners did, as if there
/// were no more than the others; in doubt where something else explains the rows as well. `fits_badly`: what was found
/// of the rows besides.
void conclude(Belief& belief, Answer& answer, bool is_reweighed, bool fits_badly);

}  // namespace rollfix::answer
