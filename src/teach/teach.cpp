#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "outline/turn.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/teach.hpp"
#include "teach/teaching.hpp"
#include "text/text.hpp"
#include "work/pulse.hpp"

namespace rollfix::teaching {
namespace {

/// Rows are noisier than was said when they are off by so many times as much.
constexpr double kNoisier = 1.25;
/// Of tangents, radians, and of lengths, a share: what is known better is exact for all that anyone sees.
constexpr double kExact = 1e-8;

/// Writes the notes of a taught part, for people to read.
class Notes {
 public:
  Notes(const FeltRoll& roll, Taught& taught) : roll_(roll), taught_(taught) {}

  /// All notes, in the order in which the work was done: the rows, their noise, the accuracy, the lap, how it is
  /// closed.
  void tell() {
    const std::string met = taught_.deviation <= kExact
                                ? "through all rows"
                                : fmt::format("rows' turns within {:.2g} deg", taught_.deviation / kDegree);
    say(fmt::format("taught from {} places: {:.6g} long, turn {:.6g} deg, {}, {}", taught_.rows, taught_.lap,
                    taught_.turn / kDegree, counted(taught_.corners, "corner", "corners"), met));
    if (const double noise = roll_.unsaid_noise(); noise > 0) {
      say(
          fmt::format("the rows' turns jitter by {0:.2g} deg, and no noise was given: the part has it all; smooth it "
                      "with `noise` angle={0:.2g}deg",
                      noise / kDegree));
    }
    tell_accuracy();
    if (taught_.overlap > 0) {
      say(fmt::format("the roll is back at its start after {:.6g}; the {:.6g} that it goes on from there {}",
                      taught_.lap, taught_.overlap, roll_.is_noisy() ? "are laid over its beginning" : "close it"));
    }
    tell_closing();
    if (taught_.outline.closed && taught_.turns < 0 && !taught_.outline.hole) {
      say("the course runs clockwise, and lengths stay positive along it");
    }
    if (taught_.outline.hole) say("the finger turned clockwise: the material is outside, a hole");
    if (roll_.noise().radius > 0 && roll_.is_fingers()) {
      say(fmt::format("the finger's radius leaves the size open by {:.3g} %",
                      100 * roll_.noise().radius / roll_.radius()));
    }
  }

 private:
  void say(std::string text) { taught_.notes.push_back(std::move(text)); }

  /// What the part says of its own accuracy, and whether the rows are noisier than was stated.
  void tell_accuracy() {
    const Accuracy& accuracy = taught_.outline.accuracy;
    if (accuracy.turn <= kExact && accuracy.length <= kExact && accuracy.walk == 0) {
      say("it is as exact as the rows: what rounding leaves is next to nothing");
      return;
    }
    std::string text =
        fmt::format("its tangents are known with a standard deviation of {:.2g} deg", accuracy.turn / kDegree);
    if (accuracy.walk > 0) {
      // Over half a lap, the farthest that two places of a closed part are apart.
      text += fmt::format(", turns over half of it with {:.2g} deg",
                          accuracy.walk * std::sqrt(0.5 * taught_.lap) / kDegree);
    }
    if (accuracy.length > 0) text += fmt::format(", its lengths with {:.2g} %", 100 * accuracy.length);
    say(text);
    if (roll_.is_noisy() && taught_.row_sd > kNoisier * roll_.errors().sd) {
      say(fmt::format(
          "the rows' turns are off by {:.2g} deg, which is more than the noise given, {:.2g} deg: counted as found",
          taught_.row_sd / kDegree, roll_.errors().sd / kDegree));
    }
  }

