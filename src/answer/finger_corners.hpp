#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/solve.hpp"
#include "steps.hpp"

// Logs of fingers with corners: on them a row's u does not tell how the finger's normal is turned, off them it does,
// whatever lay between.
namespace rollfix::answer {

/// The rows at the beginning of a log in which a finger is on a corner of its own: all others are measured from the
/// first row behind them.
struct LeadingRows {
  std::size_t count = 0;
  Reading way;                    // from the first contacts to that row
  std::vector<Reading> readings;  // of one finger: from that row back to the first contact; theta has a pivot
};

/// None where the first contacts are off all corners. Throws InputError: no row is off them and there is noise or are
/// two fingers, or an instant that is asked for lies among these rows.
std::optional<LeadingRows> leading_rows(const Problem& problem);

/// The same roll from that row on.
Problem without(const LeadingRows& leading, const Problem& problem);

/// Of its answer: places are again those of the first contacts. With noise they know the way there as well as two rows
/// do.
void to_first_contacts(const LeadingRows& leading, const Problem& problem, Answer& answer);

/// The rows to search with: those that are asked for; else the last, and before it, if that is on a corner, the last
/// one that is not. Of two fingers the middle one and the last, each the nearest before it that is off corners.
std::vector<std::size_t> rows_to_search(const Problem& problem, const std::vector<bool>& on_corners);

/// With noise rows on corners at the end of the log were not weighed: the last contacts are that much further on.
void to_last_contacts(const Observation& observed, const Noise& noise, Answer& answer);

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

}  // namespace rollfix::answer
