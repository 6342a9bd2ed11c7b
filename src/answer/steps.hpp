#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/log.hpp"
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

/// A column of a finger's rows.
using RowColumn = std::vector<double> FingerRows::*;
/// Columns that were read in another unit, or with the other sign.
void multiply(FingerRows& rows, const std::vector<RowColumn>& columns, double factor);
/// With the roundings of both.
void swap_u_and_psi(FingerRows& rows);
/// Between the least and the largest number of a column; 0 without rows.
double range_of(const std::vector<double>& values);

/// A mode that was found from the row that lies `way` behind the first contacts, led back to these.
void to_first_contacts(const Reading& way, const Part& part, const Noise& noise, Mode& mode);
/// Likewise where the last contacts lie `further` behind those of the last row that was weighed.
void to_last_contacts(const Reading& further, const Part& part, const Noise& noise, Mode& mode);

}  // namespace rollfix

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

/// How the log's columns are to be read where that is the mistake: those that change, and those that are not found by
/// their own names. None where no column changes, or no header is known.
std::vector<ColumnSource> columns_without(Cause cause, const Log& log);

/// Whether it was said of a finger's column, "u", "psi", "turn" or "dturn", that it is in degrees.
bool says_degrees(const std::vector<FingerRows>& fingers, std::string_view column);

/// A mistake in how the columns of a log are read: a unit, a sign, a name.
struct ColumnMistake {
  Cause cause;
  std::function<void(FingerRows&)> mend;
  double log_stretch = 0;  // by how much the numbers of a row grow, and their density with them: the logarithm of it
  double left_of_roll = std::numeric_limits<double>::infinity();  // where it makes the roll shorter: how far the
                                                                  // columns still go, radians
};

/// The mistakes that are possible in these measurements.
std::vector<ColumnMistake> column_mistakes(const Measurement& measured);

/// The problem as it is without that mistake.
Problem without(const ColumnMistake& mistake, const Problem& problem);

// Rows that trials are compared by, before all are looked at.
inline constexpr std::size_t kRowsToCompare = 48;

/// The fingers whose lengths are scaled: all, or one of two.
using Whose = std::optional<std::size_t>;

/// How many times as long as they were measured the rows say that lengths are.
struct SettledScale {
  double scale = 1;
  double sd = 0;
  Belief belief;  // with it
};

/// By which factor lengths may be off, as by a wrong radius or another unit, of any size.
class LengthScales {
 public:
  /// Both have to outlive it.
  LengthScales(const Problem& problem, const Observation& observed) : problem_(problem), observed_(observed) {}

  /// Where a few rows fit best, the best first.
  std::vector<double> worth_a_look(const Whose& whose) const;

  /// From such a scale on by all rows; none: they ask for any scale, or can't be had with this one.
  std::optional<SettledScale> settled(const Whose& whose, double scale) const;

 private:
  std::vector<double> all(const Whose& whose) const;
  bool may_be_of_two(double scale) const;
  /// Does a row say anything of the normal with such fingers?
  bool tells_normals(const Whose& whose, double scale) const;
  bool may_be(double scale) const;
  std::optional<Belief> belief_with(const Whose& whose, double scale, std::size_t rows) const;

  const Problem& problem_;
  const Observation& observed_;
  mutable double turn_beyond_ = -1;  // what a turn may be off for its length, radians; below 0: not known yet
};

/// What may be wrong where the rows fit badly: the usual mistakes are tried, each estimated by the rows. Those with
/// which the rows fit, else those with which they fit far better, the likeliest first; Cause::part alone where nothing
/// does. Nothing where they fit.
std::vector<Diagnosis> diagnose(const Problem& problem, const Observation& observed, Belief& belief);

/// Both answers to one roll as one: every placement says which way round it is an answer. With noise each way is
/// weighed by its evidence, both being as likely beforehand.
Answer either_of(Answer counter_clockwise, Answer clockwise);
/// The one answer there is, where the rows can't have gone the other way at all, and why they can't.
Answer only_way(Answer answer, const std::string& why_not_the_other);

/// Takes the placements out of the answer that the fingers can't reach, or in which two would be in one another: where
/// they can be is known if all of them are disks or jaws; two of any shape are followed along their log, from wherever
/// in its extent a placement starts. With an outline that takes u: of readings nothing goes.
void drop_impossible(const Problem& problem, const Observation& observed, Answer& answer);

// Logs of fingers with corners: on them a row's u does not tell how the finger's normal is turned, off them it does,
// whatever lay between.

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
