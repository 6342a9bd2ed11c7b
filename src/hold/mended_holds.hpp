#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/hold.hpp"

// Logs as they would be without a mistake.
namespace rollfix::hold {

/// These rows of a log of one finger, in order.
Log with_rows(const Log& log, const std::vector<std::size_t>& rows);

/// Leaves rows out of all logs in which a finger jumps farther than is physical, and comes back. Which they were, as in
/// "b.csv, line 17". `logs`: aligned.
std::vector<std::string> leave_out_jumps(const HoldProblem& problem, std::vector<Log>& logs);

/// A mistake in how columns are read, in all logs or in one: what it is, and the problem without it.
struct Mended {
  HoldDiagnosis what;
  HoldProblem problem;
  double log_stretch = 0;  // logarithm of what the density of all measurements grows by with their numbers
};

/// Angles that count the other way or are in degrees, u and psi exchanged.
std::vector<Mended> without_slips_of_the_pen(const HoldProblem& problem);
/// x and y exchanged.
std::vector<Mended> without_exchanged_axes(const HoldProblem& problem);
/// x and y in another unit.
std::vector<Mended> without_units(const HoldProblem& problem);
/// Fingers in another order.
std::vector<Mended> without_swaps(const HoldProblem& problem);

/// Lengths so many times as long, of all disks or of one: their radii; or the radius of a wheel. Nothing: there are
/// none.
std::optional<HoldProblem> with_lengths(const HoldProblem& problem, std::optional<std::size_t> whose, double scale);

/// Row k + `rows` of one log with row k of the others.
HoldProblem shifted(const HoldProblem& problem, std::size_t log, int rows);

/// All measurements noisier.
HoldProblem noisier(const HoldProblem& problem, double times);

/// Some rows of all logs, spread evenly, and angles unwrapped by all of them.
HoldProblem thinned(const HoldProblem& problem, std::size_t rows);

}  // namespace rollfix::hold
