#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/solve.hpp"
#include "steps.hpp"

namespace rollfix::answer {

// Without noise: a few rows of a log are searched with, and all of them are held against what was found.

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

// What fingers can't do.

/// Takes the placements out of the answer that the fingers can't reach, or in which two would be in one another: where
/// they can be is known if all of them are disks or jaws; two of any shape are followed along their log, from wherever
/// in its extent a placement starts. With an outline that takes u: of readings nothing goes.
void drop_impossible(const Problem& problem, const Observation& observed, Answer& answer);

}  // namespace rollfix::answer
