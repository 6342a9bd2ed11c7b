#pragma once

#include <optional>

#include "observation.hpp"
#include "rollfix/solve.hpp"

// Without noise: a few rows of a log are searched with, and all of them are held against what was found.
namespace rollfix {

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

}  // namespace rollfix
