#include "teach/turning_course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rollfix/error.hpp"

namespace rollfix {

namespace {

/// Rows at one place that turn by less than this are a bend seen closely, or noise: 6 degrees.
constexpr double kLeastPivot = 0.1;
/// Beside a corner that is spread over two steps, the steps turn by less than this share of it.
constexpr double kQuietShare = 0.25;
/// A row may be this many limits behind the ones before: noise, and not a way back.
constexpr double kMostBack = 3;

/// Rows at one place.
struct Stop {
  double s = 0;
  double first = 0;  // angles
  double last = 0;
  double mean = 0;
  bool is_pivot = false;
};

std::vector<Stop> stops_of(const std::vector<Reading>& readings, double limit) {
  std::vector<Stop> stops;
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
    stop.s /= static_cast<double>(count);
    stop.mean /= static_cast<double>(count);
    stop.is_pivot = count > 1 && std::abs(stop.last - stop.first) >= kLeastPivot;
    if (!stops.empty() && !(stop.s > stops.back().s)) continue;  // averages that noise has swapped
    stops.push_back(stop);
  }
  return stops;
}

/// Noise spreads a pivot's rows over twice the limit: what lies nearer to a pivot is part of it.
std::vector<Stop> with_whole_pivots(const std::vector<Stop>& stops, double limit) {
  std::vector<Stop> whole;
  for (const Stop& stop : stops) {
    if (whole.empty() || stop.s - whole.back().s > 2 * limit || !(stop.is_pivot || whole.back().is_pivot)) {
      whole.push_back(stop);
      continue;
    }
    Stop& pivot = whole.back();
    const double before = pivot.is_pivot ? std::abs(pivot.last - pivot.first) : 0;
    const double after = stop.is_pivot ? std::abs(stop.last - stop.first) : 0;
    pivot.s = (before * pivot.s + after * stop.s) / (before + after);
    pivot.last = stop.last;
    pivot.is_pivot = true;
  }
  return whole;
}

class Cutter {
 public:
  Cutter(std::vector<Stop> stops, double corner_angle) : stops_(std::move(stops)), corner_angle_(corner_angle) {}

  TurningRuns cut() {
    result_.runs.push_back({stops_.front().s, 0, {}, {}});
    for (std::size_t k = 0; k < stops_.size(); ++k) {
      const Stop& stop = stops_[k];
      if (stop.is_pivot || is_single_pivot(k)) {
        pivot(k);
        continue;
      }
      const bool jumps = k > 0 && !last_was_pivot_ && std::abs(stop.first - stops_[k - 1].last) >= corner_angle_;
      if (jumps) {
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
  double step(std::size_t k) const { return std::abs(stops_[k + 1].first - stops_[k].last); }

  /// A row within a pivot, the only one: the turn is spread over the two steps beside it.
  bool is_single_pivot(std::size_t k) const {
    if (k < 2 || k + 2 >= stops_.size() || stops_[k - 1].is_pivot || stops_[k + 1].is_pivot) return false;
    const double turn = std::abs(stops_[k + 1].first - stops_[k - 1].last);
    const double quiet = kQuietShare * turn;
    const bool in_one_step = step(k - 1) >= corner_angle_ || step(k) >= corner_angle_;
    return turn >= corner_angle_ && !in_one_step && step(k - 1) > quiet && step(k) > quiet && step(k - 2) < quiet &&
           step(k + 1) < quiet;
  }

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

  /// A run between two corners without a row of its own has the direction between the pivots.
  void fill(double next) {
    TurningRun& run = result_.runs.back();
    if (!run.s.empty()) return;
    run.s.push_back(run.lo);
    run.angle.push_back(0.5 * (pivot_end_ + next));
  }

  void start_run(double s) {
    result_.runs.back().hi = s;
    result_.runs.push_back({s, 0, {}, {}});
  }

  std::vector<Stop> stops_;
  double corner_angle_;
  TurningRuns result_;
  bool last_was_pivot_ = false;
  double pivot_end_ = 0;
};

}  // namespace

TurningRuns turning_runs(const std::vector<Reading>& readings, const PivotLimits& limits) {
  std::vector<Stop> stops = with_whole_pivots(stops_of(readings, limits.length), limits.length);
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
  const double end = runs.runs.front().lo + length;
  for (const TurningRun& run : runs.runs) {
    if (!result.runs.empty() && run.lo >= end) break;
    TurningRun kept{run.lo, std::min(run.hi, end), {}, {}, run.lo_between};
    for (std::size_t k = 0; k < run.s.size(); ++k) {
      if (run.s[k] > end) break;
      kept.s.push_back(run.s[k]);
      kept.angle.push_back(run.angle[k]);
    }
    if (kept.s.empty()) break;
    result.runs.push_back(std::move(kept));
  }
  const bool goes_on = end < runs.runs.back().hi;
  result.runs.back().hi = end;
  if (goes_on) result.ends_at_corner = false;
  return result;
}

}  // namespace rollfix
