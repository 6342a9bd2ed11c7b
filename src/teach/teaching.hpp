#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "outline/spline.hpp"
#include "outline/turn.hpp"
#include "rollfix/log.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/teach.hpp"

namespace rollfix::teaching {

/// Rows of a roll between two corners (or ends): the tangent's angle by arc length.
struct TurningRun {
  double lo = 0;  // arc lengths of the corners or ends, in the log's unit
  double hi = 0;
  std::vector<double> s;      // rising, within [lo, hi]
  std::vector<double> angle;  // Theta of each row, radians, unwrapped
  double lo_between = 0;      // the corner at lo lies between two rows so far apart; 0: rows pivot there
  // Of noisy rows, where several passes of a roll lie over one another:
  std::vector<int> pass{};     // which pass each row is of, from 0
  std::vector<double> ramp{};  // how much of the drift of a lap it has: 0 at the roll's start, 1 a lap later
};

/// A roll cut at its corners. Each run ends where the next begins.
struct TurningRuns {
  std::vector<TurningRun> runs;
  bool starts_at_corner = false;  // the roll starts while the finger pivots
  bool ends_at_corner = false;    // the same of its end

  double length() const { return runs.back().hi - runs.front().lo; }
};

/// What tells a corner from a bend.
struct PivotLimits {
  double length = 0;        // rows closer together than this are at one place; ...
  double turn = 0;          // ... where they turn by this, radians, that is a corner
  double corner_angle = 0;  // radians: a turn of this size between neighbouring rows is a corner
};

/// Cuts readings, in the direction of growing length, at the corners. Rows at one place are averaged, or, where they
/// turn, are a corner. Throws InputError when a length falls by more than the limit.
TurningRuns turning_runs(const std::vector<Reading>& readings, const PivotLimits& limits);

/// The part of it up to a length.
TurningRuns cut_at(const TurningRuns& runs, double length);

/// Theta(s) between two corners as a cubic between each two nodes, from its values and slopes there.
struct TurningNodes {
  std::vector<double> s;      // of the nodes, rising
  std::vector<double> angle;  // Theta there, radians
  std::vector<double> slope;  // its derivative, the curvature

  /// The cubic after node k, by arc length from there.
  TurningSpan::Cubic cubic(std::size_t k) const;
  /// The one at this place; beyond the ends the first or the last.
  std::size_t cubic_at(double place) const;
  /// Theta, radians, and its slope; beyond the ends the outer cubics go on.
  double at(double place) const;
  double slope_at(double place) const;

  /// A node behind the last one; the vector holds Theta and its slope.
  void add(double place, const Vec2& value_and_slope);
};

/// Theta over a whole roll, run by run, each starting where the one before ends.
using TurningCourse = std::vector<TurningNodes>;

/// The curve that turns like this.
struct TurningPath {
  std::vector<TurningSpan> spans;
  std::vector<double> s;    // where each span starts
  std::vector<Vec2> point;  // there, and at the end

