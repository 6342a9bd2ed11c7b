#include "rollfix/contact/teach.hpp"
#include "text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "contact/turning_course.hpp"
#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline/primitives.hpp"

namespace rollfix {

namespace {

constexpr double kQuarter = std::numbers::pi / 2;
/// The drift is taken as this many standard deviations.
constexpr double kDeviations = 3;
/// A row may be off by this many: the farthest of ten thousand is.
constexpr double kRowDeviations = 4.5;
/// A turn that does not close makes a corner of the seam when it is as large as this, radians.
constexpr double kLeastCorner = 0.1;
/// What rounding alone leaves: of lengths a share, of turns radians.
constexpr double kRounding = 1e-9;
/// Rows within this share of the length are at one place, whatever their digits.
constexpr double kSamePlace = 1e-12;
/// A roll has left its start when it is this far away, as a share of its size, and by this many times the drift.
constexpr double kLeft = 0.05;
constexpr double kLeftDrift = 4;
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
    rounding_ = rounding_of(log, fingers_of(options));
    if (log.kind != LogKind::contact) return;
    if (!options.finger->is_disk())
      refuse(fmt::format("expected a disk's log, and the finger is {}", options.finger->name()));
    radius_ = options.finger->length_per_u();
  }

  Taught teach() {
    find_runs();
    find_drift();
    if (!options_.open) find_lap();
    measure_deviation();
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

  /// How near to the rows Theta has to be.
  TurningFit how() const {
    const double length = whole_.length();
    const double bend = std::abs(rows_.readings.back().turn - rows_.readings.front().turn) / length;
    const bool is_noisy = row_turn_noise() > 0 || noise_.contact > 0;
    if (is_noisy) return {kRowDeviations * std::hypot(row_turn_noise(), noise_.contact * bend), false};
    const double row = 2 * (felt_.angle_rounding + (log_.kind == LogKind::contact ? felt_.place_rounding : 0));
    return {row + 2 * radius_ * felt_.place_rounding * bend + kSamePlace, true};
  }

  /// Of one row: u + psi of a finger's log holds the contact's noise as well.
  double row_turn_noise() const {
    return log_.kind == LogKind::contact ? std::hypot(noise_.angle, noise_.contact / radius_) : noise_.angle;
  }

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
    lap_ = whole_;
    taught_.rolled = whole_.length();
  }

  TurningCourse open_course(const TurningRuns& runs) const {
    TurningCourse course;
    for (const TurningRun& run : runs.runs) course.push_back(fit(run, how()));
    return course;
  }

  /// What the noise and the rows' rounding and distance can have done over the whole roll.
  void find_drift() {
    whole_course_ = open_course(whole_);
    const TurningPath path = path_of(whole_course_, Vec2::Zero());
    size_ = path.size();
    TurningRuns thin = whole_;
    for (TurningRun& run : thin.runs) {
      TurningRun every_other{run.lo, run.hi, {}, {}};
      for (std::size_t k = 0; k < run.s.size(); ++k) {
        if (k % 2 == 1 && k + 1 < run.s.size()) continue;
        every_other.s.push_back(run.s[k]);
        every_other.angle.push_back(run.angle[k]);
      }
      run = every_other;
    }
    const double from_distance = (path_of(open_course(thin), Vec2::Zero()).point.back() - path.point.back()).norm();
    const double turn_sd = std::numbers::sqrt2 * row_turn_noise();
    const double place_sd = std::hypot(std::hypot(noise_.contact, noise_.slip * whole_.length()), noise_.angle * size_);
    taught_.turn_allowed = kDeviations * turn_sd + rounding_.turn + kRounding;
    taught_.gap_allowed =
        kDeviations * place_sd + rounding_.length + rounding_.turn * size_ + from_distance + kRounding * size_;
  }

  /// The turn from the start, less the nearest multiple of 2 pi.
  static double turn_gap(double turn) { return turn - kFullTurn * std::round(turn / kFullTurn); }