  /// How the ends were joined, with what turn and gap are off and what drift allows of each.
  void tell_closing() {
    const std::string found = fmt::format(
        "the turn is off {} x 360 deg by {:.3g} deg (drift allows {:.3g}), the end is {:.3g} from the "
        "start (drift allows {:.3g})",
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
  }

  const FeltRoll& roll_;
  Taught& taught_;
};

}  // namespace

void add_notes(const FeltRoll& roll, Taught& taught) { Notes(roll, taught).tell(); }

// ---- the part
// Notation:
//   Theta(s), p(s)  the tangent's angle by length rolled and the path that it makes: TurningCourse, TurningPath
//   lap, G, g       the roll's first time round, what its turn is off whole ones and the gap from its end to its start:
//                   `lap_`, `turn_gap`, `gap`
//   allowed         kDeviations standard deviations of what noise and drift make of G and of g, and what rounding and
//                   the distance of exact rows do: `turn_allowed`, `gap_allowed`
//   interpolated    how far every other row is off the curve through the rest, over kInterpolated: `interpolated_`
// Follows docs/teach.md. Both within what is allowed: the lap closes, and what is off is spread over it.

namespace {

/// Exact rows: what every other one is off the curve through the rest, over this factor, is what all are off between.
constexpr double kInterpolated = 16;
/// A smooth fit is off by its noise, and by what was too little to be seen in it: together by this factor.
constexpr double kUnseen = 1.2;
/// A turn that does not close makes a corner of the seam when it is as large as this, radians.
constexpr double kLeastCorner = 0.1;
/// Ends that are nearer together than this share of the lap have no gap between them.
constexpr double kNoGap = 1e-6;
/// What rounding alone leaves: of lengths a share, of turns radians.
constexpr double kRounding = 1e-9;
/// Makes the outline of one roll: what drift allows, the lap, its fit, and how it is closed.
class Teacher {
 public:
  Teacher(const Log& log, const TeachOptions& options) : roll_(log, options), options_(options) {
    taught_.rolled = roll_.whole().length();
  }

  /// All steps, in the order of docs/teach.md, "Closing". Called once.
  Taught teach() {
    find_drift();
    lap_ = roll_.whole();
    if (!options_.open) take_lap();
    fit_lap();
    if (options_.open) {
      taught_.closing = Closing::not_asked;
      draw_open();
    } else if (options_.bridge) {
      bridge();
    } else {
      close();
    }
    add_notes(roll_, taught_);
    return std::move(taught_);
  }

 private:
  /// What the noise and the rows' rounding and distance can have done over the whole roll.
  void find_drift() {
    whole_course_ = open_course(roll_, roll_.whole(), sums_);
    const TurningPath path = path_of(whole_course_, Vec2::Zero());
    size_ = path.size();
    const double from_distance = roll_.is_noisy() ? 0 : leave_out_every_other(path);
    const double row_variance = roll_.errors().sd * roll_.errors().sd;
    // Both ends' rows have their own noise; the drift comes on top. The place: the contact, slip along the roll, and
    // the turn's error as a rotation of the part by its size.
    const double turn_sd = std::sqrt(2 * row_variance + roll_.drift_variance());
    const auto rows = static_cast<double>(roll_.rows());
    const double contact = roll_.noise().contact * (roll_.log().kind == LogKind::increments ? std::sqrt(rows) : 1);
    const double place_sd = std::hypot(std::hypot(contact, roll_.noise().slip * roll_.whole().length()),
                                       std::sqrt(row_variance + roll_.drift_variance()) * size_);
    // Between exact rows, as far as what is left out shows it.
    taught_.turn_allowed = kDeviations * turn_sd + roll_.rounding().turn + kInterpolated * interpolated_ + kRounding;
    taught_.gap_allowed = kDeviations * place_sd + roll_.rounding().length + roll_.rounding().turn * size_ +
                          from_distance + kRounding * size_;
  }

