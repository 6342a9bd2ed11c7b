#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "march/path.hpp"
#include "march/sweep.hpp"
#include "rollfix/march.hpp"

namespace rollfix::march {

/// One finger's two segments: phi_k(s) = Phi(s, s + L_k), k = 0 and 1. Whole loops are taken off L_k and their turn is
/// kept apart.
struct Segments {
  /// what is left of L_k, in [0, P)
  std::array<double, 2> length{};
  /// total curvature of the loops taken off, radians
  std::array<double, 2> loops_turn{};
};

/// A start s of one finger with the endpoints s + L_1 and s + L_2 of its segments. "Movement of s results in movements
/// of the endpoints [...] Updates on their total curvatures are performed along the way" (section 3.2).
class Start {
 public:
  /// The two ends stand where `start` does until it moves.
  Start(const Walker& start, const Segments& segments);

  double s() const { return start_.length(); }
  /// phi_{k+1}(s), or phi_{k+3} of finger b.
  double phi(std::size_t k) const { return ends_[k].integral() - start_.integral() + segments_->loops_turn[k]; }
  /// phi'(s) = kappa(s + L) - kappa(s).
  double slope(std::size_t k) const { return ends_[k].density() - start_.density(); }

  Start counted_by(Tally& tally) const;

  /// All three, either way.
  void move_to(double s);

  /// Towards `stop` until phi_k equals `target`. REQUIRES that sign * phi_k grows all the way. False: it falls short at
  /// `stop`, and s stands there. Where the target is reached already, s stays.
  bool move_to_value(std::size_t k, double target, int sign, double stop);

 private:
  long steps_since(const Start& before) const;
  void become(const Start& landed, const Tally& spent);
  void nudge(double by);

  /// must outlive this
  const Segments* segments_;
  Tally* tally_;
  Walker start_;
  std::array<Walker, 2> ends_;
};

/// An interval on which both phi of a finger are monotone.
struct MonotoneInterval {
  Start lo;
  Start hi;
  std::array<int, 2> trend{};  // of each phi as s grows: +1 or -1

  /// Its end at which the first phi is smaller, and the other one.
  const Start& bottom() const { return trend[0] > 0 ? lo : hi; }
  const Start& top() const { return trend[0] > 0 ? hi : lo; }
  /// Trend of the second phi as the first one grows.
  int second_along_first() const { return trend[0] * trend[1]; }
};

/// Section 3.1 for one finger. The places point to `segments`, which must outlive it.
struct Partition {
  std::vector<MonotoneInterval> intervals;  // in order; together one loop
  std::vector<double> points;               // a_0 ... a_{n-1}, in [0, P)
  std::vector<Interval> doubts;             // stretches of s with doubtful stationary points, cut out by points
  /// points dropped because another one is the same
  std::size_t merged = 0;
};

/// What section 3.1 is done with.
struct PartitionTools {
  const Path& path;    // integrates the curvature
  const March& march;  // integrates its derivative
  double perimeter = 0;
};

/// "The stationary points of phi_1 and phi_2, found by the modified marching algorithm, divide the curve domain into n
/// intervals [a_i, a_{i+1}]. The values of phi_1 and phi_2 at all a_i are computed with one round of integrations."
/// Throws Refusal (continuum) where one of them is constant.
Partition divide(const PartitionTools& tools, const Segments& segments, Tally& evaluation, PairSteps& steps);

/// The right sides of (8) and (9), radians, and what rounding makes of such differences.
struct PairProblem {
  /// theta_1, theta_2
  std::array<double, 2> theta{};
  /// an excess of (8) or (9) below this may be 0, radians
  double rounding = 0;
};

/// A start of each finger. (8) holds, except within a move and at the ends of both intervals.
struct StartsOfBoth {
  Start a;
  Start b;
  const PairProblem* problem;

  /// What equation (8), k = 0, or (9), k = 1, is off by: phi_1(s) - phi_3(t) - theta_1 or phi_2(s) - phi_4(t) -
  /// theta_2.
  double excess(std::size_t k) const { return a.phi(k) - b.phi(k) - problem->theta[k]; }

  StartsOfBoth counted_by(Tally& tally) const { return {a.counted_by(tally), b.counted_by(tally), problem}; }
};

/// The one-to-one correspondence between s and t that (8) defines on a pair of monotone intervals, from (x, w) to
/// (y, z); phi_1 and phi_3 increase on the way.
struct Correspondence {
  StartsOfBoth begin;  // (x, w)
  StartsOfBoth end;    // (y, z)
  int trend_2 = 1;     // of phi_2(s) from x to y
  int trend_4 = 1;     // of phi_4(t) from w to z

  double x() const { return begin.a.s(); }
  double y() const { return end.a.s(); }
  double w() const { return begin.b.s(); }
  double z() const { return end.b.s(); }

  /// s (or t) put at a place between it and y (or z), and the other one moved so that (8) holds again.
  void move_s_to(StartsOfBoth& at, double s) const;
  void move_t_to(StartsOfBoth& at, double t) const;
  /// s, or t, to where (8) holds with the other one. It is ahead of where it is.
  void follow_with_s(StartsOfBoth& at) const;
  void follow_with_t(StartsOfBoth& at) const;

  /// How (9)'s sides change along the correspondence, per length of the one of s and t that moves more there.
  struct Rates {
    double ds = 0;     // 0 ... 1
    double dt = 0;     // 0 ... 1, one of both is 1
    double phi_2 = 0;  // size of the change
    double phi_4 = 0;
  };
  Rates rates(const StartsOfBoth& at) const;
  /// The change of phi_2(s) - phi_4(t), likewise.
  double slope(const StartsOfBoth& at) const;
};

/// Section 3.2: the maximal subintervals. None where I_i and J_j have nothing in common.
std::optional<Correspondence> correspond(const MonotoneInterval& i, const MonotoneInterval& j,
                                         const PairProblem& problem, Tally& tally);

/// The pair that satisfies (9) too, between two places of a correspondence.
struct BisectedPair {
  StartsOfBoth at;
  std::size_t iterations = 0;
};

/// Section 3.2 where phi_2 and phi_4 go opposite ways, so that phi_2(s) - phi_4(t) is monotone: halves whichever of
/// [s, y] and [t, z] is longer, until both are shorter than `tolerance`. REQUIRES that (9)'s excess has different signs
/// at both ends. Each middle is reached from the lower end of what is left. Its steps are counted by `tally`.
BisectedPair bisect(const Correspondence& way, double tolerance, Tally& tally);

/// Section 3.2 where phi_2 and phi_4 go the same way: from the pair's place to the first pair that satisfies (9) too,
/// or to the end of the correspondence. Neither s nor t ever passes it. REQUIRES trend_2 == trend_4.
Approach iterate(StartsOfBoth& at, const Correspondence& way, const LimitRule& rule);

/// Which of both starts has to go forward to meet (9): s where phi_2(s) lags behind phi_4(t) + theta_2, seen in the
/// direction in which both go, else t.
inline bool s_moves_first(const StartsOfBoth& at, const Correspondence& way) { return way.trend_2 * at.excess(1) < 0; }

/// Steps of section 3.2 by what they are for.
struct RectangleTallies {
  Tally iteration;
  Tally bisection;
};

/// Section 3.2: all pairs in one pair of monotone intervals, along its correspondence.
/// Adds pairs, not reduced to one loop, doubts and counts to `result`.
void search_rectangle(const Correspondence& way, const PairMarchOptions& options, RectangleTallies& tallies,
                      PairResult& result);

}  // namespace rollfix::march