  /// Cuts the roll where it first comes back to its start, unless that is its end.
  void find_lap() {
    const TurningCourse& course = whole_course_;
    const TurningPath path = path_of(course, Vec2::Zero());
    bool has_left = false;
    double before = 1;  // of the distance's growth
    for (std::size_t k = 0; k < path.spans.size(); ++k) {
      const TurningSpan& span = path.spans[k];
      const double width = span.domain().hi;
      const auto growth = [&](double x) {
        const Jet jet = span.jet(x);
        return (jet.position - path.point.front()).dot(jet.first);
      };
      const double distance = (path.point[k] - path.point.front()).norm();
      has_left = has_left || distance > std::max(kLeft * size_, kLeftDrift * taught_.gap_allowed);
      const double at_start = growth(0);
      const double at_end = growth(width);
      if (has_left && before < 0 && at_start >= 0 && try_lap(path.s[k], path.point[k], course, path)) return;
      if (has_left && at_start < 0 && at_end >= 0) {
        Interval range{0, width};
        for (int step = 0; step < 60; ++step) (growth(range.middle()) < 0 ? range.lo : range.hi) = range.middle();
        const double x = range.middle();
        if (try_lap(path.s[k] + x, span.jet(x).position, course, path)) return;
      }
      before = at_end;
    }
  }

  bool try_lap(double place, const Vec2& point, const TurningCourse& course, const TurningPath& path) {
    const double lap = place - path.s.front();
    const double from_start = (point - path.point.front()).norm();
    if (from_start > taught_.gap_allowed) return false;
    const double turn = angle_at(course, place) - course.front().angle.front();
    const bool at_corner = whole_.starts_at_corner || is_corner(place);
    if (!at_corner && std::abs(turn_gap(turn)) > taught_.turn_allowed) return false;
    const double rest = whole_.length() - lap;
    const bool ends_here = path.gap().norm() <= taught_.gap_allowed && rest <= 2 * taught_.gap_allowed;
    if (!ends_here && rest > 0) lap_ = cut_at(whole_, lap);
    return true;
  }

  static double angle_at(const TurningCourse& course, double place) {
    for (const TurningNodes& nodes : course) {
      if (place <= nodes.s.back()) return nodes.at(place);
    }
    return course.back().angle.back();
  }

  bool is_corner(double place) const {
    return std::any_of(whole_.runs.begin() + 1, whole_.runs.end(),
                       [&](const TurningRun& run) { return std::abs(run.lo - place) <= taught_.gap_allowed; });
  }

  void measure_deviation() {
    taught_.lap = lap_.length();
    taught_.overlap = whole_.length() - lap_.length();
    course_ = taught_.overlap > 0 ? open_course(lap_) : whole_course_;
    for (std::size_t index = 0; index < course_.size(); ++index) {
      const TurningRun& run = lap_.runs[index];
      const TurningNodes& nodes = course_[index];
      taught_.rows += run.s.size();
      for (std::size_t k = 0; k < run.s.size(); ++k) {
        taught_.deviation = std::max(taught_.deviation, std::abs(nodes.at(run.s[k]) - run.angle[k]));
      }
    }
  }

