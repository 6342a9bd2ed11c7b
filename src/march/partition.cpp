#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "march/pairs.hpp"
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
                              "by {:.17g} (without whole loops) to be constant from s = {:.17g} "
                              "on; rollfix::locate handles it",
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

// ---- correspondence
// Notation (section 3.2, Figures 5 and 6)
//   phi_1, phi_2    of s, finger a: `at.a.phi(0)`, `at.a.phi(1)`
//   phi_3, phi_4    of t, finger b: `at.b.phi(0)`, `at.b.phi(1)`
//   theta_1, _2     right sides of (8) and (9): `problem.theta[0]`, `[1]`
//   x, y; w, z      ends of the stretch of s, and of t, on which (8) gives each s one t: `begin`, `end`
//   x_i, w_i        the iteration of Figure 6: `at`
//   trend_2, _4     +1 where phi_2 (phi_4) grows along the stretch, else -1
// Idea: (8) holds again after each move. Where phi_2 and phi_4 go opposite ways, phi_2(s) - phi_4(t) is monotone:
// bisection. Else one start moves until (9) holds, the other until (8) does, and so on to the limit.

/// (8) solved for s: phi_1(s) = phi_3(t) + theta_1. phi_1 grows along the way, so that sign = 1 is right whatever the
/// trend of phi_1 by s.
void Correspondence::follow_with_s(StartsOfBoth& at) const {
  at.a.move_to_value(0, at.b.phi(0) + at.problem->theta[0], 1, y());
}

/// (8) solved for t: phi_3(t) = phi_1(s) - theta_1.
void Correspondence::follow_with_t(StartsOfBoth& at) const {
  at.b.move_to_value(0, at.a.phi(0) - at.problem->theta[0], 1, z());
}

void Correspondence::move_s_to(StartsOfBoth& at, double s) const {
  at.a.move_to(s);
  follow_with_t(at);
}

void Correspondence::move_t_to(StartsOfBoth& at, double t) const {
  at.b.move_to(t);
  follow_with_s(at);
}

/// (8) differentiated: phi_1' ds = phi_3' dt. The larger of ds and dt is put to 1, so that a stationary point of one
/// phi (its slope 0) gives no division by zero; where both slopes are 0, both move alike.
Correspondence::Rates Correspondence::rates(const StartsOfBoth& at) const {
  const double one = std::fabs(at.a.slope(0));
  const double three = std::fabs(at.b.slope(0));
  Rates rates;
  rates.ds = one <= three ? 1 : three / one;
  rates.dt = one > three ? 1 : (three > 0 ? one / three : 1);
  rates.phi_2 = std::fabs(at.a.slope(1)) * rates.ds;
  rates.phi_4 = std::fabs(at.b.slope(1)) * rates.dt;
  return rates;
}

/// With equal trends, trend_2 (F' - G') of docs/march.md, "Which of s and t moves first", but per length and not per v.
double Correspondence::slope(const StartsOfBoth& at) const {
  const Rates along = rates(at);
  return trend_2 * along.phi_2 - trend_4 * along.phi_4;
}

/// Whatever the trends, phi_1 grows from the bottom of the interval of s to its top, and phi_3 likewise. Below, the
/// correspondence begins at the higher of both bottoms, and the other start goes up to it; above, it ends at the lower
/// of both tops, and the other start comes down to it: two cases at each end, and two trends of each phi, are sixteen.
std::optional<Correspondence> correspond(const MonotoneInterval& i, const MonotoneInterval& j,
                                         const PairProblem& problem, Tally& tally) {
  const double theta = problem.theta[0];
  const double lowest_1 = i.bottom().phi(0);
  const double highest_1 = i.top().phi(0);
  const double lowest_3 = j.bottom().phi(0) + theta;
  const double highest_3 = j.top().phi(0) + theta;
  // I_i and J_j have nothing in common. The rounding keeps pairs at which they only touch.
  if (std::max(lowest_1, lowest_3) > std::min(highest_1, highest_3) + problem.rounding) return std::nullopt;

  const StartsOfBoth bottoms = StartsOfBoth{i.bottom(), j.bottom(), &problem}.counted_by(tally);
  const StartsOfBoth tops = StartsOfBoth{i.top(), j.top(), &problem}.counted_by(tally);
  Correspondence found{bottoms, tops, i.second_along_first(), j.second_along_first()};
  if (lowest_1 > lowest_3) {
    found.begin.b.move_to_value(0, lowest_1 - theta, 1, tops.b.s());  // Figure 5: x is an end, t goes up to w
  } else {
    found.begin.a.move_to_value(0, lowest_3, 1, tops.a.s());
  }
  if (highest_1 > highest_3) {
    found.end.a.move_to_value(0, highest_3, -1, bottoms.a.s());  // Figure 5: z is an end, s comes down to y
  } else {
    found.end.b.move_to_value(0, highest_1 - theta, -1, bottoms.b.s());
  }
  return found;
}