  /// How far the end moves when every other row is left out, a length. Also sets `interpolated_`: what the rows left
  /// out are off the curve through the others, over kInterpolated.
  double leave_out_every_other(const TurningPath& path) {
    TurningCourse thin;
    double off = 0;
    for (const TurningRun& run : roll_.whole().runs) {
      TurningRun every_other{run.lo, run.hi, {}, {}};
      for (std::size_t k = 0; k < run.s.size(); ++k) {
        // The last row always stays, so that the run keeps its end.
        if (k % 2 == 1 && k + 1 < run.s.size()) continue;
        every_other.s.push_back(run.s[k]);
        every_other.angle.push_back(run.angle[k]);
      }
      thin.push_back(fit(every_other, roll_.how()));
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
    if (!roll_.is_noisy()) return 0;
    // Each row's error turns one step: the step's end moves sideways by `step` times sd. n independent steps add up to
    // sqrt(n) step sd.
    const double step = roll_.whole().length() / static_cast<double>(roll_.rows());
    const double rows = std::hypot(roll_.errors().sd * std::sqrt(step * roll_.whole().length()),
                                   std::numbers::sqrt2 * roll_.noise().contact);
    return std::hypot(rows, std::sqrt(roll_.drift_variance()) * size_);
  }

  /// Finds the lap and puts the rows of one lap in `lap_`, later passes laid over it. A roll that does not come back is
  /// a lap as a whole. With `bridge` the end counts as a return only within kDeviations times `gap_sd`.
  void take_lap() {
    const double row_sd = roll_.is_noisy() ? roll_.errors().sd : std::max(roll_.how().tolerance, interpolated_);
    const RoundRoll round{
        roll_.whole(),
        whole_course_,
        row_sd,
        std::sqrt(roll_.drift_variance()),
        taught_.turn_allowed,
        options_.bridge ? kDeviations * gap_sd() + kNoGap * roll_.whole().length() : taught_.gap_allowed,
        gap_sd(),
        std::max(
            {roll_.noise().contact, roll_.radius() * roll_.place_rounding(), kSamePlace * roll_.whole().length()})};
    const Lap lap = find_lap(round).value_or(Lap{roll_.whole().length(), 0, 0, false});
    goes_on_ = lap.goes_on;
    lap_sd_ = lap.length_sd;
    taught_.turns = lap.turns;
    taught_.turn_gap = lap.turn_gap;
    // So near to a corner a row of a later pass may be of either side: it is left out.
    const double near_corner = std::max(taught_.gap_allowed / kDeviations, kDeviations * roll_.noise().contact);
    lap_ = lay_over(
        roll_.whole(), lap, !roll_.is_noisy(), [&](double rolled) { return roll_.drift_share(rolled, lap.length); },
        near_corner);
  }

  /// Theta over the lap, nothing closed, and the figures of the lap.
  void fit_lap() {
    taught_.lap = lap_.length();
    taught_.overlap = goes_on_ ? std::max(0.0, roll_.whole().length() - taught_.lap) : 0;
    course_ = open_course(roll_, lap_, sums_);
    for (const TurningRun& run : lap_.runs) taught_.rows += run.s.size();
  }

  /// The largest |Theta(s_k) - theta_k| over these rows, radians, added to what was found before.
  void measure_deviation(const TurningCourse& course, const TurningRuns& rows) {
    for (std::size_t index = 0; index < course.size(); ++index) {
      const TurningRun& run = rows.runs[index];
      for (std::size_t k = 0; k < run.s.size(); ++k) {
        taught_.deviation = std::max(taught_.deviation, std::abs(course[index].at(run.s[k]) - run.angle[k]));
      }
    }
  }

  /// From the end of the rows to their start, a length. The path of the curve, and what the curve misses of the rows:
  /// each row stands for the stretch up to the middles between its neighbours.
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
      const double turn = roll_.is_noisy() ? course_.back().angle.back() - course_.front().angle.front()
                                           : lap_.runs.back().angle.back() - lap_.runs.front().angle.front();
      taught_.turn_gap = turn_gap(turn);
      taught_.turns = static_cast<int>(std::lround(turn / kFullTurn));
    }
    taught_.turn = kFullTurn * taught_.turns + taught_.turn_gap;
  }

  /// Closes the lap where turn and gap are within what drift allows; else the part is kept open, and nothing is spread.
  /// A turn that does not close may be a corner at the seam, if the place does close.
  void close() {
    const TurningCourse& course = course_;
    measure_turn();
    const double open_gap = gap_of(course, lap_);
    const bool turn_closes = std::abs(taught_.turn_gap) <= taught_.turn_allowed;
    const bool is_pivoting = lap_.starts_at_corner || lap_.ends_at_corner;
    // Rolled from or to within a pivot, or the ends meet at an angle: the seam is a corner, which takes the rest of the
    // turn.
    const bool corner_at_seam =
        is_pivoting || (!turn_closes && std::abs(taught_.turn_gap) >= kLeastCorner && open_gap <= taught_.gap_allowed);
    taught_.gap = open_gap;
    if (corner_at_seam || turn_closes) {
      RoundCourse round = corner_at_seam ? RoundCourse{course, lap_, 0}
                                         : round_course(roll_, lap_, taught_.turns, taught_.turn_gap, sums_);
      // The gap counts with the turn closed: only then both ends are in one direction.
      taught_.gap = gap_of(round.course, round.rows);
      if (taught_.gap <= taught_.gap_allowed) {
        measure_deviation(round.course, round.rows);
        const Closure closure = close_gap(round.course);
        if (closure.closed) {
          taught_.correction = closure.correction + std::abs(round.drift);
          taught_.closing = Closing::spread;
          draw(round.course, true);
          if (corner_at_seam) ++taught_.corners;
          return;
        }
      }
    }
    // Kept open: the sums of the closed fit do not count.
    course_ = open_course(roll_, lap_, sums_);
    measure_deviation(course_, lap_);
    taught_.closing = Closing::kept_open;
    draw(course, false);
  }

