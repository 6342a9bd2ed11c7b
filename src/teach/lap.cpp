#include "teach/teaching.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "outline/turn.hpp"

// Notation:
//   p(s), Theta(s)    the roll's path and the tangent's angle by length rolled, nothing closed: `path_`, `angle_at`
//   L               the lap's length: `Lap::length`
//   n, g            its whole turns, and how far its turn is off them: `turns`, `turn_gap`
//   (s_k, theta_k)  a row after the first lap; off: theta_k - Theta(s_k - L) - 2 pi n, which would be g
//   kappa           Theta' a lap before: a longer L changes off by kappa dL, so that g - kappa dL = off
//   A x = b         normal equations of x = (g, dL): `normal`, `right`
// Follows docs/teach.md, "Closing", 1.
// Idea: the lap ends where |p(s) - p(0)| is least, place and direction being those of the start. If the roll goes on,
// the rows of both passes know L better: least squares, row on row and corner on corner, by Gauss and Newton's steps.
namespace rollfix::teaching {

namespace {

/// A roll has left its start when it is this far away, as a share of its size, and by this many times the drift.
constexpr double kLeft = 0.05;
constexpr double kLeftDrift = 4;
/// The drift that is allowed is so many standard deviations.
constexpr double kAllowedDeviations = 3;
/// A roll that ends so many standard deviations from its start did not end there.
constexpr double kSurelyElsewhere = 2;
/// With fewer rows rolled twice there is nothing to lay over one another.
constexpr std::size_t kLeastOverlap = 3;
constexpr int kLayRounds = 20;
/// Laid over one another to this share of the lap: rounding.
constexpr double kLaid = 1e-15;

/// What a turn has beyond so many full ones, radians.
double turn_beyond(double turn, int turns) { return turn - kFullTurn * turns; }

/// Finds the first place where the path comes back to its start, and then the lap's length.
class LapFinder {
 public:
  explicit LapFinder(const RoundRoll& roll)
      : roll_(roll), path_(path_of(roll.course, Vec2::Zero())), size_(path_.size()), start_(path_.s.front()) {}

  /// Goes along the path, span by span, to the minima of |p(s) - p(0)| behind the place where the roll has left its
  /// start. The first that is_back() takes is the lap's end. Nothing: the roll does not come back.
  std::optional<Lap> find() {
    bool has_left = false;
    double before = 1;  // of the distance's growth
    for (std::size_t k = 0; k < path_.spans.size(); ++k) {
      const TurningSpan& span = path_.spans[k];
      const double width = span.domain().hi;
      // Half the derivative of |p - p(0)|^2 by s: a minimum is where it goes from below 0 to above.
      const auto growth = [&](double x) {
        const Jet jet = span.jet(x);
        return (jet.position - path_.point.front()).dot(jet.first);
      };
      const double distance = (path_.point[k] - path_.point.front()).norm();
      has_left = has_left || distance > std::max(kLeft * size_, kLeftDrift * roll_.gap_allowed);
      const double at_start = growth(0);
      const double at_end = growth(width);
      // A minimum at the joint of two spans, where a corner makes the derivative jump.
      if (has_left && before < 0 && at_start >= 0 && is_back(path_.s[k], path_.point[k])) return lap_;
      if (has_left && at_start < 0 && at_end >= 0) {
        Interval range{0, width};
        // Bisection: 60 halvings of a span end at rounding.
        for (int step = 0; step < 60; ++step) (growth(range.middle()) < 0 ? range.lo : range.hi) = range.middle();
        const double x = range.middle();
        if (is_back(path_.s[k] + x, span.jet(x).position)) return lap_;
      }
      before = at_end;
    }
    // Still on the way back when the rows end.
    if (has_left && before < 0) return at_end();
    return std::nullopt;
  }