  /// Arc length at the path's end.
  double end() const { return s.back() + spans.back().domain().hi; }
  /// From the path's end to its start, in the log's unit; 0 where it is closed.
  Vec2 gap() const { return point.front() - point.back(); }
  /// The diagonal of the box around the spans' ends.
  double size() const;
};

/// The path of this course from a point on, without any closing.
TurningPath path_of(const TurningCourse& course, const Vec2& start);

/// A node at this place as well; the cubics stay what they are.
void split_at(TurningNodes& nodes, double place);

/// What closed a course.
struct Closure {
  bool closed = false;    // the gap is below rounding
  double correction = 0;  // no change of Theta is larger, radians
};

/// Changes Theta by as little as possible in the mean square so that the path ends where it starts: by
/// a sin Theta + b cos Theta, which are the gap's derivatives by Theta. Newton's method on a and b.
Closure close_gap(TurningCourse& course);

/// How near to the rows.
struct TurningFit {
  double tolerance = 0;        // radians; nodes are added until the rows are within it
  bool rows_are_exact = true;  // where that takes about as many nodes as rows: take the rows themselves
};

/// Theta over the run. Where rows only grow (or only fall), so does Theta; where they stay, Theta does.
TurningNodes fit(const TurningRun& run, const TurningFit& how);

/// The same of a run that goes round and on, its end joining its start: over [lo, hi] Theta grows by `turn`, and the
/// curvature at both ends is the same.
TurningNodes fit_round(const TurningRun& run, double turn, const TurningFit& how);

/// Of a spline whose points' first coordinates are values: its value and slope at s, also beyond its ends.
Vec2 value_and_slope(const FittedSpline& spline, double s);

/// The same function, with a node at each break. Of a closed spline the last is the first.
TurningNodes nodes_at_breaks(const FittedSpline& spline);

/// Where nodes only grow or only fall, or stay, the cubics between them do as well; their slopes change. `round`: the
/// last node is the first.
void make_monotone(TurningNodes& nodes, bool round);

/// How rows are off: each by its own normal error, or by the sum of its own and all before it.
struct RowErrors {
  double sd = 0;         // radians, above 0
  bool gathers = false;  // increments
};

/// What a least-squares fit took and left, over one run or several.
struct FitSums {
  std::size_t rows = 0;     // rows of the runs; where errors gather, the steps between them
  double coefficients = 0;  // of the splines: as many parameters were free
  double squares = 0;       // radians^2: of what the rows are off; of rows that gather, of what each adds
  // What is left of the ramp when it is fitted like the rows: how well the rows tell the drift from the shape.
  double ramps = 0;  // its square
  double both = 0;   // times what is left of the rows
};

/// Theta over the run, which has noise: a cubic spline of least squares with as few knots as the noise allows. A span
/// is halved while blocks of its rows are off, on average, by more than chance makes of the noise (chi-square).
TurningNodes smooth(const TurningRun& run, const RowErrors& errors, FitSums& sums);

/// The same of a run that goes round and on, see fit_round. Several passes may lie over one another.
TurningNodes smooth_round(const TurningRun& whole, double turn, const RowErrors& errors, FitSums& sums);

/// A roll to learn a part from, as it was felt: its rows in the direction of growing length, cut at the corners, how
/// far they may be off, and where in the world it starts.
class FeltRoll {
 public:
  /// Both have to outlive it. Throws InputError: see `teach`.
  FeltRoll(const Log& log, const TeachOptions& options);

  /// Throws InputError, in the log's name.
  [[noreturn]] void refuse(const std::string& what) const;

  bool is_fingers() const { return log_.kind == LogKind::contact; }  // of u and psi; else of a length and a turn
  const Log& log() const { return log_; }
  const Noise& noise() const { return noise_; }
  const Rounding& rounding() const { return rounding_; }
  double radius() const { return radius_; }                       // of the finger; 1 of a length and a turn
  double place_rounding() const { return felt_.place_rounding; }  // radians of u, else length
  const TurningRuns& whole() const { return whole_; }
  std::size_t rows() const { return readings_.size(); }

  /// What the rows' turns seem to be off by, each for itself, where no noise was given; 0 where nothing shows it.
  double unsaid_noise() const;
  bool is_noisy() const { return noise_.angle > 0 || noise_.contact > 0; }
  /// How near to exact rows Theta has to be.
  TurningFit how() const;
  /// How noisy rows are off Theta. In a finger's u + psi, and in its place, there is the same error of the contact.
  RowErrors errors() const;
  /// Of the turn, beside the rows' own errors, gathered over a lap (or all of a roll that is shorter).
  double drift_variance() const;
  /// Of the drift of a lap, how much a roll has after this length: a gyroscope drifts with time, all else with length.
  double drift_share(double rolled, double lap) const;

  /// Where the roll starts in the world, as far as the log says, and the tangent there.
  Vec2 start_point() const;
  double start_direction() const;  // radians

