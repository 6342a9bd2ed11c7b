#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "march/pairs.hpp"
#include "rollfix/march.hpp"
#include "rollfix/turning_function.hpp"

// Notation (section 3.2; docs/march.md, "Which of s and t moves first")
//   rectangle     two monotone intervals [a_i, a_i+1] x [b_j, b_j+1], on which (8) is a curve: `way_`
//   excess(k)     what (8), k = 0, or (9), k = 1, is off by at (s, t)
//   slope         change of phi_2 - phi_4 along that curve, per length of the one of s and t that moves more
//   one ... four  phi_1' ... phi_4' at (s, t)
// Idea: bisection finds the one pair or none; the march all pairs on the curve, in order: a limit is found, passed by
// "a small amount", and it goes on. Limits that are not reached and pairs that may have been passed become doubts.
namespace rollfix::march {

namespace {

/// A near miss is past where the excess of (9) is this many times what it was where the limit was given up.
constexpr double kPast = 2;
/// Rounds per limit once the rounds of all limits have used up the budget.
constexpr std::size_t kFewRounds = 500;

/// How far (s, t) may be from the pair because both equations are off by their excess and by rounding: Cramer's rule.
double distance_of_residuals(const StartsOfBoth& at) {
  // Linearized: phi_1' ds - phi_3' dt = -(8)'s excess, phi_2' ds - phi_4' dt = -(9)'s; the signs are taken so that the
  // parts add up. The determinant is 0 at a double pair: the estimate is then infinite.
  const double one = at.a.slope(0), two = at.a.slope(1), three = at.b.slope(0), four = at.b.slope(1);
  const double determinant = std::fabs(three * two - one * four);
  if (determinant == 0) return std::numeric_limits<double>::infinity();
  const double eight = std::fabs(at.excess(0)) + at.problem->rounding;
  const double nine = std::fabs(at.excess(1)) + at.problem->rounding;
  const double s = std::fabs(four) * eight + std::fabs(three) * nine;
  const double t = std::fabs(two) * eight + std::fabs(one) * nine;
  return std::fmax(s, t) / determinant;
}

/// The two in order, for a doubt: s or t may fall along the correspondence.
Interval between(double one, double two) { return {std::fmin(one, two), std::fmax(one, two)}; }

/// Whether (9)'s excess can be told from zero.
bool tells(const StartsOfBoth& place) { return std::fabs(place.excess(1)) > place.problem->rounding; }

/// All pairs on one rectangle. `at_` is a place on the curve of (8) that only goes forward, from (x, w) to (y, z).
class Rectangle {
 public:
  Rectangle(const Correspondence& way, const PairMarchOptions& options, RectangleTallies& tallies, PairResult& result)
      : way_(way),
        options_(options),
        perimeter_(result.perimeter),
        tallies_(tallies),
        rule_(limit_rule(options.limit, options.reset, options.iterations, perimeter_)),
        at_(way.begin),
        result_(result),
        first_find_(result.pairs.size()) {}

  /// phi_2(s) - phi_4(t) is monotone: "a unique pair of curve locations exists if phi_2(x) - phi_4(w) < theta_2 and
  /// phi_2(y) - phi_4(z) > theta_2", or the other way round.
  void bisect() {
    ++result_.bisections;
    // phi_2(s) - phi_4(t) is monotone: a pair at an end is the only one.
    if (root_at(way_.begin)) return note_boundary(way_.begin);
    if (root_at(way_.end)) return note_boundary(way_.end);
    if (side(way_.begin) == side(way_.end)) return;
    const BisectedPair pair = march::bisect(way_, rule_.tolerance, tallies_.bisection);
    result_.iterations += pair.iterations;
    note(pair.at, {Approach::End::limit, pair.iterations, 0, rule_.tolerance}, PairFound::bisection);
  }

