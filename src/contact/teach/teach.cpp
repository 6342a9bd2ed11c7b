#include "rollfix/contact/teach.hpp"
#include "text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "contact/teach/lap.hpp"
#include "contact/teach/turning_course.hpp"
#include "contact/teach/turning_fit.hpp"
#include "contact/teach/turning_smooth.hpp"
#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline/primitives.hpp"

namespace rollfix {

namespace {

constexpr double kQuarter = std::numbers::pi / 2;
/// The drift is taken as this many standard deviations.
constexpr double kDeviations = 3;
/// Exact rows: what every other one is off the curve through the rest, less this factor, is what all are off between.
constexpr double kInterpolated = 16;
/// A gap of the turn is more than the fitted curve's own noise when it is so many times a row's.
constexpr double kSurelyDrift = 1.5;
/// Rows are noisier than was said when they are off by so many times as much.
constexpr double kNoisier = 1.25;
/// A smooth fit is off by its noise, and by what was too little to be seen in it: together by this factor.
constexpr double kUnseen = 1.2;
/// A turn that does not close makes a corner of the seam when it is as large as this, radians.
constexpr double kLeastCorner = 0.1;
/// What rounding alone leaves: of lengths a share, of turns radians.
constexpr double kRounding = 1e-9;
/// Of tangents, radians, and of lengths, a share: what is known better is exact for all that anyone sees.
constexpr double kExact = 1e-8;
/// Rows within this share of the length are at one place, whatever their digits.
constexpr double kSamePlace = 1e-12;
/// No part turns further, radians: a thousand times round. What does is a mistake in units.
constexpr double kMostTurn = 1000 * kFullTurn;

/// A roll's rows in the direction of growing length.
struct Rows {
  std::vector<Reading> readings;
  bool backwards = false;  // as they were logged
};

std::vector<Finger> fingers_of(const TeachOptions& options) {
  return options.finger ? std::vector<Finger>{*options.finger} : std::vector<Finger>{};
}

Rows rows_of(const Log& log, const TeachOptions& options) {
  if (log.fingers.size() > 1) {
    throw InputError(fmt::format("{}: this log is of two fingers, expected one with columns 'u' and 'psi'", log.name));
  }
  Rows rows;
  rows.readings = readings_as_given(log, fingers_of(options));
  const bool has_first_contact = log.kind == LogKind::contact;
  if (!has_first_contact) rows.readings.insert(rows.readings.begin(), Reading{0, 0});
  rows.backwards = rows.readings.back().length[0] < 0;
  if (rows.backwards) std::reverse(rows.readings.begin(), rows.readings.end());
  return rows;
}

class Teacher {
 public:
  Teacher(const Log& log, const TeachOptions& options)
      : log_(log),
        felt_(log.fingers[0]),
        options_(options),
        noise_(options.noise.value_or(Noise{})),
        rows_(rows_of(log, options)) {
    require_valid(noise_);
    require_times(noise_, !log.time.empty(), log.name);
    rounding_ = rounding_of(log, fingers_of(options));
    if (log.kind != LogKind::contact) return;
    if (!options.finger->is_disk())
      refuse(fmt::format("expected a disk's log, and the finger is {}", options.finger->name()));
    radius_ = options.finger->length_per_u();
  }

