#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/solve.hpp"

// The steps of `solve` that other rooms take as well; what is the room's alone is of the namespace `answer`.
namespace rollfix {

/// How a problem is looked at: lengths count counter-clockwise along the outline as it was drawn, or clockwise; the
/// part is as it was drawn, or a mirror shows what lies face down. In a mirror (L, theta) and (u, psi) become
/// (-L, -theta) and (-u, pi - psi), of a jaw (-u, -psi), a centre (x, y) becomes (-x, y). So every place that is found
/// is one of the outline as it is stored. A finger with an outline is its own mirror's image there.
struct View {
  bool mirrored = false;
  bool clockwise = false;

  bool is_as_given() const { return !mirrored && !clockwise; }
  /// The problem as it is seen so, which does not ask for that any more; what u and psi say is counter-clockwise either
  /// way.
  Problem of(const Problem& problem) const;
  /// The answer to that, as the world has it: readings, sensitivities and facing with their own signs, and poses of a
  /// part face down: turn its mirror image (-x, y) by the heading, then move it to x and y.
  void undo(const Problem& problem, Answer& answer) const;
};
/// One, or both ways round where lengths may count either way. Throws InputError: a log of u and psi says itself which
/// way round it went.
std::vector<View> views_of(const Problem& problem);

/// What the fingers measured, as readings in the direction in which the part is stored.
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

/// All measurements: a log's rows, or the readings.
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

/// Throws InputError: what is weighed against noise, where there is none.
void require_noise(const Problem& problem);

/// What the problem's log tells of itself; of readings: lengths and turns.
LogKind kind_of(const Problem& problem);
/// The curvature of finger 0 or 1 where it touches in a row; 0 where the finger is not known.
double finger_curvature(const Problem& problem, std::size_t which, std::size_t row);

/// How far a row may be off: variances of each length, of the larger one of two, and of the turn.
struct RowErrors {
  double length = 0;    // all of it
  double shared = 0;    // of the turn: what every row has from the first contact
  double own = 0;       // what this row has on its own
  double gathered = 0;  // what came together on the way
};
/// Of every row of a roll, on a part of this perimeter.
std::vector<RowErrors> errors_of(const Problem& problem, const Noise& noise, const std::vector<Reading>& rows,
                                 double perimeter);

/// "heading" or "pose": what was said of how the part lies.
const char* name_of(const PosePrior& pose);

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

/// A mode that was found from the row that lies `way` behind the first contacts, led back to these.
void to_first_contacts(const Reading& way, const Part& part, const Noise& noise, Mode& mode);
/// Likewise where the last contacts lie `further` behind those of the last row that was weighed.
void to_last_contacts(const Reading& further, const Part& part, const Noise& noise, Mode& mode);

}  // namespace rollfix
