#include "march/pairs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>

#include "rollfix/turning_function.hpp"

// Notation (section 3.1; docs/march.md, "Partition")
//   phi_k(s)    total curvature of the segment of length L_k from s on: `phi(0)` and `phi(1)` are phi_1 and phi_2 of
//               finger a, phi_3 and phi_4 of finger b
//   a_i, b_j    stationary points of both phi of finger a, of finger b: `points`
//   trend       sign of phi' on an interval between two of them
// Idea: eq. (6), solved by the march of section 2, gives the stationary points; one round with the segments' ends in
// place gives all phi at them. On each interval both phi are monotone.

namespace rollfix::march {

namespace {

/// A phi, the difference of two sums, is what it should be to so much of them.
constexpr double kSumRounding = 2.5e-16;
/// Halvings that exhaust a double, and Newton steps besides.
constexpr int kMostHalvings = 200;

}  // namespace

Start::Start(const Walker& start, const Segments& segments)
    : segments_(&segments), tally_(start.tally()), start_(start), ends_{start, start} {}

/// A copy of the start whose own work, and that of its three endpoints, is counted by `tally`.
Start Start::counted_by(Tally& tally) const {
  Start copy = *this;
  copy.tally_ = &tally;
  copy.start_ = start_.counted_by(tally);
  for (std::size_t k = 0; k < 2; ++k) copy.ends_[k] = ends_[k].counted_by(tally);
  return copy;
}

/// s, s + L_1 and s + L_2 together; all sums go on without regard to loops.
void Start::move_to(double s) {
  start_.move_to_length(s);
  for (std::size_t k = 0; k < 2; ++k) ends_[k].move_to_length(s + segments_->length[k]);
}

/// All three by the same small arc length, without quadrature.
void Start::nudge(double by) {
  start_.nudge(by);
  for (Walker& end : ends_) end.nudge(by);
}

/// Net steps of the three endpoints between here and there, each counted without regard to direction.
long Start::steps_since(const Start& before) const {
  long steps = std::labs(start_.net_steps() - before.start_.net_steps());
  for (std::size_t k = 0; k < 2; ++k) steps += std::labs(ends_[k].net_steps() - before.ends_[k].net_steps());
  return steps;
}

/// The steps between here and there count once, however often the landing went to and fro over them.
void Start::become(const Start& landed, const Tally& spent) {
  tally_->steps += static_cast<std::size_t>(landed.steps_since(*this));
  tally_->refinements += spent.refinements + spent.steps;
  Tally& own = *tally_;
  *this = landed.counted_by(own);
}

bool Start::move_to_value(std::size_t k, double target, int sign, double stop) {
  // > 0: sign * phi_k has not reached the target yet.
  const auto shortfall = [&](const Start& at) { return sign * (target - at.phi(k)); };
  double gap = shortfall(*this);
  if (gap <= 0) return true;
  if (s() == stop) return false;
  ++tally_->landings;
  // s moves towards `stop`; on the way sign * phi_k grows, by REQUIRES.
  const int direction = stop < s() ? -1 : 1;
  const auto nearer = [&](double one, double two) { return direction * (one - two) < 0 ? one : two; };
  // A gap below this is what rounding leaves in phi, a difference of two sums: Newton cannot better it.
  const double rounding = kSumRounding * (std::fabs(start_.integral()) + std::fabs(ends_[k].integral()) + 1);

  // Step by step until the target is passed; then Newton's iteration, safeguarded by halving, between the last two.
  // At each turn `*this` falls short of the target, `passed` (if set) is beyond it, and `trial` is the last place
  // tried.
  Start trial = *this;
  std::optional<double> passed;
  for (int i = 0; i < kMostHalvings || !passed; ++i) {
    // of sign * phi_k per length of the way; 0 at a stationary point, where Newton's step does not tell
    const double growth = sign * direction * trial.slope(k);
    const double newton = trial.s() + direction * gap / growth;
    const double step = trial.start_.position().step.length;
    double next = newton;
    if (!passed) {
      // Until the target is passed, one step of the parameter at most, and not beyond `stop`.
      const double furthest = nearer(s() + direction * step, stop);
      if (!(growth > 0) || direction * (newton - furthest) > 0) next = furthest;
      // Newton's place is outside the bracket, or not a number: its middle.
    } else if (!(direction * (newton - s()) > 0 && direction * (*passed - newton) > 0)) {
      next = s() + 0.5 * (*passed - s());
    }
    if (next == s() || next == passed) return true;  // nothing is left between the two
    Tally spent;
    trial = trial.counted_by(spent);
    trial.move_to(next);
    gap = shortfall(trial);
    const double correction = direction * gap / (sign * direction * trial.slope(k));
    // As in path.cpp: a correction this small leaves its square, and needs no quadrature; but it must not leave the
    // way.
    const bool small = std::fabs(correction) <= kLastCorrection * step;
    const bool inside = direction * (stop - (next + correction)) >= 0 && direction * (next + correction - s()) >= 0;
    if (small && inside) trial.nudge(correction);
    if ((small && inside) || std::fabs(gap) <= rounding) {
      become(trial, spent);
      return true;
    }
    if (gap < 0) {
      // Beyond the target: only the far end of the bracket, the start itself stays short.
      passed = next;
      tally_->refinements += spent.refinements + spent.steps;
    } else {
      become(trial, spent);
      if (next == stop) return false;
    }
  }
  return true;
}

namespace {

/// Stationary points that are closer than this part of P are one: in between a phi changes by its square, which is a
/// rounding error.
constexpr double kSamePoint = 1e-9;

/// Eq. (6) for the total curvature of a roll by `length`, with the reason in the words of section 3.
Result stationary_points(const March& march, double length) {
  try {
    return march.segments(length, 0);
  } catch (const Refusal& refusal) {
    if (refusal.reason() != Reason::continuum) throw;
    throw Refusal(Reason::continuum, refusal.where(),
                  fmt::format("march: expected a total curvature with isolated stationary points, found that of a roll "
                              "by {:.17g} (without whole loops) to be constant from s = {:.17g} on; rollfix::locate "
                              "handles it",
                              length, refusal.where()));
  }
}

/// The stationary points of one phi, and both ends of what the march doubts.
void add_stationary_points(const PartitionTools& tools, double length, Partition& partition, PairSteps& steps) {
  const Result level = stationary_points(tools.march, length);
  steps.stationary += level.steps.start + level.steps.marching + level.steps.bisection;
  steps.landings += level.steps.landings;
  steps.refinements += level.steps.refinements;
  for (const Segment& segment : level.segments) partition.points.push_back(segment.start);
  for (const Doubt& doubt : level.doubts) {
    // Both ends become points, so that the doubtful stretch is an interval of its own.
    const double lo = wrap(doubt.where.lo, tools.perimeter).base;
    partition.doubts.push_back({lo, lo + doubt.where.width()});
    partition.points.push_back(lo);
    partition.points.push_back(wrap(doubt.where.hi, tools.perimeter).base);
  }
}

/// In order, each once.
void merge(Partition& partition, double perimeter) {
  std::vector<double>& points = partition.points;
  std::sort(points.begin(), points.end());
  const std::size_t all = points.size();
  const auto same = [&](double one, double two) { return two - one <= kSamePoint * perimeter; };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  // The last point may be the first one, seen from the other side of s = 0.
  while (points.size() > 1 && points.front() + perimeter - points.back() <= kSamePoint * perimeter) points.pop_back();
  partition.merged = all - points.size();
}

/// s = 0 with both ends of the segments in place.
Start first_start(const Path& path, const Segments& segments, Tally& tally) {
  Start start(Walker(path, first_position(path), tally), segments);
  start.move_to(0);
  return start;
}

/// Sign of phi_1' and of phi_2' (or phi_3', phi_4') at a place.
std::array<int, 2> trends(const Start& at) { return {at.slope(0) < 0 ? -1 : 1, at.slope(1) < 0 ? -1 : 1}; }

}  // namespace

Partition divide(const PartitionTools& tools, const Segments& segments, Tally& evaluation, PairSteps& steps) {
  Partition partition;
  for (const double length : segments.length) add_stationary_points(tools, length, partition, steps);
  merge(partition, tools.perimeter);

  // One round. The slope half-way tells the trend also where the values at both ends differ by rounding only.
  // Without any point there is no interval: `intervals` stays empty.
  std::vector<double> ends = partition.points;
  if (!ends.empty()) ends.push_back(ends.front() + tools.perimeter);
  Start at = first_start(tools.path, segments, evaluation);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (i > 0) {
      at.move_to(0.5 * (ends[i - 1] + ends[i]));
      // phi' has one sign between two neighbouring stationary points: its sign half-way is that of the interval.
      partition.intervals.back().trend = trends(at);
    }
    // The end of interval i - 1 and the beginning of interval i: moved to once, copied to both.
    at.move_to(ends[i]);
    if (i > 0) partition.intervals.back().hi = at;
    if (i + 1 < ends.size()) partition.intervals.push_back({at, at, {}});
  }
  return partition;
}

}  // namespace rollfix::march
