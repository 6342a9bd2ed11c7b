#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rollfix/log.hpp"
#include "rollfix/teach.hpp"
#include "teach/turning_course.hpp"
#include "teach/turning_fit.hpp"

namespace rollfix::teaching {

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

}  // namespace rollfix::teaching