  /// Iterations of Figure 6, one after the other, from (x, w) to (y, z).
  void march() {
    at_ = way_.begin.counted_by(tallies_.iteration);
    if (root_at(at_)) {
      note_boundary(at_);
      reset();
    }
    while (!at_end()) {
      // At each turn all pairs behind `at_` are noted, up to the reset and the doubts.
      // As printed, t moves first. It would have to leave the interval at w, or to turn back to the pair just found:
      // "one of x_i and w_i exits the corresponding interval [...] locations do not exist".
      if (options_.order == MoveOrder::printed && s_moves_first(at_, way_)) return;
      // Neither s nor t is ahead if rounding decides the sign of (9): go on by force, until it can be told.
      if (!tells(at_)) {
        escape(0);
      } else if (!approach_next()) {
        break;
      }
    }
    if (root_at(way_.end)) note_boundary(way_.end);
  }

 private:
  /// Of (9) in the direction in which phi_2 goes: -1 where s lags behind.
  int side(const StartsOfBoth& place) const { return side_of(way_.trend_2 * place.excess(1)); }

  /// One of s and t at its stop is the end of the way: (8) ties the other one to it.
  bool at_end() const { return at_.a.s() == way_.y() || at_.b.s() == way_.z(); }

  /// Whether (9) holds at this place or within the limit's tolerance of it.
  bool root_at(const StartsOfBoth& place) const {
    return std::fabs(place.excess(1)) <=
           std::fmax(place.problem->rounding, std::fabs(way_.slope(place)) * rule_.tolerance);
  }

  /// To the next pair and past it. False: there is none up to (y, z).
  bool approach_next() {
    const StartsOfBoth from = at_;
    // Once the budget is used up each limit gets kFewRounds, so that a rectangle of near misses ends soon.
    const std::size_t left = options_.budget - std::min(options_.budget, result_.iterations);
    rule_.iterations = std::min(options_.iterations, std::max(left, kFewRounds));
    const Approach approach = iterate(at_, way_, rule_);
    result_.iterations += approach.iterations;
    if (approach.end == Approach::End::exit) {
      // The sign of (9) differs at both ends, so a pair lies between; the iteration came to the end without it.
      if (side(way_.end) != side(from) && !root_at(way_.end)) {
        doubt(PairDoubt::Why::jumped, from, way_.end, approach.iterations);
      }
      return false;
    }
    if (approach.end == Approach::End::limit) {
      note(at_, approach, PairFound::iteration);
      reset();
    } else {
      escape(approach.iterations);
    }
    return true;
  }

  /// A pair at an end of the way, (x, w) or (y, z): its error comes from distance_of_residuals alone.
  void note_boundary(const StartsOfBoth& place) { note(place, {Approach::End::limit, 0, 0, 0}, PairFound::boundary); }

  /// Adds a pair. Within a rectangle only the last one can be the same; finds of other rectangles are merged later
  /// (march_pairs.cpp).
  void note(const StartsOfBoth& place, const Approach& how, PairFound found) {
    const StartPair pair{place.a.s(),
                         place.b.s(),
                         std::fmax(how.error, distance_of_residuals(place)),
                         std::fabs(place.excess(0)),
                         std::fabs(place.excess(1)),
                         how.rate,
                         how.iterations,
                         found};
    std::vector<StartPair>& pairs = result_.pairs;
    if (pairs.size() > first_find_) {
      const StartPair& last = pairs.back();
      const double same = kSameRoot * rule_.tolerance;
      if (std::fabs(pair.s - last.s) <= same && std::fabs(pair.t - last.t) <= same) {
        ++result_.found_again;
        pairs.pop_back();  // the march is nearer to the pair now
      }
    }
    pairs.push_back(pair);
  }

  /// Forward along the correspondence: the one of s and t that moves more there by `amount`, the other one follows, so
  /// that neither makes a leap near a stationary point.
  void advance(double amount) {
    const Correspondence::Rates rates = way_.rates(at_);
    // At most to the stop, and exactly onto it, so that `at_end` can compare by ==.
    const auto forward = [amount](double from, double stop) {
      return std::fabs(stop - from) <= amount ? stop : from + std::copysign(amount, stop - from);
    };
    if (rates.ds >= rates.dt) {
      way_.move_s_to(at_, forward(at_.a.s(), way_.y()));
    } else {
      way_.move_t_to(at_, forward(at_.b.s(), way_.z()));
    }
  }