 private:
  /// Whether the path is back at its start at this place: near enough, and turned by whole turns, both within what
  /// drift allows. If so, `lap_` is the lap.
  bool is_back(double place, const Vec2& point) {
    const double from_start = (point - path_.point.front()).norm();
    if (from_start > roll_.gap_allowed) return false;
    lap_.length = place - start_;
    lap_.turn_gap = angle_at(place) - roll_.course.front().angle.front();
    lap_.turns = static_cast<int>(std::lround(lap_.turn_gap / kFullTurn));
    lap_.turn_gap = turn_beyond(lap_.turn_gap, lap_.turns);
    // At a corner the roll may stop anywhere within the pivot: its turn says nothing of the lap.
    const bool at_corner = roll_.runs.starts_at_corner || is_near_corner(place, roll_.gap_allowed);
    if (!at_corner && std::abs(lap_.turn_gap) > roll_.turn_allowed) return false;
    // What is left behind this place is within twice the drift: too little to lay over the beginning.
    const double rest = roll_.runs.length() - lap_.length;
    const bool ends_here = path_.gap().norm() <= roll_.gap_allowed && rest <= 2 * roll_.gap_allowed;
    if (ends_here) {
      end_here(lap_.length);
    } else {
      lap_.goes_on = true;
      lay_rows();
    }
    return true;
  }

  /// The roll stops just short of its start: the lap is as much longer.
  std::optional<Lap> at_end() {
    const double width = path_.spans.back().domain().hi;
    // How far the start lies ahead, along the last tangent.
    const double ahead = path_.gap().dot(path_.spans.back().velocity(width));
    if (ahead < 0 || path_.gap().norm() > roll_.gap_allowed || !is_back(path_.end(), path_.point.back()))
      return std::nullopt;
    end_here(path_.end() - start_ + ahead);
    return lap_;
  }

  /// All of the roll is the lap, unless its rows surely say that it ended elsewhere.
  void end_here(double nearest) {
    const double whole = roll_.runs.length();
    const bool is_whole = roll_.gap_sd == 0 || std::abs(nearest - whole) <= kSurelyElsewhere * roll_.gap_sd;
    lap_.length = is_whole ? whole : nearest;
    lap_.length_sd = roll_.gap_sd;
  }

  /// The nodes of the run that holds this place; at a corner the run that ends there.
  const TurningNodes& nodes_at(double place) const {
    for (const TurningNodes& nodes : roll_.course) {
      if (place <= nodes.s.back()) return nodes;
    }
    return roll_.course.back();
  }
  double angle_at(double place) const { return nodes_at(place).at(place); }  // Theta of the open course

  /// Whether a corner between two runs lies within this distance. The roll's ends do not count.
  bool is_near_corner(double place, double distance) const {
    const std::vector<TurningRun>& runs = roll_.runs.runs;
    return std::any_of(runs.begin() + 1, runs.end(),
                       [&](const TurningRun& run) { return std::abs(run.lo - place) <= distance; });
  }

  /// Gauss and Newton on the lap's length and the drift of its turn: rows of the second pass and on, less what the
  /// course was one lap before. Where both only turn evenly the place of the return decides, as known as it was.
  void lay_rows() {
    const double length_sd = roll_.gap_allowed / kAllowedDeviations;
    const double first_length = lap_.length;
    for (int round = 0; round < kLayRounds; ++round) {
      Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
      Eigen::Vector2d right = Eigen::Vector2d::Zero();
      std::size_t rows = 0;
      // `off` is the difference of two rows of the same noise: its variance is twice theirs.
      const double inverse = 1 / (2 * roll_.row_sd * roll_.row_sd);
      for (const TurningRun& run : roll_.runs.runs) {
        for (std::size_t k = 0; k < run.s.size(); ++k) {
          const double place = run.s[k] - lap_.length;
          // Rows of the first pass have none a lap before. Near a corner Theta jumps, and no slope says how `off`
          // depends on L.
          if (place < start_ || is_near_corner(place, length_sd) || is_near_corner(run.s[k], length_sd)) continue;
          const double off = turn_beyond(run.angle[k] - angle_at(place), lap_.turns);
          const Eigen::Vector2d by(1, -nodes_at(place).slope_at(place));  // of the drift, and of a longer lap
          normal += inverse * by * by.transpose();
          right += inverse * off * by;
          ++rows;
        }
      }
      rows += add_corners(normal, right);
      if (rows < kLeastOverlap) return;
      // What was known before: the drift has mean 0, and the length is that of the return. So the equations are regular
      // where all rows say the same of both unknowns, as on a circle.
      normal(0, 0) += 1 / std::max(roll_.turn_sd * roll_.turn_sd, roll_.row_sd * roll_.row_sd);
      normal(1, 1) += 1 / (length_sd * length_sd);
      right[1] -= (lap_.length - first_length) / (length_sd * length_sd);
      const Eigen::Vector2d step = normal.inverse() * right;
      if (!step.allFinite()) return;
      lap_.turn_gap = step[0];
      // No further from the return than drift allows.
      const double longest = kAllowedDeviations * length_sd;
      const double next = std::clamp(lap_.length + step[1], first_length - longest, first_length + longest);
      lap_.length_sd = std::sqrt(normal.inverse()(1, 1));
      const bool is_laid = std::abs(next - lap_.length) <= kLaid * lap_.length;
      lap_.length = next;
      if (is_laid) return;
    }
  }

