#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/solve.hpp"

namespace rollfix {

/// What the fingers felt, as readings in the direction in which the part is stored.
struct Observation {
  std::vector<Reading> readings;                            // to search with
  std::vector<double> times;                                // of a log with times: of each, seconds
  std::vector<Reading> rolls;                               // of a log: all its rows
  std::vector<double> pose_time;                            // of a log with times: of all its rows, seconds
  std::optional<PerFinger<std::vector<Contact>>> contacts;  // of a log of u and psi: each row's, unwrapped
  std::optional<double> facing;  // of two fingers at the first contacts; not more rounded than a turn
  std::vector<Rounding> roundings;
  std::vector<bool> on_corners;   // of a log of fingers with corners: the rows in which one is on a corner of its own
  bool lengths_reversed = false;  // a log's lengths were along a clockwise outline

  /// How far the digits that were written can have moved any of the lengths.
  double length_error() const;
};

/// All that was felt: a log's rows, or the readings.
inline const std::vector<Reading>& rows_felt(const Problem& problem, const Observation& observed) {
  return problem.measured.is_log() ? observed.rolls : observed.readings;
}

/// Throws InputError: facing, instants and logs that don't go together, and what `readings` of a log throws.
Observation observe(const Problem& problem);

/// What the digits, the noise or the user make of the search's tolerance.
Tolerance tolerance_from_digits(const Part& part, const std::vector<Rounding>& roundings,
                                const std::vector<Reading>& readings);
Tolerance tolerance_from_noise(double value);
/// Throws InputError: below 0.
Tolerance tolerance_given(double value);

/// Lengths that their digits can't tell from a way between two corners, or from staying on one, made that way. A
/// contact on a corner pivots, and where a length is rounded it would leave the corner. `within`: how far digits can
/// have moved a length.
void put_on_corners(const Part& part, double within, std::vector<Reading>& readings);

}  // namespace rollfix