  /// "To find the next pair, we pass by s_i and t_i for large enough i by a small amount." Beyond a pair (9)'s excess
  /// has the sign of its slope there. If it has not, and moves on away from zero, then another pair was passed with it.
  void reset() {
    const StartsOfBoth from = at_;
    // Before the move, at the pair itself.
    const int expected = side_of(way_.slope(at_));
    advance(options_.reset * perimeter_);
    const double excess = at_.excess(1);
    if (tells(at_) && side_of(excess) != expected && excess * way_.slope(at_) > 0) {
      doubt(PairDoubt::Why::jumped, from, at_, 0);
    }
  }

  /// A limit that is not reached: a double pair, two pairs close together, a near miss, or a continuum. Goes on by
  /// doubling amounts until the excess of (9) has changed its sign or has grown for good, and says so.
  void escape(std::size_t iterations) {
    const StartsOfBoth from = at_;
    // `least`: what the excess has to outgrow. `flat`: (9) has held to rounding all the way from the start.
    const double least = std::fmax(std::fabs(at_.excess(1)), at_.problem->rounding);
    bool flat = !tells(at_);
    bool past = false;
    for (double amount = options_.reset * perimeter_; !past && !at_end(); amount *= 2) {
      advance(amount);
      flat = flat && !tells(at_);
      past = tells(at_) && (side(at_) != side(from) || std::fabs(at_.excess(1)) >= kPast * least);
      const double far = std::fmax(std::fabs(at_.a.s() - from.a.s()), std::fabs(at_.b.s() - from.b.s()));
      if (flat && far > kContinuum * perimeter_) {
        throw Refusal(Reason::continuum, from.a.s(),
                      fmt::format("march: expected isolated pairs, found that all from s = {:.17g}, t = {:.17g} to "
                                  "s = {:.17g}, t = {:.17g} at least fit; rollfix::locate reports such stretches",
                                  from.a.s(), from.b.s(), at_.a.s(), at_.b.s()));
      }
    }
    doubt(PairDoubt::Why::slow, from, at_, iterations);
  }

  /// Pairs with s and t between these two places may be missing.
  void doubt(PairDoubt::Why why, const StartsOfBoth& from, const StartsOfBoth& to, std::size_t iterations) {
    result_.doubts.push_back(
        {why, between(from.a.s(), to.a.s()), between(from.b.s(), to.b.s()), iterations, std::fabs(from.excess(1))});
  }

  const Correspondence& way_;
  const PairMarchOptions& options_;
  /// P; options are parts of it
  double perimeter_;
  RectangleTallies& tallies_;
  LimitRule rule_;
  /// the place on the way
  StartsOfBoth at_;
  PairResult& result_;
  /// index in result_.pairs of this rectangle's first find
  std::size_t first_find_;
};

}  // namespace

void search_rectangle(const Correspondence& way, const PairMarchOptions& options, RectangleTallies& tallies,
                      PairResult& result) {
  Rectangle rectangle(way, options, tallies, result);
  if (way.trend_2 == way.trend_4) {
    rectangle.march();
  } else {
    rectangle.bisect();
  }
}

// ---- all of them
// Notation (section 3)
//   s, t            first contacts of fingers a and b: arc lengths in [0, P)
//   L_1, L_2        lengths from s by the first and the second reading; L_3, L_4 those from t
//   theta_1, _2     right sides of (8) and (9), radians
//   m, n            intervals between stationary points of finger b, and of finger a
// Idea: partition.cpp divides both domains and pairs two intervals where (8) allows it, `Rectangle`
// finds all pairs in there; here the m n rectangles are gone through and finds of neighbours made one. Section 3 bounds
// the steps by a multiple of (m + n) T / h.

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