  /// Adds corners of the second pass and on, less those of the first: each pair that lies a lap apart, within what
  /// drift allows, is an equation of L alone. Returns how many pairs there are.
  std::size_t add_corners(Eigen::Matrix2d& normal, Eigen::Vector2d& right) const {
    std::size_t count = 0;
    const std::vector<TurningRun>& runs = roll_.runs.runs;
    for (std::size_t later = 1; later < runs.size(); ++later) {
      for (std::size_t first = 1; first < later; ++first) {
        const double off = runs[later].lo - lap_.length - runs[first].lo;
        if (std::abs(off) > roll_.gap_allowed) continue;
        // A corner between two rows is anywhere between them alike: variance width^2 / 12.
        const double between = std::hypot(runs[later].lo_between, runs[first].lo_between) / std::sqrt(12.0);
        const double variance = 2 * roll_.corner_sd * roll_.corner_sd + between * between;
        normal(1, 1) += 1 / variance;
        right[1] += off / variance;
        ++count;
      }
    }
    return count;
  }

  const RoundRoll& roll_;
  TurningPath path_;  // of the open course, from (0, 0)
  double size_;       // diagonal of the box around it
  double start_;      // arc length where it starts
  Lap lap_;           // the one that was found
};

/// A run's rows by rising place.
TurningRun sorted(const TurningRun& run) {
  std::vector<std::size_t> order(run.s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return run.s[a] < run.s[b]; });
  TurningRun result{run.lo, run.hi, {}, {}, run.lo_between};
  for (const std::size_t k : order) {
    result.s.push_back(run.s[k]);
    result.angle.push_back(run.angle[k]);
    result.pass.push_back(run.pass[k]);
    result.ramp.push_back(run.ramp[k]);
  }
  return result;
}

}  // namespace

std::optional<Lap> find_lap(const RoundRoll& roll) { return LapFinder(roll).find(); }

TurningRuns lay_over(const TurningRuns& runs, const Lap& lap, bool exact,
                     const std::function<double(double)>& drift_share, double near_corner) {
  // The first lap, whose rows are all of pass 0.
  TurningRuns result = lap.length < runs.length() ? cut_at(runs, lap.length) : runs;
  const double start = runs.runs.front().lo;
  result.runs.back().hi = start + lap.length;
  for (TurningRun& run : result.runs) {
    run.pass.assign(run.s.size(), 0);
    for (const double s : run.s) run.ramp.push_back(drift_share(s - start));
  }
  if (exact || !lap.goes_on) return result;
  // Each row further on goes into the run of the first lap that holds its place, its turn less the whole turns rolled
  // since.
  for (const TurningRun& later : runs.runs) {
    for (std::size_t k = 0; k < later.s.size(); ++k) {
      const double rolled = later.s[k] - start;
      const int pass = static_cast<int>(std::floor(rolled / lap.length));
      if (pass < 1) continue;
      const double place = later.s[k] - pass * lap.length;
      for (TurningRun& run : result.runs) {
        // Near a corner a row may be of either side.
        const bool begins = &run == &result.runs.front();
        const bool ends = &run == &result.runs.back();
        if (place < run.lo + (begins ? 0 : near_corner) || place >= run.hi - (ends ? 0 : near_corner)) continue;
        run.s.push_back(place);
        run.angle.push_back(later.angle[k] - kFullTurn * lap.turns * pass);
        run.pass.push_back(pass);
        run.ramp.push_back(drift_share(rolled));
        break;
      }
    }
  }
  for (TurningRun& run : result.runs) run = sorted(run);
  return result;
}

}  // namespace rollfix::teaching