namespace {

/// What is left of a start's way: it can only shrink, so that rounding errors of the other start, which are large near
/// its stationary points, can't keep the halving going for ever.
struct Left {
  /// The pair is known to lie between `low` and `high`, seen in `direction`.
  double low = 0;
  double high = 0;
  int direction = 1;

  Left(double from, double to) : low(from), high(to), direction(to < from ? -1 : 1) {}

  double width() const { return std::fmax(0.0, direction * (high - low)); }
  double middle() const { return low + 0.5 * (high - low); }
  void lower(double place) { low = place; }
  void upper(double place) {
    if (direction * (place - high) < 0) high = place;
  }
};

}  // namespace

BisectedPair bisect(const Correspondence& way, double tolerance, Tally& tally) {
  // At each turn: the pair lies beyond `low`, (8) holds at `low`, and (9)'s excess has the sign `side` there.
  StartsOfBoth low = way.begin.counted_by(tally);
  const int side = side_of(low.excess(1));
  Left s(way.x(), way.y());
  Left t(way.w(), way.z());
  BisectedPair result{low, 0};
  while (s.width() > tolerance || t.width() > tolerance) {
    result.at = low;
    ++result.iterations;
    // Halving s alone would leave t undetermined where phi_3 is level, and the other way round.
    if (s.width() >= t.width()) {
      way.move_s_to(result.at, s.middle());
    } else {
      way.move_t_to(result.at, t.middle());
    }
    if (side_of(result.at.excess(1)) == side) {
      low = result.at;
      s.lower(low.a.s());
      t.lower(low.b.s());
    } else {
      s.upper(result.at.a.s());
      t.upper(result.at.b.s());
    }
  }
  return result;
}

namespace {

/// s moves to where phi_2(x_{i+1}) = phi_4(w_i) + theta_2, and t follows by (8). False: y comes first.
bool round_with_s_first(StartsOfBoth& at, const Correspondence& way) {
  // s comes to where F(v_{i+1}) = G(v_i).
  const double target = at.b.phi(1) + at.problem->theta[1];
  // F is below the target even at y: no pair is left. See docs/march.md, "Which of s and t moves first".
  if (way.trend_2 * (target - way.end.a.phi(1)) > 0) return false;  // no need to go and see
  if (!at.a.move_to_value(1, target, way.trend_2, way.y())) return false;
  way.follow_with_t(at);
  return true;
}

/// Figure 6 as printed: t moves to where phi_4(w_{i+1}) + theta_2 = phi_2(x_i), and s follows by (8).
bool round_with_t_first(StartsOfBoth& at, const Correspondence& way) {
  // t comes to where G(v_{i+1}) = F(v_i).
  const double target = at.a.phi(1) - at.problem->theta[1];
  if (way.trend_4 * (target - way.end.b.phi(1)) > 0) return false;
  if (!at.b.move_to_value(1, target, way.trend_4, way.z())) return false;
  way.follow_with_s(at);
  return true;
}

/// With s first, the distance to the limit shrinks by the factor d phi_4 / d phi_2 along the correspondence; with t
/// first by its inverse. What an advance leaves is as in Lemma 2.
double shrinking(const StartsOfBoth& at, const Correspondence& way, bool s_first) {
  const Correspondence::Rates rates = way.rates(at);
  // G' / F' or F' / G'. In the right order it is at most 1 at the limit, and 1 at a double pair.
  return s_first ? rates.phi_4 / rates.phi_2 : rates.phi_2 / rates.phi_4;
}

}  // namespace

/// Rounds of Figure 6 to the next limit. The order is chosen once: no iterate passes the pair, so that the sign of
/// F - G stays. (8) holds at the end of each round.
Approach iterate(StartsOfBoth& at, const Correspondence& way, const LimitRule& rule) {
  Approach result{Approach::End::going_on};
  const bool s_first = s_moves_first(at, way);
  while (result.end == Approach::End::going_on && result.iterations < rule.iterations) {
    const double s = at.a.s();
    const double t = at.b.s();
    ++result.iterations;
    if (!(s_first ? round_with_s_first(at, way) : round_with_t_first(at, way))) {
      result.end = Approach::End::exit;
      return result;
    }
    result.rate = shrinking(at, way, s_first);
    // The longer of both advances: the estimate then holds for s and for t.
    result.end = judge(std::max(std::fabs(at.a.s() - s), std::fabs(at.b.s() - t)), result.rate, rule, result.error);
  }
  if (result.end == Approach::End::going_on) result.end = Approach::End::stalled;
  return result;
}

}  // namespace rollfix::march
