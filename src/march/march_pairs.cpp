#include "rollfix/march.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "march/pairs.hpp"
#include "rollfix/turning_function.hpp"

// Notation (section 3)
//   s, t            first contacts of fingers a and b: arc lengths in [0, P)
//   L_1, L_2        lengths from s by the first and the second reading; L_3, L_4 those from t
//   theta_1, _2     right sides of (8) and (9), radians
//   m, n            intervals between stationary points of finger b, and of finger a
// Idea: partition.cpp divides both domains, correspondence.cpp pairs two intervals where (8) allows it, rectangle.cpp
// finds all pairs in there; here the m n rectangles are gone through and finds of neighbours made one. Section 3 bounds
// the steps by a multiple of (m + n) T / h.

namespace rollfix::march {

namespace {

/// Rounding errors of phi_1 - phi_3 and of phi_2 - phi_4, as a part of all that is summed up.
constexpr double kPairRounding = 1e-14;
/// Finds of neighbouring rectangles are one pair if they differ by no more than this many of their estimated errors.
constexpr double kEstimates = 4;

/// Throws InputError for an option out of range. The reset has to be above the limit, or finds repeat.
void check(const PairMarchOptions& options) {
  const auto expect = [](bool good, const char* what, double found) {
    if (!good) throw InputError(fmt::format("march: expected {}, found {}", what, found));
  };
  expect(options.step >= 0 && std::isfinite(options.step), "a step that is positive, or 0 for automatic", options.step);
  expect(options.limit >= kLeastLimit && options.limit < 1, "a limit from 1e-14 to 1 (parts of P)", options.limit);
  expect(options.reset > options.limit && options.reset < 1, "a reset above the limit and below 1 (parts of P)",
         options.reset);
  expect(options.iterations > 0, "at least one iteration per limit", 0);
}

/// Throws InputError for a length or a turn that is not finite.
void check(const Reading& reading) {
  if (std::isfinite(reading.length[0]) && std::isfinite(reading.length[1]) && std::isfinite(reading.turn)) return;
  throw InputError(fmt::format("march: expected finite numbers, found lengths {} and {}, turn {}", reading.length[0],
                               reading.length[1], reading.turn));
}

/// The outline, if it is closed. Throws InputError for an open one: section 3 divides a loop.
const Outline& closed(const Outline& outline) {
  if (outline.closed) return outline;
  throw InputError("march: expected a closed outline for two fingers, found an open one; use rollfix::locate");
}

/// Options of the march for eq. (6). Its limit and reset stay at their defaults: they are about stationary points, not
/// about pairs.
Options for_stationary_points(const PairMarchOptions& options) {
  Options same;
  same.step = options.step;
  same.iterations = options.iterations;
  return same;
}

/// What rounding errors are measured against: the sum of |kappa| over one loop, and its turn.
struct OneLoop {
  Span sum;
  double variation = 0;
};

/// One walk of T/h steps. `variation` is the sum of |integral of kappa| over the steps: less than the integral of
/// |kappa| only where kappa changes its sign within a step.
OneLoop one_loop(const Path& path) {
  Position at = first_position(path);
  OneLoop loop{at.step, std::fabs(at.step.integral)};
  for (std::size_t i = 1; i < path.steps_per_loop(); ++i) {
    at = next_position(path, at);
    loop.sum = loop.sum + at.step;
    loop.variation += std::fabs(at.step.integral);
  }
  return loop;
}

}  // namespace

/// What is prepared once per outline: both marches over it, and one loop's sums.
struct PairMarch::Data {
  Data(const Outline& outline, const PairMarchOptions& given)
      : options(given),
        march(closed(outline), curvature_rate_density(), for_stationary_points(given)),
        path(outline, curvature_density(), given.step),
        loop(one_loop(path)) {}

  /// of one finger, from its two lengths
  Segments segments(double length_1, double length_2) const;
  /// right sides of (8) and (9)
  PairProblem problem(const Reading& first, const Reading& second) const;
  /// finds of all rectangles, each pair once
  void merge(PairResult& result) const;
  PairResult search(const Reading& first, const Reading& second) const;

