#include "teach/teaching.hpp"

#include <fmt/format.h>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "work/pulse.hpp"

// Notation:
//   (s_k, theta_k)  rows; a run's between two corners: TurningRun; rows at one place: Stop
//   Theta(s)        between nodes the cubic of both values and slopes: `cubic`; p(s), the integral of its direction:
//                   `path_of`
//   g               the path's gap, end to start; T, N: tangent and normal along it
//   w               two weights: Theta changes by w . N, so that the end moves by M w, M the integral of N N^T: `moves`
// Follows docs/teach.md, "What is made of the rows" and "Closing".
// Idea: a corner is where rows turn at one place, or by so much from one to the next. The least change of Theta in the
// mean square that closes the path is a combination of the gap's derivatives by Theta, which N is: Newton's method on
// w.
namespace rollfix::teaching {
namespace {

/// Beside a corner that is spread over two steps, the steps turn by less than this share of it.
constexpr double kQuietShare = 0.25;
/// A row may be this many limits behind the ones before: noise, and not a way back.
constexpr double kMostBack = 3;

/// Rows at one place.
struct Stop {
  double s = 0;           // mean place
  double first = 0;       // Theta of the first of these rows, radians
  double last = 0;        // Theta of the last one
  double mean = 0;        // mean Theta of all of them
  bool is_pivot = false;  // Theta changes here while s does not: a corner
};

/// Rows whose places differ by no more than `limits.length` from the first of them, made one stop each. `readings`: in
/// the direction of growing length. Throws InputError when a length falls behind the farthest one by more than
/// kMostBack limits.
std::vector<Stop> stops_of(const std::vector<Reading>& readings, const PivotLimits& limits) {
  const double limit = limits.length;
  std::vector<Stop> stops;
  // Invariant: each turn of the outer loop takes all rows of one stop, so that k grows by at least 1.
  double farthest = readings.front().length[0];
  for (std::size_t k = 0; k < readings.size();) {
    const double start = readings[k].length[0];
    Stop stop{0, readings[k].turn, readings[k].turn, 0, false};
    std::size_t count = 0;
    for (; k < readings.size() && readings[k].length[0] - start <= limit; ++k, ++count) {
      if (readings[k].length[0] < farthest - kMostBack * limit) {
        throw InputError(
            fmt::format("expected a roll that goes one way round, found that it goes back from length {:.9g} to {:.9g}",
                        farthest, readings[k].length[0]));
      }
      farthest = std::max(farthest, readings[k].length[0]);
      stop.s += readings[k].length[0];
      stop.mean += readings[k].turn;
      stop.last = readings[k].turn;
    }
    // Means: within a stop the order of the rows says nothing about the place.
    stop.s /= static_cast<double>(count);
    stop.mean /= static_cast<double>(count);
    stop.is_pivot = count > 1 && std::abs(stop.last - stop.first) >= limits.turn;
    // Means that noise has swapped: the places of stops have to rise strictly.
    if (!stops.empty() && !(stop.s > stops.back().s)) continue;
    stops.push_back(stop);
  }
  return stops;
}

/// Noise spreads a pivot's rows over twice the limit: what lies nearer to a pivot is part of it.
std::vector<Stop> with_whole_pivots(const std::vector<Stop>& stops, double limit) {
  std::vector<Stop> whole;
  for (const Stop& stop : stops) {
    // Far from the stop before, or neither of both turns at its place: a stop of its own.
    if (whole.empty() || stop.s - whole.back().s > 2 * limit || !(stop.is_pivot || whole.back().is_pivot)) {
      whole.push_back(stop);
      continue;
    }
    Stop& pivot = whole.back();
    const double before = pivot.is_pivot ? std::abs(pivot.last - pivot.first) : 0;
    const double after = stop.is_pivot ? std::abs(stop.last - stop.first) : 0;
    // The corner's place: the mean of both, weighted by how far each of them turns; of a pivot forth and back its own.
    if (before + after > 0) pivot.s = (before * pivot.s + after * stop.s) / (before + after);
    pivot.last = stop.last;
    pivot.is_pivot = true;
  }
  return whole;
}

/// Cuts stops into runs at the corners. A corner is a pivot, a step of at least `corner_angle_` between neighbouring
/// stops, or a single row in the middle of a pivot.
class Cutter {
 public:
  Cutter(std::vector<Stop> stops, double corner_angle) : stops_(std::move(stops)), corner_angle_(corner_angle) {}