  void close() {
    const TurningCourse& course = course_;
    // Of a whole log the first and the last row say it best; where the lap was cut, there is no row at its end.
    taught_.turn = taught_.overlap > 0 ? angle_at(whole_course_, lap_.runs.back().hi) - course.front().angle.front()
                                       : lap_.runs.back().angle.back() - lap_.runs.front().angle.front();
    taught_.turn_gap = turn_gap(taught_.turn);
    taught_.turns = static_cast<int>(std::lround(taught_.turn / kFullTurn));
    const double open_gap = path_of(course, Vec2::Zero()).gap().norm();
    const bool turn_closes = std::abs(taught_.turn_gap) <= taught_.turn_allowed;
    const bool is_pivoting = lap_.starts_at_corner || lap_.ends_at_corner;
    const bool corner_at_seam =
        is_pivoting || (!turn_closes && std::abs(taught_.turn_gap) >= kLeastCorner && open_gap <= taught_.gap_allowed);
    taught_.gap = open_gap;
    if (corner_at_seam || turn_closes) {
      TurningCourse closed = corner_at_seam ? course : round_course();
      taught_.gap = path_of(closed, Vec2::Zero()).gap().norm();
      if (taught_.gap <= taught_.gap_allowed) {
        const Closure closure = close_gap(closed);
        if (closure.closed) {
          taught_.correction = closure.correction;
          if (!corner_at_seam) taught_.correction += std::abs(taught_.turn_gap);
          taught_.closing = Closing::spread;
          draw(closed, true);
          if (corner_at_seam) ++taught_.corners;
          return;
        }
      }
    }
    if (options_.bridge) {
      taught_.closing = Closing::bridged;
      draw(course, true);
      build_bridge();
      return;
    }
    taught_.closing = Closing::kept_open;
    draw(course, false);
  }

  /// The turn closed, in proportion to length, and the curvature continuous across the seam.
  TurningCourse round_course() const {
    const double start = lap_.runs.front().lo;
    const double lap = lap_.length();
    TurningRuns rows = lap_;
    for (TurningRun& run : rows.runs) {
      for (std::size_t k = 0; k < run.s.size(); ++k) run.angle[k] -= taught_.turn_gap * (run.s[k] - start) / lap;
    }
    const double turn = kFullTurn * taught_.turns;
    if (rows.runs.size() == 1) return {fit_round(rows.runs.front(), turn, how())};
    // The last run goes on as the first.
    TurningRun seam = rows.runs.back();
    const TurningRun& first = rows.runs.front();
    const double end = seam.hi;
    while (!seam.s.empty() && seam.s.back() >= first.s.front() + lap - kRounding * lap) {
      seam.s.pop_back();
      seam.angle.pop_back();
    }
    for (std::size_t k = 0; k < first.s.size(); ++k) {
      seam.s.push_back(first.s[k] + lap);
      seam.angle.push_back(first.angle[k] + turn);
    }
    seam.hi = first.hi + lap;
    TurningNodes nodes = fit(seam, how());
    split_at(nodes, end);
    TurningNodes head;
    TurningNodes tail;
    for (std::size_t k = 0; k < nodes.s.size(); ++k) {
      if (nodes.s[k] <= end) add(tail, nodes.s[k], nodes.angle[k], nodes.slope[k]);
      if (nodes.s[k] >= end) add(head, nodes.s[k] - lap, nodes.angle[k] - turn, nodes.slope[k]);
    }
    TurningCourse course = {head};
    for (std::size_t k = 1; k + 1 < rows.runs.size(); ++k) course.push_back(fit(rows.runs[k], how()));
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
    taught_.gap = path_of(course_, Vec2::Zero()).gap().norm();
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
    taught_.outline.closed = closed;
    for (const TurningSpan& span : path.spans) taught_.outline.curves.emplace_back(span);
    taught_.corners = course.size() - 1;
    taught_.outline.hole = closed && log_.kind == LogKind::contact && taught_.turns < 0;
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

  void tell() {
    say(fmt::format("taught from {} places: {:.6g} long, turn {:.6g} deg, {}, rows' turns within {:.2g} deg",
                    taught_.rows, taught_.lap, taught_.turn / kDegree, counted(taught_.corners, "corner", "corners"),
                    taught_.deviation / kDegree));
    if (taught_.overlap > 0) {
      say(fmt::format("the roll is back at its start after {:.6g}; the {:.6g} that it goes on from there are left out",
                      taught_.lap, taught_.overlap));
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
  TurningCourse whole_course_;  // Theta of both, nothing closed
  TurningCourse course_;
  Taught taught_;
};

}  // namespace

Taught teach(const Log& log, const TeachOptions& options) { return Teacher(log, options).teach(); }

}  // namespace rollfix