  Taught teach() {
    find_runs();
    find_drift();
    lap_ = whole_;
    if (!options_.open) take_lap();
    fit_lap();
    if (options_.open) {
      taught_.closing = Closing::not_asked;
      draw_open();
    } else {
      close();
    }
    tell();
    return std::move(taught_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { throw InputError(fmt::format("{}: {}", log_.name, what)); }

  bool is_noisy() const { return noise_.angle > 0 || noise_.contact > 0; }

  /// How near to exact rows Theta has to be.
  TurningFit how() const {
    const double row = 2 * (felt_.angle_rounding + (log_.kind == LogKind::contact ? felt_.place_rounding : 0));
    return {row + 2 * radius_ * felt_.place_rounding * bend() + kSamePlace, true};
  }

  /// How noisy rows are off Theta. In a finger's u + psi, and in its place, there is the same error of the contact.
  RowErrors errors() const {
    const double normal = log_.kind == LogKind::contact ? 1 / radius_ : 0;
    return {std::hypot(noise_.angle, noise_.contact * (bend() + normal)), log_.kind == LogKind::increments};
  }

  double bend() const { return std::abs(rows_.readings.back().turn - rows_.readings.front().turn) / whole_.length(); }

  void find_runs() {
    const double rolled = rows_.readings.back().length[0] - rows_.readings.front().length[0];
    if (!(rolled > 0) || !std::isfinite(rolled))
      refuse(fmt::format("expected a roll around a part, found one of length {}", rolled));
    for (const Reading& reading : rows_.readings) {
      if (std::abs(reading.turn) <= kMostTurn) continue;
      refuse(fmt::format("expected a turn of at most 1000 times 360 deg, found {} rad; degrees are written 73deg",
                         reading.turn));
    }
    const double same =
        std::max({2 * radius_ * felt_.place_rounding, kDeviations * noise_.contact, kSamePlace * rolled});
    try {
      whole_ = turning_runs(rows_.readings, {same, options_.corner_angle});
    } catch (const InputError& error) {
      refuse(error.what());
    }
    if (!(whole_.length() > 0)) refuse("expected a roll around a part, found all rows at one place");
    taught_.rolled = whole_.length();
  }

  TurningNodes fit_run(const TurningRun& run) { return is_noisy() ? smooth(run, errors(), sums_) : fit(run, how()); }

  TurningCourse open_course(const TurningRuns& runs) {
    sums_ = {};
    TurningCourse course;
    for (const TurningRun& run : runs.runs) course.push_back(fit_run(run));
    return course;
  }

  /// Of the turn, beside the rows' own errors, gathered over a lap (or all of a roll that is shorter).
  double drift_variance() const {
    const auto rows = static_cast<double>(rows_.readings.size());
    const double seconds = log_.time.empty() ? 0 : log_.time.back() - log_.time.front();
    const double gathered = log_.kind == LogKind::increments ? rows * errors().sd * errors().sd : 0;
    return gathered + rollfix::drift_variance(noise_, log_.kind, 1, {0, seconds});
  }

  /// What the noise and the rows' rounding and distance can have done over the whole roll.
  void find_drift() {
    whole_course_ = open_course(whole_);
    const TurningPath path = path_of(whole_course_, Vec2::Zero());
    size_ = path.size();
    const double from_distance = is_noisy() ? 0 : leave_out_every_other(path);
    const double row_variance = errors().sd * errors().sd;
    const double turn_sd = std::sqrt(2 * row_variance + drift_variance());
    const auto rows = static_cast<double>(rows_.readings.size());
    const double contact = noise_.contact * (log_.kind == LogKind::increments ? std::sqrt(rows) : 1);
    const double place_sd = std::hypot(std::hypot(contact, noise_.slip * whole_.length()),
                                       std::sqrt(row_variance + drift_variance()) * size_);
    // Between exact rows, as far as what is left out shows it.
    taught_.turn_allowed = kDeviations * turn_sd + rounding_.turn + kInterpolated * interpolated_ + kRounding;
    taught_.gap_allowed =
        kDeviations * place_sd + rounding_.length + rounding_.turn * size_ + from_distance + kRounding * size_;
  }

  /// How far the end moves; and how far the rows left out are off the curve through the others.
  double leave_out_every_other(const TurningPath& path) {
    TurningCourse thin;
    double off = 0;
    for (const TurningRun& run : whole_.runs) {
      TurningRun every_other{run.lo, run.hi, {}, {}};
      for (std::size_t k = 0; k < run.s.size(); ++k) {
        if (k % 2 == 1 && k + 1 < run.s.size()) continue;
        every_other.s.push_back(run.s[k]);
        every_other.angle.push_back(run.angle[k]);
      }
      thin.push_back(fit(every_other, how()));
      for (std::size_t k = 1; k < run.s.size(); k += 2) {
        off = std::max(off, std::abs(thin.back().at(run.s[k]) - run.angle[k]));
      }
    }
    interpolated_ = off / kInterpolated;
    return (path_of(thin, Vec2::Zero()).point.back() - path.point.back()).norm();
  }

  /// The turn from the start, less the nearest multiple of 2 pi.
  static double turn_gap(double turn) { return turn - kFullTurn * std::round(turn / kFullTurn); }

  /// What the rows' own noise moves the end by: each turns all that follows of a step, but for what others average.
  double gap_sd() const {
    if (!is_noisy()) return 0;
    const double step = whole_.length() / static_cast<double>(rows_.readings.size());
    const double rows =
        std::hypot(errors().sd * std::sqrt(step * whole_.length()), std::numbers::sqrt2 * noise_.contact);
    return std::hypot(rows, std::sqrt(drift_variance()) * size_);
  }

  void take_lap() {
    const double row_sd = is_noisy() ? errors().sd : std::max(how().tolerance, interpolated_);
    const RoundRoll roll{whole_,
                         whole_course_,
                         row_sd,
                         std::sqrt(drift_variance()),
                         taught_.turn_allowed,
                         taught_.gap_allowed,
                         gap_sd(),
                         std::max({noise_.contact, radius_ * felt_.place_rounding, kSamePlace * whole_.length()})};
    const Lap lap = find_lap(roll).value_or(Lap{whole_.length(), 0, 0, false});
    goes_on_ = lap.goes_on;
    lap_sd_ = lap.length_sd;
    taught_.turns = lap.turns;
    taught_.turn_gap = lap.turn_gap;
    const double near_corner = std::max(taught_.gap_allowed / kDeviations, kDeviations * noise_.contact);
    lap_ = lay_over(
        whole_, lap, !is_noisy(), [&](double rolled) { return drift_share(rolled, lap.length); }, near_corner);
  }

  /// Of the drift of a lap, how much a roll has after this length: a gyroscope drifts with time, all else with length.
  double drift_share(double rolled, double lap) const {
    const bool by_time = (noise_.drift > 0 || noise_.walk > 0) && !log_.time.empty();
    return by_time ? seconds_at(rolled) / seconds_at(lap) : rolled / lap;
  }

  /// From the start of the roll, in its direction of growing length.
  double seconds_at(double rolled) const {
    const std::vector<Reading>& rows = rows_.readings;
    const double place = rows.front().length[0] + rolled;
    const auto after = std::find_if(rows.begin() + 1, rows.end() - 1,
                                    [&](const Reading& reading) { return reading.length[0] >= place; });
    const auto k = static_cast<std::size_t>(after - rows.begin());
    const double step = rows[k].length[0] - rows[k - 1].length[0];
    const double share = step > 0 ? (place - rows[k - 1].length[0]) / step : 0;
    return std::abs(time_of(k - 1) + share * (time_of(k) - time_of(k - 1)) - time_of(0));
  }

  double time_of(std::size_t row) const {
    const std::size_t count = rows_.readings.size();
    const std::size_t in_order = rows_.backwards ? count - 1 - row : row;
    if (log_.kind == LogKind::contact) return log_.time[in_order];
    // Before the first row there is the start, a usual step earlier.
    const double step =
        (log_.time.back() - log_.time.front()) / static_cast<double>(std::max<std::size_t>(count, 3) - 2);
    return in_order == 0 ? log_.time.front() - step : log_.time[in_order - 1];
  }

  void fit_lap() {
    taught_.lap = lap_.length();
    taught_.overlap = goes_on_ ? std::max(0.0, whole_.length() - taught_.lap) : 0;
    course_ = open_course(lap_);
    for (const TurningRun& run : lap_.runs) taught_.rows += run.s.size();
  }

  void measure_deviation(const TurningCourse& course, const TurningRuns& rows) {
    for (std::size_t index = 0; index < course.size(); ++index) {
      const TurningRun& run = rows.runs[index];
      for (std::size_t k = 0; k < run.s.size(); ++k) {
        taught_.deviation = std::max(taught_.deviation, std::abs(course[index].at(run.s[k]) - run.angle[k]));
      }
    }
  }

  /// From the end of the rows to their start: what the curve misses of the rows counts as well.
  double gap_of(const TurningCourse& course, const TurningRuns& rows) const {
    Vec2 gap = path_of(course, Vec2::Zero()).gap();
    for (std::size_t index = 0; index < course.size(); ++index) {
      const TurningRun& run = rows.runs[index];
      for (std::size_t k = 0; k < run.s.size(); ++k) {
        const double from = k == 0 ? run.lo : 0.5 * (run.s[k - 1] + run.s[k]);
        const double to = k + 1 == run.s.size() ? run.hi : 0.5 * (run.s[k] + run.s[k + 1]);
        const double there = course[index].at(run.s[k]);
        gap -= (to - from) * Vec2(std::cos(run.angle[k]) - std::cos(there), std::sin(run.angle[k]) - std::sin(there));
      }
    }
    return gap.norm();
  }

  /// What the turn is off, where no rows of a second pass say it.
  void measure_turn() {
    if (!goes_on_) {
      // Of exact rows the first and the last say it best.
      const double turn = is_noisy() ? course_.back().angle.back() - course_.front().angle.front()
                                     : lap_.runs.back().angle.back() - lap_.runs.front().angle.front();
      taught_.turn_gap = turn_gap(turn);
      taught_.turns = static_cast<int>(std::lround(turn / kFullTurn));
    }
    taught_.turn = kFullTurn * taught_.turns + taught_.turn_gap;
  }

  void close() {
    const TurningCourse& course = course_;
    measure_turn();
    const double open_gap = gap_of(course, lap_);
    const bool turn_closes = std::abs(taught_.turn_gap) <= taught_.turn_allowed;
    const bool is_pivoting = lap_.starts_at_corner || lap_.ends_at_corner;
    const bool corner_at_seam =
        is_pivoting || (!turn_closes && std::abs(taught_.turn_gap) >= kLeastCorner && open_gap <= taught_.gap_allowed);
    taught_.gap = open_gap;
    if (corner_at_seam || turn_closes) {
      TurningRuns rows = lap_;
      TurningCourse closed = corner_at_seam ? course : round_course(rows);
      taught_.gap = gap_of(closed, rows);
      if (taught_.gap <= taught_.gap_allowed) {
        measure_deviation(closed, rows);
        const Closure closure = close_gap(closed);
        if (closure.closed) {
          taught_.correction = closure.correction + spread_turn_;
          taught_.closing = Closing::spread;
          draw(closed, true);
          if (corner_at_seam) ++taught_.corners;
          return;
        }
      }
    }
    sums_ = {};
    course_ = open_course(lap_);
    measure_deviation(course_, lap_);
    if (options_.bridge) {
      taught_.closing = Closing::bridged;
      draw(course, true);
      build_bridge();
      return;
    }
    taught_.closing = Closing::kept_open;
    draw(course, false);
  }

  /// The turn closed, and the curvature continuous across the seam. `rows` become those without the drift. Noisy rows
  /// tell the drift from the shape as well as they can, by least squares, given how large it can be.
  TurningCourse round_course(TurningRuns& rows) {
    if (!is_noisy()) return round_course_without(taught_.turn_gap, rows);
    if (errors().gathers) return round_course_without(0, rows);  // the fit of slopes closes the turn
    const double row_variance = errors().sd * errors().sd;
    const bool is_drift = std::abs(taught_.turn_gap) > kSurelyDrift * errors().sd;
    const double variance = std::max(drift_variance(), is_drift ? taught_.turn_gap * taught_.turn_gap : 0);
    if (variance == 0) return round_course_without(0, rows);
    const double first = is_drift ? taught_.turn_gap : 0;
    TurningRuns tried = lap_;
    round_course_without(first, tried);
    const double drift = (sums_.both + first * sums_.ramps) / (sums_.ramps + row_variance / variance);
    return round_course_without(drift, rows);
  }

  TurningCourse round_course_without(double drift, TurningRuns& rows) {
    sums_ = {};
    spread_turn_ = std::abs(drift);
    rows = lap_;
    for (TurningRun& run : rows.runs) {
      for (std::size_t k = 0; k < run.s.size(); ++k) {
        run.angle[k] -= drift * run.ramp[k];
      }
    }
    const double turn = kFullTurn * taught_.turns;
    if (rows.runs.size() == 1) {
      const TurningRun& run = rows.runs.front();
      return {is_noisy() ? smooth_round(run, turn, errors(), sums_) : fit_round(run, turn, how())};
    }
    return across_seam(rows, turn);
  }

  /// Of rows with corners: the last run goes on as the first.
  TurningCourse across_seam(const TurningRuns& rows, double turn) {
    const double lap = rows.length();
    TurningRun seam = rows.runs.back();
    const TurningRun& first = rows.runs.front();
    const double end = seam.hi;
    while (!seam.s.empty() && seam.s.back() >= first.s.front() + lap - kRounding * lap) {
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
    TurningNodes nodes = fit_run(seam);
    split_at(nodes, end);
    TurningNodes head;
    TurningNodes tail;
    for (std::size_t k = 0; k < nodes.s.size(); ++k) {
      if (nodes.s[k] <= end) add(tail, nodes.s[k], nodes.angle[k], nodes.slope[k]);
      if (nodes.s[k] >= end) add(head, nodes.s[k] - lap, nodes.angle[k] - turn, nodes.slope[k]);
    }
    TurningCourse course = {head};
    for (std::size_t k = 1; k + 1 < rows.runs.size(); ++k) course.push_back(fit_run(rows.runs[k]));
    course.push_back(tail);
    return course;
  }

  static void add(TurningNodes& nodes, double s, double angle, double slope) {
    nodes.s.push_back(s);
    nodes.angle.push_back(angle);
    nodes.slope.push_back(slope);
  }

  void draw_open() {
    taught_.turn = course_.back().angle.back() - course_.front().angle.front();
    taught_.gap = gap_of(course_, lap_);
    measure_deviation(course_, lap_);
    draw(course_, false);
  }

  /// Where the roll starts in the world, as far as the log says.
  Vec2 start_point() const {
    const bool knows = log_.kind == LogKind::contact && !felt_.x.empty() && !felt_.y.empty();
    if (!knows) return Vec2::Zero();
    const std::size_t row = rows_.backwards ? log_.rows() - 1 : 0;
    const double facing = felt_.u[row] + felt_.psi[row];
    return Vec2(felt_.x[row], felt_.y[row]) + radius_ * Vec2(std::cos(facing), std::sin(facing));
  }

  double start_direction() const {
    if (log_.kind != LogKind::contact) return 0;
    const std::size_t row = rows_.backwards ? log_.rows() - 1 : 0;
    return felt_.u[row] + felt_.psi[row] - kQuarter - rows_.readings.front().turn;
  }

  void draw(TurningCourse course, bool closed) {
    const double direction = start_direction();
    for (TurningNodes& nodes : course) {
      for (double& angle : nodes.angle) angle += direction;
    }
    const TurningPath path = path_of(course, start_point());
    taught_.outline.name = log_.name;
    taught_.outline.unit = log_.unit;
    taught_.outline.closed = closed;
    for (const TurningSpan& span : path.spans) taught_.outline.curves.emplace_back(span);
    taught_.corners = course.size() - 1;
    taught_.outline.accuracy = accuracy();
    taught_.outline.hole = closed && log_.kind == LogKind::contact && taught_.turns < 0;
  }

  /// Of a fit of so many coefficients each row's error leaves a share, and that is alike over a coefficient's length.
  Accuracy accuracy() {
    Accuracy accuracy;
    const double lap = lap_.length();
    const auto rows = static_cast<double>(taught_.rows);
    accuracy.length = noise_.slip;
    if (log_.kind == LogKind::contact) accuracy.length = std::hypot(noise_.slip, noise_.radius / radius_);
    accuracy.length = std::hypot(accuracy.length, lap_sd_ / lap);
    if (!is_noisy()) {
      const double rounding = how().tolerance / (2 * std::numbers::sqrt3);
      accuracy.turn = std::max(rounding, interpolated_);
      accuracy.alike = lap / rows;
      return accuracy;
    }
    const double free = std::max(1.0, rows - sums_.coefficients);
    taught_.row_sd = std::sqrt(sums_.squares / free);
    const double sd = std::max(errors().sd, taught_.row_sd);
    accuracy.turn = kUnseen * sd * std::sqrt(sums_.coefficients / rows);
    accuracy.alike = lap / std::max(1.0, sums_.coefficients);
    double gathered = drift_variance();
    if (errors().gathers) {
      accuracy.turn = sd;
      accuracy.alike = lap / rows;
    }
    accuracy.walk = std::sqrt(gathered / lap);
    return accuracy;
  }

  /// A cubic with the tangents of both ends and, about, the gap's length.
  void build_bridge() {
    std::vector<Curve>& curves = taught_.outline.curves;
    const Vec2 from = curves.back().back();
    const Vec2 to = curves.front().front();
    const Vec2 chord = to - from;
    const Vec2 leave = chord.norm() * curves.back().velocity(curves.back().domain().hi);
    const Vec2 arrive = chord.norm() * curves.front().velocity(0);
    const CubicSpan bridge(from, to, 3 * chord - 2 * leave - arrive, leave + arrive - 2 * chord);
    constexpr int kSteps = 1000;
    for (int k = 0; k < kSteps; ++k) taught_.bridge += bridge.velocity((k + 0.5) / kSteps).norm() / kSteps;
    curves.emplace_back(bridge);
  }

  void say(std::string text) { taught_.notes.push_back(std::move(text)); }

  void tell_accuracy() {
    const Accuracy& accuracy = taught_.outline.accuracy;
    if (accuracy.turn <= kExact && accuracy.length <= kExact && accuracy.walk == 0) {
      say("it is as exact as the rows: what rounding leaves is next to nothing");
      return;
    }
    std::string text =
        fmt::format("its tangents are known with a standard deviation of {:.2g} deg", accuracy.turn / kDegree);
    if (accuracy.walk > 0) {
      text += fmt::format(", turns over half of it with {:.2g} deg",
                          accuracy.walk * std::sqrt(0.5 * taught_.lap) / kDegree);
    }
    if (accuracy.length > 0) text += fmt::format(", its lengths with {:.2g} %", 100 * accuracy.length);
    say(text);
    if (is_noisy() && taught_.row_sd > kNoisier * errors().sd) {
      say(fmt::format(
          "the rows' turns are off by {:.2g} deg, which is more than the noise given, {:.2g} deg: counted as found",
          taught_.row_sd / kDegree, errors().sd / kDegree));
    }
  }

  void tell() {
    const std::string met = taught_.deviation <= kExact
                                ? "through all rows"
                                : fmt::format("rows' turns within {:.2g} deg", taught_.deviation / kDegree);
    say(fmt::format("taught from {} places: {:.6g} long, turn {:.6g} deg, {}, {}", taught_.rows, taught_.lap,
                    taught_.turn / kDegree, counted(taught_.corners, "corner", "corners"), met));
    tell_accuracy();
    if (taught_.overlap > 0) {
      say(fmt::format("the roll is back at its start after {:.6g}; the {:.6g} that it goes on from there {}",
                      taught_.lap, taught_.overlap, is_noisy() ? "are laid over its beginning" : "close it"));
    }
    const std::string found = fmt::format(
        "the turn is off {} x 360 deg by {:.3g} deg (drift allows {:.3g}), the end is {:.3g} from the start (drift "
        "allows {:.3g})",
        taught_.turns, taught_.turn_gap / kDegree, taught_.turn_allowed / kDegree, taught_.gap, taught_.gap_allowed);
    switch (taught_.closing) {
      case Closing::spread:
        say(fmt::format("closed: {}; spread, which turned tangents by at most {:.3g} deg", found,
                        taught_.correction / kDegree));
        break;
      case Closing::bridged:
        say(fmt::format("closed by a bridge of length {:.6g}: {}", taught_.bridge, found));
        break;
      case Closing::kept_open:
        say(
            fmt::format("kept open, because the drift does not explain it: {}; say how large the drift is with "
                        "`noise`, or bridge the gap with `bridge`",
                        found));
        break;
      case Closing::not_asked:
        say("an open curve, as asked for");
        break;
    }
    if (taught_.outline.closed && taught_.turns < 0 && !taught_.outline.hole) {
      say("the course runs clockwise, and lengths stay positive along it");
    }
    if (taught_.outline.hole) say("the finger turned clockwise: the material is outside, a hole");
    if (noise_.radius > 0 && log_.kind == LogKind::contact) {
      say(fmt::format("the finger's radius leaves the size open by {:.3g} %", 100 * noise_.radius / radius_));
    }
  }

  const Log& log_;
  const FingerRows& felt_;
  TeachOptions options_;
  Noise noise_;
  Rows rows_;
  Rounding rounding_;
  double radius_ = 1;
  double size_ = 0;
  TurningRuns whole_;
  TurningRuns lap_;
  bool goes_on_ = false;
  double lap_sd_ = 0;
  FitSums sums_;
  double interpolated_ = 0;  // radians: how far exact rows leave Theta open between them
  double spread_turn_ = 0;
  TurningCourse whole_course_;  // Theta of both, nothing closed
  TurningCourse course_;
  Taught taught_;
};

}  // namespace

Taught teach(const Log& log, const TeachOptions& options) { return Teacher(log, options).teach(); }

}  // namespace rollfix