  /// The runs, each with at least one row. Invariant of the loop: all stops before k are in runs, and the last run is
  /// open: its `hi` is set when the next one starts, or at the end.
  TurningRuns cut() {
    result_.runs.push_back({stops_.front().s, 0, {}, {}});
    for (std::size_t k = 0; k < stops_.size(); ++k) {
      const Stop& stop = stops_[k];
      if (stop.is_pivot || is_single_pivot(k)) {
        pivot(k);
        continue;
      }
      // After a pivot the step to the next row is part of that corner already.
      const bool jumps = k > 0 && !last_was_pivot_ && std::abs(stop.first - stops_[k - 1].last) >= corner_angle_;
      if (jumps) {
        // The rows do not say where between them the corner is: the middle, and `lo_between` keeps how uncertain that
        // is.
        start_run(0.5 * (stops_[k - 1].s + stop.s));
        result_.runs.back().lo_between = stop.s - stops_[k - 1].s;
      }
      result_.runs.back().s.push_back(stop.s);
      result_.runs.back().angle.push_back(stop.mean);
      last_was_pivot_ = false;
    }
    if (!result_.ends_at_corner) result_.runs.back().hi = stops_.back().s;
    return std::move(result_);
  }

 private:
  /// How far Theta turns from stop k to the next one, radians, without its sign.
  double step(std::size_t k) const { return std::abs(stops_[k + 1].first - stops_[k].last); }

  /// Whether stop k is the only row that was taken during a pivot. Then the corner's turn is spread over the two steps
  /// beside it, of which neither reaches `corner_angle_` alone, and the steps beyond these are small. On a smooth bend
  /// those would be about as large.
  bool is_single_pivot(std::size_t k) const {
    if (k < 2 || k + 2 >= stops_.size() || stops_[k - 1].is_pivot || stops_[k + 1].is_pivot) return false;
    const double turn = std::abs(stops_[k + 1].first - stops_[k - 1].last);
    const double quiet = kQuietShare * turn;
    const bool in_one_step = step(k - 1) >= corner_angle_ || step(k) >= corner_angle_;
    return turn >= corner_angle_ && !in_one_step && step(k - 1) > quiet && step(k) > quiet && step(k - 2) < quiet &&
           step(k + 1) < quiet;
  }

  /// Ends the run before the corner at stop k and begins the next one. The first and the last stop have no run on one
  /// side: the roll starts, or ends, on the corner.
  void pivot(std::size_t k) {
    const Stop& stop = stops_[k];
    if (k == 0) {
      result_.starts_at_corner = true;
    } else if (k + 1 == stops_.size()) {
      fill(stop.first);
      result_.ends_at_corner = true;
      result_.runs.back().hi = stop.s;
    } else {
      fill(stop.first);
      start_run(stop.s);
    }
    pivot_end_ = stop.last;
    last_was_pivot_ = true;
  }

  /// A run between two corners without a row of its own gets one: the mean of the direction in which the first pivot
  /// ends and `next`, in which the second one begins. So no run is empty.
  void fill(double next) {
    TurningRun& run = result_.runs.back();
    if (!run.s.empty()) return;
    run.s.push_back(run.lo);
    run.angle.push_back(0.5 * (pivot_end_ + next));
  }

  /// Ends the last run at s and begins one there.
  void start_run(double s) {
    result_.runs.back().hi = s;
    result_.runs.push_back({s, 0, {}, {}});
  }