  /// Whatever drift allows: who asks for it knows that the roll did not come back.
  void bridge() {
    measure_turn();
    taught_.gap = gap_of(course_, lap_);
    if (goes_on_ || taught_.gap <= kNoGap * taught_.lap) {
      throw InputError(
          fmt::format("{}: `bridge`: expected a roll that ends before its start, found one that "
                      "{}; leave `bridge` out",
                      roll_.log().name,
                      goes_on_ ? fmt::format("comes back to it after {:.6g} of {:.6g}", taught_.lap, taught_.rolled)
                               : "ends where it started"));
    }
    measure_deviation(course_, lap_);
    taught_.closing = Closing::bridged;
    draw(course_, true);
    build_bridge();
  }

  /// An open curve, as the options ask for: the course as it is.
  void draw_open() {
    taught_.turn = course_.back().angle.back() - course_.front().angle.front();
    taught_.gap = gap_of(course_, lap_);
    measure_deviation(course_, lap_);
    draw(course_, false);
  }

  /// The outline of this course, turned and moved to where the log says that the roll starts.
  void draw(TurningCourse course, bool closed) {
    const double direction = roll_.start_direction();
    for (TurningNodes& nodes : course) {
      for (double& angle : nodes.angle) angle += direction;
    }
    const TurningPath path = path_of(course, roll_.start_point());
    taught_.outline.name = roll_.log().name;
    taught_.outline.unit = roll_.log().unit;
    taught_.outline.closed = closed;
    for (const TurningSpan& span : path.spans) taught_.outline.curves.emplace_back(span);
    taught_.corners = course.size() - 1;
    taught_.outline.accuracy = accuracy();
    taught_.outline.hole = closed && roll_.is_fingers() && taught_.turns < 0;
  }

  /// Of a fit of so many coefficients each row's error leaves a share, and that is alike over a coefficient's length.
  Accuracy accuracy() {
    Accuracy accuracy;
    const double lap = lap_.length();
    const auto rows = static_cast<double>(taught_.rows);
    // Lengths: one factor, by slip, by the finger's radius, and by how well the lap's length is known.
    accuracy.length = roll_.noise().slip;
    if (roll_.is_fingers()) accuracy.length = std::hypot(roll_.noise().slip, roll_.noise().radius / roll_.radius());
    accuracy.length = std::hypot(accuracy.length, lap_sd_ / lap);
    if (!roll_.is_noisy()) {
      // Exact rows: the tolerance as the standard deviation of an even distribution, or what rows leave open between
      // them.
      const double rounding = roll_.how().tolerance / (2 * std::numbers::sqrt3);
      accuracy.turn = std::max(rounding, interpolated_);
      accuracy.alike = lap / rows;
      return accuracy;
    }
    // Rows less parameters: the degrees of freedom of the residuals.
    const double free = std::max(1.0, rows - sums_.coefficients);
    taught_.row_sd = std::sqrt(sums_.squares / free);
    const double sd = std::max(roll_.errors().sd, taught_.row_sd);
    // n rows and c coefficients: each place has the mean of n / c rows, so that its variance is sd^2 c / n.
    accuracy.turn = kUnseen * sd * std::sqrt(sums_.coefficients / rows);
    accuracy.alike = lap / std::max(1.0, sums_.coefficients);
    // Drift adds up along the lap as a random walk: per square root of length. Increments' own errors are in it.
    double gathered = roll_.drift_variance();
    if (roll_.errors().gathers) {
      accuracy.turn = sd;
      accuracy.alike = lap / rows;
    }
    accuracy.walk = std::sqrt(gathered / lap);
    return accuracy;
  }

  /// Closes the outline by a cubic from its end to its start, with the tangents of both. Its speed at the ends is the
  /// gap's length, so that it is about as long as the gap. `bridge`: its length, by the midpoint rule.
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

  FeltRoll roll_;
  TeachOptions options_;
  double size_ = 0;             // diagonal of the box around the whole roll's path
  TurningRuns lap_;             // rows of one lap, later passes laid over it
  bool goes_on_ = false;        // the roll does, behind its first lap
  double lap_sd_ = 0;           // of the lap's length
  FitSums sums_;                // of the last fit
  double interpolated_ = 0;     // radians: how far exact rows leave Theta open between them
  TurningCourse whole_course_;  // Theta of the whole roll, nothing closed
  TurningCourse course_;        // Theta of the lap, nothing closed
  Taught taught_;
};

}  // namespace

}  // namespace rollfix::teaching

namespace rollfix {

Taught teach(const Log& log, const TeachOptions& options) {
  const Doing doing("making a part of the roll");
  return teaching::Teacher(log, options).teach();
}

}  // namespace rollfix