  PairMarchOptions options;
  /// of kappa', for eq. (6)
  March march;
  /// of kappa, for phi
  Path path;
  OneLoop loop;
};

/// Whole loops add the same turn to every segment: what is left of L lies in [0, P).
Segments PairMarch::Data::segments(double length_1, double length_2) const {
  Segments segments;
  const std::array<double, 2> lengths{length_1, length_2};
  for (std::size_t k = 0; k < 2; ++k) {
    // A negative length becomes one in [0, P) and a negative number of loops. Whole loops turn the same from every s.
    const Wrapped wrapped = wrap(lengths[k], loop.sum.length);
    segments.length[k] = wrapped.base;
    segments.loops_turn[k] = wrapped.winding * loop.sum.integral;
  }
  return segments;
}

/// theta_1 and theta_2, and the rounding of the sums: it grows with the loops of both rolls and with the turns.
PairProblem PairMarch::Data::problem(const Reading& first, const Reading& second) const {
  double loops = 1;
  for (const Reading& reading : {first, second}) {
    loops += std::fabs(reading.length[0] / loop.sum.length) + std::fabs(reading.length[1] / loop.sum.length);
  }
  return {{first.turn, second.turn},
          kPairRounding * (loop.variation * loops + std::fabs(first.turn) + std::fabs(second.turn))};
}

/// Pairs on the common boundary of two rectangles, or of four, are found in each.
void PairMarch::Data::merge(PairResult& result) const {
  const double period = loop.sum.length;
  std::vector<StartPair> merged;
  for (StartPair pair : result.pairs) {
    pair.s = wrap(pair.s, period).base;
    pair.t = wrap(pair.t, period).base;
    // Both starts near, periodically: a pair at s = 0 is also found at s = P.
    const auto same = [&](const StartPair& other) {
      const double near = kEstimates * std::fmax(pair.error + other.error, options.limit * period);
      return periodic_distance(pair.s, other.s, period) <= near && periodic_distance(pair.t, other.t, period) <= near;
    };
    const auto twin = std::find_if(merged.begin(), merged.end(), same);
    if (twin == merged.end()) {
      merged.push_back(pair);
      continue;
    }
    ++result.found_again;
    // Of finds that are one pair the best known is kept.
    if (pair.error < twin->error) *twin = pair;
  }
  std::sort(merged.begin(), merged.end(), [](const StartPair& one, const StartPair& two) {
    return std::pair(one.s, one.t) < std::pair(two.s, two.t);
  });
  result.pairs = std::move(merged);
  // `lo` in [0, P); `hi` may exceed P.
  for (PairDoubt& doubt : result.doubts) {
    for (Interval* where : {&doubt.s, &doubt.t}) {
      const double lo = wrap(where->lo, period).base;
      *where = {lo, lo + where->width()};
    }
  }
}

/// "The localization algorithm enumerates all nm pairs of intervals."
/// All of section 3 for one question: divide, go through the rectangles, merge, add up the counts.
PairResult PairMarch::Data::search(const Reading& first, const Reading& second) const {
  PairResult result;
  result.perimeter = loop.sum.length;
  result.steps_per_loop = path.steps_per_loop();
  result.steps.choosing = path.choosing_steps();
  result.steps.preprocessing = path.steps_per_loop();

  const PairProblem problem = this->problem(first, second);
  const Segments segments_a = segments(first.length[0], second.length[0]);
  const Segments segments_b = segments(first.length[1], second.length[1]);
  Tally evaluation;
  // Section 3.1: finger a by L_1 and L_2, finger b by L_3 and L_4.
  const PartitionTools tools{path, march, result.perimeter};
  const Partition a = divide(tools, segments_a, evaluation, result.steps);
  const Partition b = divide(tools, segments_b, evaluation, result.steps);
  result.stationary_a = a.points;
  result.stationary_b = b.points;
  result.merged = a.merged + b.merged;
  const Interval anywhere{0, result.perimeter};
  // Where a stationary point is doubtful phi may not be monotone: with any partner pairs may be missing.
  for (const Interval& where : a.doubts) result.doubts.push_back({PairDoubt::Why::stationary, where, anywhere, 0, 0});
  for (const Interval& where : b.doubts) result.doubts.push_back({PairDoubt::Why::stationary, anywhere, where, 0, 0});

  Tally subintervals;
  RectangleTallies tallies;
  // Each of the n m rectangles: excluded by I_i and J_j, or searched along its correspondence.
  for (const MonotoneInterval& i : a.intervals) {
    for (const MonotoneInterval& j : b.intervals) {
      ++result.rectangles;
      const auto way = correspond(i, j, problem, subintervals);
      if (!way) {
        ++result.rejected;
        continue;
      }
      ++result.examined;
      search_rectangle(*way, options, tallies, result);
    }
  }
  merge(result);
  // the counts by purpose, and the work that is not steps summed over all purposes
  result.steps.evaluation = evaluation.steps;
  result.steps.subintervals = subintervals.steps;
  result.steps.iteration = tallies.iteration.steps;
  result.steps.bisection = tallies.bisection.steps;
  for (const Tally& tally : {evaluation, subintervals, tallies.iteration, tallies.bisection}) {
    result.steps.landings += tally.landings;
    result.steps.refinements += tally.refinements;
  }
  return result;
}

PairMarch::PairMarch(const Outline& outline, const PairMarchOptions& options) {
  check(options);
  data_ = std::make_shared<const Data>(outline, options);
}

PairResult PairMarch::pairs(const Reading& first, const Reading& second) const {
  check(first);
  check(second);
  return data_->search(first, second);
}

PairResult locate_pairs(const Outline& outline, const Reading& first, const Reading& second,
                        const PairMarchOptions& options) {
  return PairMarch(outline, options).pairs(first, second);
}

}  // namespace rollfix::march
