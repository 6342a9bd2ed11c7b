#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "observation.hpp"

// With noise: what all rows of a log, or the readings where there is no log, make of the placements.
namespace rollfix {

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

}  // namespace rollfix
