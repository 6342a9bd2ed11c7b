#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "observation.hpp"
#include "rollfix/solve.hpp"

namespace rollfix {

// Without noise: a few rows of a log are searched with, and all of them are held against what was found.

/// The noise that a log's rows seem to have, as they jitter beside a smooth course: none where they don't, or where
/// there are too few to tell.
std::optional<Noise> noise_that_shows(const Log& log, const std::vector<Finger>& fingers);

/// How far the fingers' centres in the world, as a log has them, jitter beside a smooth course: the largest standard
/// deviation of a coordinate; 0 where they don't, or where there are too few rows to tell.
double jitter_of_centres(const Log& log);

/// Half a unit of the last decimal that any of the numbers shows; 0: they show more than can be told.
double rounding_of_column(const std::vector<double>& values);

/// Of two fingers' log, a row that is off the place which stands for a continuum of pairs: the search is to be asked
/// about it as well. Nothing where all rows fit those places.
std::optional<std::size_t> row_to_ask(const Problem& problem, const Observation& observed, const Answer& answer);

/// Marks placements that other rows of the log contradict, or the contacts in the world, and puts them last. Where none
/// is left the rows fit badly, which is false, and why, if it `explains`. REQUIRES a log, and poses where it has them.
bool check_rows(const Problem& problem, const Observation& observed, bool explains, Answer& answer);

// With noise: what all rows of a log, or the readings where there is no log, make of the placements.

/// What the problem's log tells of itself; of readings: lengths and turns.
LogKind kind_of(const Problem& problem);
/// The curvature of finger 0 or 1 where it touches in a row; 0 where the finger is not known.
double finger_curvature(const Problem& problem, std::size_t which, std::size_t row);

/// "heading" or "pose": what was said of how the part lies.
const char* name_of(const PosePrior& pose);

/// Throws InputError: what is weighed against noise, where there is none.
void require_noise(const Problem& problem);

/// What a problem is tried with that it does not say.
struct Supposed {
  double scale_sd = 0;                                         // see BeliefOptions
  std::size_t rows = std::numeric_limits<std::size_t>::max();  // no more than about so many are looked at
  bool glance = false;                                         // see BeliefOptions
  std::optional<std::size_t> nodes{};                          // likewise
  bool by_rows = false;                                        // likewise
  std::vector<Interval> within{};                              // likewise
  std::optional<std::size_t> scale_of{};                       // likewise
};
/// Nothing without noise.
std::optional<Belief> believe(const Problem& problem, const Observation& observed, const Supposed& supposed = {});

/// What the belief says now: its modes, whose probabilities, sums over many cells, are not carried beyond 1 by
/// rounding.
std::vector<Mode> modes_of(Belief& belief);

/// Puts what the samples leave in place of what the search found. What nothing explains is not listed. Unless it
/// `explains`, nothing is said of what may be wrong. True: the belief does not know that the rows fit badly, but the
/// fingers' centres say so.
bool weigh(const Problem& problem, const Observation& observed, bool explains, Belief& belief, Answer& answer);

/// The verdict, and how probable places are: after the fingers dropped some, or rows on their corners did, as if there
/// were no more than the others; in doubt where something else explains the rows as well. `fits_badly`: what was found
/// of the rows besides.
void conclude(Belief& belief, Answer& answer, bool is_reweighed = false, bool fits_badly = false);

/// Takes the placements out of a list in which two fingers of any shape are in one another in some row of their log,
/// from wherever in its extent they started. With an outline it takes u: of readings nothing goes. `length_error`: how
/// far a length, or a contact on a finger, may be off.
std::vector<Impossible> drop_overlapping(const Problem& problem, const Observation& observed, double length_error,
                                         std::vector<Placement>& placements);

}  // namespace rollfix