  std::vector<Stop> stops_;
  double corner_angle_;
  TurningRuns result_;
  bool last_was_pivot_ = false;  // the stop before was a corner by itself
  double pivot_end_ = 0;         // Theta at the end of the last pivot, radians
};

/// A gap below this share of the length is closed: rounding.
constexpr double kClosed = 1e-14;
/// The steps of Newton's method, at most. Beyond that the course stays open.
constexpr int kNewtonRounds = 50;
/// Changes of Theta beyond this are no correction any more, radians.
constexpr double kMostCorrection = 1;

/// Adds the cubic over [0, width], starting at s, to the path's end. It is halved until each piece turns by no more
/// than kMostSpanTurn, for which TurningSpan's quadrature is exact.
void add_spans(TurningPath& path, double s, TurningSpan::Cubic cubic, double width) {
  if (span_turn(cubic, width) > kMostSpanTurn) {
    const double half = 0.5 * width;
    // The same cubic by powers of the length from its middle on (Taylor's expansion there).
    const double value = cubic[0] + half * (cubic[1] + half * (cubic[2] + half * cubic[3]));
    const double slope = cubic[1] + half * (2 * cubic[2] + half * 3 * cubic[3]);
    add_spans(path, s, cubic, half);
    add_spans(path, s + half, {value, slope, cubic[2] + 3 * half * cubic[3], cubic[3]}, width - half);
    return;
  }
  path.spans.emplace_back(path.point.back(), cubic, width);
  path.s.push_back(s);
  path.point.push_back(path.spans.back().jet(width).position);
}

}  // namespace

TurningRuns turning_runs(const std::vector<Reading>& readings, const PivotLimits& limits) {
  std::vector<Stop> stops = with_whole_pivots(stops_of(readings, limits), limits.length);
  const bool all_in_pivots = std::all_of(stops.begin(), stops.end(), [](const Stop& stop) { return stop.is_pivot; });
  if (stops.size() < 2 || (all_in_pivots && stops.size() < 3)) {
    throw InputError(fmt::format("expected a roll around a part, found {} different place{}", stops.size(),
                                 stops.size() == 1 ? "" : "s"));
  }
  return Cutter(std::move(stops), limits.corner_angle).cut();
}

TurningRuns cut_at(const TurningRuns& runs, double length) {
  TurningRuns result = runs;
  result.runs.clear();
  // `length` counts from the roll's start, which need not be at s = 0.
  const double end = runs.runs.front().lo + length;
  for (const TurningRun& run : runs.runs) {
    if (!result.runs.empty() && run.lo >= end) break;
    TurningRun kept{run.lo, std::min(run.hi, end), {}, {}, run.lo_between};
    for (std::size_t k = 0; k < run.s.size(); ++k) {
      if (run.s[k] > end) break;
      kept.s.push_back(run.s[k]);
      kept.angle.push_back(run.angle[k]);
    }
    // A run whose rows all lie behind the cut: the run before it is stretched to the end instead.
    if (kept.s.empty()) break;
    result.runs.push_back(std::move(kept));
  }
  const bool goes_on = end < runs.runs.back().hi;
  result.runs.back().hi = end;
  // Cut within the roll: the corner at its old end is not part of the result.
  if (goes_on) result.ends_at_corner = false;
  return result;
}

TurningSpan::Cubic TurningNodes::cubic(std::size_t k) const {
  const double width = s[k + 1] - s[k];
  // Hermite's cubic: values and slopes at both nodes determine it.
  const double chord = (angle[k + 1] - angle[k]) / width;
  return {angle[k], slope[k], (3 * chord - 2 * slope[k] - slope[k + 1]) / width,
          (slope[k] + slope[k + 1] - 2 * chord) / (width * width)};
}

std::size_t TurningNodes::cubic_at(double place) const {
  // Searched between the second node and the last but one, so that places beyond the ends get the outer cubics.
  const auto after = std::upper_bound(s.begin() + 1, s.end() - 1, place);
  return static_cast<std::size_t>(after - s.begin()) - 1;
}

void TurningNodes::add(double place, const Vec2& value_and_slope) {
  s.push_back(place);
  angle.push_back(value_and_slope.x());
  slope.push_back(value_and_slope.y());
}

/// Theta at a place, radians; beyond the ends the outer cubic is continued.
double TurningNodes::at(double place) const {
  const std::size_t k = cubic_at(place);
  const TurningSpan::Cubic c = cubic(k);
  const double x = place - s[k];
  return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}

/// Curvature at a place, the derivative of `at`.
double TurningNodes::slope_at(double place) const {
  const std::size_t k = cubic_at(place);
  const TurningSpan::Cubic c = cubic(k);
  const double x = place - s[k];
  return c[1] + x * (2 * c[2] + x * 3 * c[3]);
}

double TurningPath::size() const {
  Vec2 least = point.front();
  Vec2 most = point.front();
  for (const Vec2& each : point) {
    least = least.cwiseMin(each);
    most = most.cwiseMax(each);
  }
  return (most - least).norm();
}

/// The integral of (cos Theta, sin Theta) from `start` on: at unit speed, so that s is its arc length. At corners Theta
/// jumps and the point stays.
TurningPath path_of(const TurningCourse& course, const Vec2& start) {
  TurningPath path;
  path.point.push_back(start);
  for (const TurningNodes& nodes : course) {
    for (std::size_t k = 0; k + 1 < nodes.s.size(); ++k) {
      add_spans(path, nodes.s[k], nodes.cubic(k), nodes.s[k + 1] - nodes.s[k]);
    }
  }
  return path;
}

void split_at(TurningNodes& nodes, double place) {
  const auto after = std::upper_bound(nodes.s.begin(), nodes.s.end(), place);
  // Before the first node, at or behind the last one, or at a node already: nothing to split.
  if (after == nodes.s.begin() || after == nodes.s.end() || *(after - 1) == place) return;
  const auto k = after - nodes.s.begin() - 1;
  const TurningSpan::Cubic c = nodes.cubic(static_cast<std::size_t>(k));
  const double x = place - nodes.s[static_cast<std::size_t>(k)];
  // Value and slope of the cubic there: Hermite's cubics on both sides are then the same polynomial as before.
  nodes.s.insert(nodes.s.begin() + k + 1, place);
  nodes.angle.insert(nodes.angle.begin() + k + 1, c[0] + x * (c[1] + x * (c[2] + x * c[3])));
  nodes.slope.insert(nodes.slope.begin() + k + 1, c[1] + x * (2 * c[2] + x * 3 * c[3]));
}

Closure close_gap(TurningCourse& course) {
  // Changes are made to this, not added up: Theta = original + w . N(original) in each round.
  const TurningCourse original = course;
  Eigen::Vector2d weights(0, 0);
  Closure closure;
  for (int round = 0; round < kNewtonRounds; ++round) {
    // One round of Newton's method on w: the gap of the course with the present w, and its derivative M.
    beat();
    const TurningPath path = path_of(course, Vec2::Zero());
    const double length = path.end() - path.s.front();
    const Vec2 gap = path.gap();
    // Relative to the length, because the rounding errors of positions grow with it.
    closure.closed = gap.norm() <= kClosed * length;
    if (closure.closed) break;
    // The end moves by the integral of the change times the normal, and the change is the normal times the weights.
    Eigen::Matrix2d moves = Eigen::Matrix2d::Zero();
    for (const TurningSpan& span : path.spans) {
      const double width = span.domain().hi;
      for (const double share : {0.0, 0.5, 1.0}) {  // Simpson's rule
        const Vec2 tangent = span.velocity(share * width);
        const Vec2 normal(-tangent.y(), tangent.x());
        moves += (share == 0.5 ? 4.0 : 1.0) * width / 6 * normal * normal.transpose();
      }
    }
    // On a straight course M has rank 1: a small change of Theta moves the end only across the course. Then the inverse
    // is not finite, and the course stays open.
    const Eigen::Vector2d step = moves.inverse() * gap;
    if (!step.allFinite() || (weights + step).norm() > kMostCorrection) return closure;
    weights += step;
    closure.correction = weights.norm();
    for (std::size_t run = 0; run < course.size(); ++run) {
      for (std::size_t k = 0; k < course[run].s.size(); ++k) {
        const double angle = original[run].angle[k];
        // w . N with N = (-sin Theta, cos Theta), and its derivative by Theta: the slope changes by the chain rule.
        const double change = -weights.x() * std::sin(angle) + weights.y() * std::cos(angle);
        const double rate = -weights.x() * std::cos(angle) - weights.y() * std::sin(angle);
        course[run].angle[k] = angle + change;
        course[run].slope[k] = original[run].slope[k] * (1 + rate);
      }
    }
  }
  return closure;
}

}  // namespace rollfix::teaching
