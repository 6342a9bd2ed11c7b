#include "teach/teaching.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "rollfix/rolling.hpp"

// Notation:
//   sd              of a row's turn: `errors`; the contact's error counts by the part's mean curvature, of u and psi by
//                   the finger's as well
//   d_k             fourth differences of turns: of independent errors their variance is 70 sd^2, of increments, which
//                   are differences already, 20 sd^2: `unsaid_noise`
//   G, drift        what a lap's turn is off whole ones, `turn_gap`, and the share of it that is taken for drift
//   ramp            how much of a lap's drift a row has
//   V               the drift's variance beforehand; drift = (both + first ramps) / (ramps + sd^2 / V), sums of what a
//                   fit leaves of the rows and of the ramp: `round_course`, FitSums
//   chord           of an arc over l that turns by t: l sin(t / 2) / (t / 2); added up the rows' path: `dead_reckoned`
// Follows docs/teach.md, "What is made of the rows" and "Closing".
namespace rollfix::teaching {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;
/// No part turns further, radians: a thousand times round. What does is a mistake in units.
constexpr double kMostTurn = 1000 * kFullTurn;

/// The finger as a list, as readers of logs take it; none of a log without u and psi.
std::vector<Finger> fingers_of(const TeachOptions& options) {
  return options.finger ? std::vector<Finger>{*options.finger} : std::vector<Finger>{};
}

/// The rows as readings from the first contact, in the log's order. Of lengths or increments this contact lies before
/// the first row: (0, 0) is put in front. Throws InputError: a log of two fingers.
std::vector<Reading> readings_of(const Log& log, const TeachOptions& options) {
  if (log.fingers.size() > 1) {
    throw InputError(fmt::format("{}: this log is of two fingers, expected one with columns 'u' and 'psi'", log.name));
  }
  std::vector<Reading> readings = readings_as_given(log, fingers_of(options));
  const bool has_first_contact = log.kind == LogKind::contact;
  if (!has_first_contact) readings.insert(readings.begin(), Reading{0, 0});
  return readings;
}

/// Rows at one place that turn by less than this are a bend seen closely: 6 degrees.
constexpr double kLeastPivot = 0.1;
/// Or by less than so many standard deviations of the difference of two rows: noise. With it bends are seen less
/// closely, so that a share of this is theirs.
constexpr double kPivotSigmas = 8;
/// A gap of the turn is more than the fitted curve's own noise when it is so many times a row's.
constexpr double kSurelyDrift = 1.5;
/// Of the lap: places nearer together are one.
constexpr double kAtSeam = 1e-9;

/// A node behind the last one.
void add(TurningNodes& nodes, double s, double angle, double slope) {
  nodes.s.push_back(s);
  nodes.angle.push_back(angle);
  nodes.slope.push_back(slope);
}

/// The last run, which goes on as the first: its rows, then those of the first run one lap later. So the fit across the
/// seam has no end there, and the curvature is continuous. `turn`: of the lap, radians.
TurningRun over_seam(const TurningRuns& rows, double turn) {
  const double lap = rows.length();
  TurningRun seam = rows.runs.back();
  const TurningRun& first = rows.runs.front();
  // Rows at the seam that the first run has again.
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

/// Theta over a lap with corners, its turn closed. One fit runs across the seam, from the last corner to the first; it
/// is cut at the seam into the course's tail and head. The runs between corners need no closing.
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

/// The lap with this drift taken off its rows, each by its share (`ramp`), and fitted closed. `sums` are of this fit.
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

/// The chord of an arc of this length that turns by this angle.
double chord_of(double length, double turn) {
  // sin(x) / x is 1 to the last digit below 1e-8.
  const double half = 0.5 * turn;
  return std::abs(half) < 1e-8 ? length : length * std::sin(half) / half;
}

}  // namespace

FeltRoll::FeltRoll(const Log& log, const TeachOptions& options)
    : log_(log),
      felt_(log.fingers[0]),
      options_(options),
      noise_(options.noise.value_or(Noise{})),
      readings_(readings_of(log, options)) {
  is_backwards_ = readings_.back().length[0] < 0;
  // Rolled against the direction of growing length: the last contact becomes the start, from which lengths grow.
  if (is_backwards_) std::reverse(readings_.begin(), readings_.end());
  require_valid(noise_);
  require_times(noise_, !log.time.empty(), log.name);
  rounding_ = rounding_of(log, fingers_of(options));
  if (is_fingers()) {
    if (!options.finger->is_disk())
      refuse(fmt::format("expected a disk's log, and the finger is {}", options.finger->name()));
    radius_ = options.finger->length_per_u();
  }
  find_runs();
}

void FeltRoll::refuse(const std::string& what) const { throw InputError(fmt::format("{}: {}", log_.name, what)); }

TurningFit FeltRoll::how() const {
  // Both rows of a reading are rounded; of u the rounding turns the contact's normal, and its place, which matters by
  // the mean curvature.
  const double row = 2 * (felt_.angle_rounding + (log_.kind == LogKind::contact ? felt_.place_rounding : 0));
  return {row + 2 * radius_ * felt_.place_rounding * bend() + kSamePlace, true};
}

RowErrors FeltRoll::errors() const { return errors_at(bend()); }

RowErrors FeltRoll::errors_at(double bend) const {
  // An error e of the contact moves the row by e along the part, which turns the tangent by kappa e; of a finger it
  // also turns the normal on the finger, by e / r.
  const double normal = log_.kind == LogKind::contact ? 1 / radius_ : 0;
  return {std::hypot(noise_.angle, noise_.contact * (bend + normal)), log_.kind == LogKind::increments};
}

double FeltRoll::unsaid_noise() const {
  constexpr std::size_t kLeastRows = 50;
  // Independent noise in each row makes neighbouring differences differ in sign in four of five cases; a smooth curve
  // does so rarely, however it bends.
  constexpr double kLeastTurns = 0.65;
  constexpr double kSdOfMedian = 1.4826;  // of a normal distribution, by the median of its sizes
  if (options_.noise || readings_.size() < kLeastRows) return 0;
  const bool is_summed = log_.kind == LogKind::increments;
  std::vector<double> differences;
  for (const Reading& reading : readings_) differences.push_back(reading.turn);
  // Fourth differences: of a smooth curve they are small by the fourth power of the rows' distance. Of sums of
  // increments they are third differences of the increments, whose errors are independent.
  for (int k = 0; k < 4; ++k) {
    std::adjacent_difference(differences.begin(), differences.end(), differences.begin());
    differences.erase(differences.begin());
  }
  double turns = 0;
  for (std::size_t k = 1; k < differences.size(); ++k) turns += differences[k] * differences[k - 1] < 0 ? 1 : 0;
  // The differences do not alternate as noise does: nothing is said of noise.
  if (turns < kLeastTurns * static_cast<double>(differences.size())) return 0;
  for (double& one : differences) one = std::abs(one);
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  // The median, so that corners among the rows do not count.
  const double sd = kSdOfMedian * *middle / std::sqrt(is_summed ? 20.0 : 70.0);
  return sd > how().tolerance ? sd : 0;
}

/// Mean curvature of the roll without its sign, 1 / length.
double FeltRoll::bend_over(double length) const {
  return std::abs(readings_.back().turn - readings_.front().turn) / length;
}

/// Checks the readings and cuts them at the corners. Throws InputError: no length, turns that no part has, all rows at
/// one place, a roll that goes back.
void FeltRoll::find_runs() {
  const double rolled = readings_.back().length[0] - readings_.front().length[0];
  if (!(rolled > 0) || !std::isfinite(rolled))
    refuse(fmt::format("expected a roll around a part, found one of length {}", rolled));
  for (const Reading& reading : readings_) {
    if (std::abs(reading.turn) <= kMostTurn) continue;
    refuse(fmt::format("expected a turn of at most 1000 times 360 deg, found {} rad; degrees are written 73deg",
                       reading.turn));
  }
  // Rows nearer together than this can't be told apart in place: by their digits, or by three standard deviations of
  // the contact.
  const double same = std::max({2 * radius_ * felt_.place_rounding, kDeviations * noise_.contact, kSamePlace * rolled});
  try {
    const double noise = std::numbers::sqrt2 * errors_at(bend_over(rolled)).sd;
    whole_ = turning_runs(readings_, {same, std::max(kLeastPivot, kPivotSigmas * noise), options_.corner_angle});
  } catch (const InputError& error) {
    refuse(error.what());
  }
  if (!(whole_.length() > 0)) refuse("expected a roll around a part, found all rows at one place");
}

double FeltRoll::drift_variance() const {
  const auto rows = static_cast<double>(readings_.size());
  const double seconds = log_.time.empty() ? 0 : log_.time.back() - log_.time.front();
  // Increments add up their own errors; a scale error of the gyroscope is a share of the whole turn; bias and random
  // walk gather with time.
  const double gathered = log_.kind == LogKind::increments ? rows * errors().sd * errors().sd : 0;
  const double by_scale = noise_.gyro * readings_.back().turn;
  return gathered + by_scale * by_scale + rollfix::drift_variance(noise_, log_.kind, 1, {0, seconds});
}

double FeltRoll::drift_share(double rolled, double lap) const {
  const bool by_time = (noise_.drift > 0 || noise_.walk > 0) && !log_.time.empty();
  return by_time ? seconds_at(rolled) / seconds_at(lap) : rolled / lap;
}

/// Seconds from the roll's first row to where it has rolled so far; linear between rows.
double FeltRoll::seconds_at(double rolled) const {
  const std::vector<Reading>& rows = readings_;
  const double place = rows.front().length[0] + rolled;
  const auto after = std::find_if(rows.begin() + 1, rows.end() - 1,
                                  [&](const Reading& reading) { return reading.length[0] >= place; });
  const auto k = static_cast<std::size_t>(after - rows.begin());
  const double step = rows[k].length[0] - rows[k - 1].length[0];
  const double share = step > 0 ? (place - rows[k - 1].length[0]) / step : 0;
  return std::abs(time_of(k - 1) + share * (time_of(k) - time_of(k - 1)) - time_of(0));
}

/// Seconds of a reading, in the log's clock. Readings may be in the reverse order of the log's rows.
double FeltRoll::time_of(std::size_t row) const {
  const std::size_t count = readings_.size();
  const std::size_t in_order = is_backwards_ ? count - 1 - row : row;
  if (log_.kind == LogKind::contact) return log_.time[in_order];
  // Before the first row there is the start, a usual step earlier.
  const double step = (log_.time.back() - log_.time.front()) / static_cast<double>(std::max<std::size_t>(count, 3) - 2);
  return in_order == 0 ? log_.time.front() - step : log_.time[in_order - 1];
}

/// The first contact: the centre and one radius along the outward direction u + psi; (0, 0) where the log has no
/// centre.
Vec2 FeltRoll::start_point() const {
  const bool knows = log_.kind == LogKind::contact && !felt_.x.empty() && !felt_.y.empty();
  if (!knows) return Vec2::Zero();
  const std::size_t row = is_backwards_ ? log_.rows() - 1 : 0;
  const double facing = felt_.u[row] + felt_.psi[row];
  return Vec2(felt_.x[row], felt_.y[row]) + radius_ * Vec2(std::cos(facing), std::sin(facing));
}

/// What has to be added to Theta of the course to have the tangent's direction in the world: the contact's outward
/// direction less a quarter turn, less the first reading's turn. 0 where the log does not say it.
double FeltRoll::start_direction() const {
  if (log_.kind != LogKind::contact) return 0;
  const std::size_t row = is_backwards_ ? log_.rows() - 1 : 0;
  return felt_.u[row] + felt_.psi[row] - kQuarter - readings_.front().turn;
}

TurningNodes fit_run(const FeltRoll& roll, const TurningRun& run, FitSums& sums) {
  return roll.is_noisy() ? smooth(run, roll.errors(), sums) : fit(run, roll.how());
}

TurningCourse open_course(const FeltRoll& roll, const TurningRuns& runs, FitSums& sums) {
  sums = {};
  TurningCourse course;
  for (const TurningRun& run : runs.runs) course.push_back(fit_run(roll, run, sums));
  return course;
}

RoundCourse round_course(const FeltRoll& roll, const TurningRuns& lap, int turns, double turn_gap, FitSums& sums) {
  const RowErrors errors = roll.errors();
  // Exact rows: all that the turn is off whole ones is drift.
  if (!roll.is_noisy()) return without(turn_gap, roll, lap, turns, sums);
  if (errors.gathers) return without(0, roll, lap, turns, sums);  // the fit of slopes closes the turn
  const double row_variance = errors.sd * errors.sd;
  // A gap beyond what row noise leaves is drift whatever was said of it: its variance is at least the gap's square.
  const bool is_drift = std::abs(turn_gap) > kSurelyDrift * errors.sd;
  const double variance = std::max(roll.drift_variance(), is_drift ? turn_gap * turn_gap : 0);
  if (variance == 0) return without(0, roll, lap, turns, sums);
  const double first = is_drift ? turn_gap : 0;
  // With given knots the fit is linear in the rows: with `first` taken off, its sums tell how the residuals depend on
  // the drift. The drift that minimizes |rows - drift ramp|^2 / sd^2 + drift^2 / V follows from them.
  without(first, roll, lap, turns, sums);
  const double drift = (sums.both + first * sums.ramps) / (sums.ramps + row_variance / variance);
  return without(drift, roll, lap, turns, sums);
}

}  // namespace rollfix::teaching

