#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "march/walker.hpp"
#include "rollfix/march/march_pairs.hpp"

namespace rollfix::march {

/// One finger's two segments: phi_k(s) = Phi(s, s + L_k), k = 0 and 1. Whole loops are taken off L_k and their turn is
/// kept apart: 0 < length < P.
struct Segments {
  std::array<double, 2> length{};
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

}  // namespace rollfix::march