 private:
  double bend_over(double length) const;  // mean curvature of a roll of this length, at least 0
  double bend() const { return bend_over(whole_.length()); }
  RowErrors errors_at(double bend) const;  // where the part is bent so
  void find_runs();
  double seconds_at(double rolled) const;  // from the roll's start, seconds
  double time_of(std::size_t row) const;   // of a reading, in the log's clock

  const Log& log_;
  const FingerRows& felt_;  // the log's only finger
  const TeachOptions& options_;
  Noise noise_;                    // all 0 where none was given: rows are exact
  Rounding rounding_;              // what digits can have moved the last reading by
  std::vector<Reading> readings_;  // in the direction of growing length
  bool is_backwards_ = false;      // it was logged the other way
  double radius_ = 1;              // of the finger, length per radian of u; 1 without a finger
  TurningRuns whole_;              // all rows, cut at the corners
};

// Rows within this share of the length are at one place, whatever their digits.
inline constexpr double kSamePlace = 1e-12;
// An error is taken as this many standard deviations.
inline constexpr double kDeviations = 3;

/// Theta over rows between two corners: of exact ones through them, of noisy ones by least squares, whose sums are
/// added up.
TurningNodes fit_run(const FeltRoll& roll, const TurningRun& run, FitSums& sums);

/// Theta over all runs, nothing closed. `sums` are of this alone.
TurningCourse open_course(const FeltRoll& roll, const TurningRuns& runs, FitSums& sums);

/// Theta over a lap whose turn is closed, the curvature continuous across the seam.
struct RoundCourse {
  TurningCourse course;
  TurningRuns rows;  // without the drift
  double drift = 0;  // of the turn, that was spread, radians
};

/// `turns`: whole ones that the lap is closed to; `turn_gap`: as much its turn is off them. Noisy rows tell the drift
/// from the shape as well as they can, by least squares, given how large it can be. `sums` are of this alone.
RoundCourse round_course(const FeltRoll& roll, const TurningRuns& lap, int turns, double turn_gap, FitSums& sums);

/// What was taught, for the user to read.
void add_notes(const FeltRoll& roll, Taught& taught);

/// A roll around a part, and how far it may have drifted on the way.
struct RoundRoll {
  const TurningRuns& runs;      // rows
  const TurningCourse& course;  // Theta made of them, nothing closed
  double row_sd = 0;            // of a row's turn, radians, above 0
  double turn_sd = 0;           // of the turn's drift over a lap, radians
  double turn_allowed = 0;      // as much the turn may be off after a lap, radians
  double gap_allowed = 0;       // as far the roll may be from its start after a lap
  double gap_sd = 0;            // what noise and drift move the end by; 0: rows are exact
  double corner_sd = 0;         // of the place where rows pivot, above 0
};

/// One time round.
struct Lap {
  double length = 0;     // in the log's unit
  double length_sd = 0;  // 0: rows are exact
  int turns = 0;         // whole ones that the tangent makes; below 0: clockwise
  double turn_gap = 0;   // of the turn, less `turns` times 2 pi, radians
  bool goes_on = false;  // the roll does after it: then both are from all rows of the overlap
};

/// Where the roll first comes back to its start: a place near it and a direction like it. Where it goes on, both passes
/// of the overlap are laid over one another: the length is that at which they turn alike. A roll that ends where it
/// began, as far as its rows can say, is one lap.
std::optional<Lap> find_lap(const RoundRoll& roll);

/// The rows of one lap. What the roll goes on is laid over its beginning, each row with its pass and its ramp, given
/// the share of a lap's drift at a length rolled. `exact`: rows of later passes are left out, there is nothing to
/// average.
TurningRuns lay_over(const TurningRuns& runs, const Lap& lap, bool exact,
                     const std::function<double(double)>& drift_share, double near_corner);

}  // namespace rollfix::teaching