namespace rollfix {

std::vector<ReckonedRow> dead_reckoned(const Log& log, const std::optional<Finger>& finger) {
  const bool is_contact = log.kind == LogKind::contact;
  if (log.fingers.size() > 1) throw InputError(fmt::format("{}: expected the log of one finger, found two", log.name));
  if (is_contact && (!finger || !finger->is_disk())) {
    throw InputError(fmt::format("{}: a log of u and psi takes a disk to add up, found none", log.name));
  }
  const FingerRows& felt = log.fingers[0];
  std::vector<Reading> readings = readings_as_given(log, finger ? std::vector<Finger>{*finger} : std::vector<Finger>{});
  if (!is_contact) readings.insert(readings.begin(), Reading{0, 0});
  const bool backwards = readings.back().length[0] < 0;
  if (backwards) std::reverse(readings.begin(), readings.end());

  ReckonedRow row;
  // s and Theta count from the first row, which of a reversed log has a length below 0.
  const double first_length = readings.front().length[0], first_turn = readings.front().turn;
  double direction = 0;
  if (is_contact) {
    const std::size_t k = backwards ? log.rows() - 1 : 0;
    const double facing = felt.u[k] + felt.psi[k];
    direction = facing - 0.5 * std::numbers::pi;
    const bool has_place = !felt.x.empty() && !felt.y.empty();
    if (has_place) {
      row.point = Vec2(felt.x[k], felt.y[k]) + finger->length_per_u() * Vec2(std::cos(facing), std::sin(facing));
    }
  }
  std::vector<ReckonedRow> rows;
  for (const Reading& reading : readings) {
    const double s = reading.length[0] - first_length, angle = direction + reading.turn - first_turn;
    // The step to this row as an arc of its length and turn: along the mean of both tangents, as long as the arc's
    // chord.
    if (!rows.empty()) {
      const double middle = 0.5 * (row.angle + angle);
      row.point += teaching::chord_of(s - row.s, angle - row.angle) * Vec2(std::cos(middle), std::sin(middle));
    }
    row.s = s;
    row.angle = angle;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace rollfix
