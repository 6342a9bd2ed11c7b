#include "teach/round_course.hpp"

#include <algorithm>
#include <cmath>

#include "outline/turn.hpp"

namespace rollfix {
namespace {

/// A gap of the turn is more than the fitted curve's own noise when it is so many times a row's.
constexpr double kSurelyDrift = 1.5;
/// Of the lap: places nearer together are one.
constexpr double kAtSeam = 1e-9;

void add(TurningNodes& nodes, double s, double angle, double slope) {
  nodes.s.push_back(s);
  nodes.angle.push_back(angle);
  nodes.slope.push_back(slope);
}

/// The last run, which goes on as the first.
TurningRun over_seam(const TurningRuns& rows, double turn) {
  const double lap = rows.length();
  TurningRun seam = rows.runs.back();
  const TurningRun& first = rows.runs.front();
  while (!seam.s.empty() && seam.s.back() >= first.s.front() + lap - kAtSeam * lap) {
    seam.s.pop_back();
    seam.angle.pop_back();
  }
  seam.pass.resize(seam.s.size());
  seam.ramp.resize(seam.s.size());
  for (int& pass : seam.pass) ++pass;  // a pass goes on where the next one begins
  for (std::size_t k = 0; k < first.s.size(); ++k) {
    seam.s.push_back(first.s[k] + lap);
    seam.angle.push_back(first.angle[k] + turn);
    seam.pass.push_back(first.pass[k]);
    seam.ramp.push_back(first.ramp[k]);
  }
  seam.hi = first.hi + lap;
  return seam;
}

/// Of rows with corners.
TurningCourse across_seam(const FeltRoll& roll, const TurningRuns& rows, double turn, FitSums& sums) {
  const double lap = rows.length();
  const double end = rows.runs.back().hi;
  TurningNodes nodes = fit_run(roll, over_seam(rows, turn), sums);
  split_at(nodes, end);
  TurningNodes head;
  TurningNodes tail;
  for (std::size_t k = 0; k < nodes.s.size(); ++k) {
    if (nodes.s[k] <= end) add(tail, nodes.s[k], nodes.angle[k], nodes.slope[k]);
    if (nodes.s[k] >= end) add(head, nodes.s[k] - lap, nodes.angle[k] - turn, nodes.slope[k]);
  }
  TurningCourse course = {head};
  for (std::size_t k = 1; k + 1 < rows.runs.size(); ++k) course.push_back(fit_run(roll, rows.runs[k], sums));
  course.push_back(tail);
  return course;
}

RoundCourse without(double drift, const FeltRoll& roll, const TurningRuns& lap, int turns, FitSums& sums) {
  sums = {};
  RoundCourse round{{}, lap, drift};
  for (TurningRun& run : round.rows.runs) {
    for (std::size_t k = 0; k < run.s.size(); ++k) run.angle[k] -= drift * run.ramp[k];
  }
  const double turn = kFullTurn * turns;
  if (round.rows.runs.size() > 1) {
    round.course = across_seam(roll, round.rows, turn, sums);
    return round;
  }
  const TurningRun& run = round.rows.runs.front();
  round.course = {roll.is_noisy() ? smooth_round(run, turn, roll.errors(), sums) : fit_round(run, turn, roll.how())};
  return round;
}

}  // namespace

RoundCourse round_course(const FeltRoll& roll, const TurningRuns& lap, int turns, double turn_gap, FitSums& sums) {
  const RowErrors errors = roll.errors();
  if (!roll.is_noisy()) return without(turn_gap, roll, lap, turns, sums);
  if (errors.gathers) return without(0, roll, lap, turns, sums);  // the fit of slopes closes the turn
  const double row_variance = errors.sd * errors.sd;
  const bool is_drift = std::abs(turn_gap) > kSurelyDrift * errors.sd;
  const double variance = std::max(roll.drift_variance(), is_drift ? turn_gap * turn_gap : 0);
  if (variance == 0) return without(0, roll, lap, turns, sums);
  const double first = is_drift ? turn_gap : 0;
  without(first, roll, lap, turns, sums);
  const double drift = (sums.both + first * sums.ramps) / (sums.ramps + row_variance / variance);
  return without(drift, roll, lap, turns, sums);
}

}  // namespace rollfix
