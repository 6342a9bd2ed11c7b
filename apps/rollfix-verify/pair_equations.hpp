#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "finger_curve.hpp"

namespace rollfix_verify {

/// What two fingers' first contacts s and t have to fulfil, F(s, t) = A(s) - B(t) = 0 with a component for each
/// equation, a sum over finger a's angles less the same over finger b's: of reading k
///   f_k = [Theta(s + La_k) - Theta(s)] - [Theta(t + Lb_k) - Theta(t)] - turn_k,
/// and where the fingers' facing is known Theta(s) - Theta(t) - facing, but for whole turns.
class PairEquations {
 public:
  PairEquations(const std::vector<Ball>& turns, const std::optional<Ball>& facing);

  struct Equation;
  std::size_t count() const { return equations_.size(); }
  const std::vector<Equation>& all() const { return equations_; }
  /// Whether it holds but for whole turns.
  bool is_facing(std::size_t equation) const { return has_facing_ && equation + 1 == count(); }

  /// Whether some equation is off by more than `bound` at each pair of two stretches.
  bool are_apart(const Stretch& a, const Stretch& b, double bound) const;

  /// An equation on two stretches by the share of each that is behind: `at` + `by_a` x + `by_b` y, but for `off`.
  struct Plane {
    double at;
    double by_a;
    double by_b;
    double off;
  };
  /// All of them; none where the facing may be off by one number of whole turns or another.
  std::vector<Plane> planes(const Stretch& a, const Stretch& b) const;

  /// Of each equation what it is off by, anywhere on two stretches; the facing to the nearest whole turn.
  std::vector<Ball> off(const Stretch& a, const Stretch& b) const;

  /// Whether all equations can be off by no more than that at once, each contact on its own and the first ones'
  /// tangents the same for all.
  bool fit_together(const Stretch& a, const Stretch& b, double most) const;

  /// Whether exactly one pair of two stretches solves some two of the equations, by Krawczyk's operator; and so when
  /// each is off by anything up to `slack`, so that the pairs within it are one connected set. Where a finger pivots
  /// one contact has to be at a corner: two would make a family.
  bool have_one_root(FingerCurve& curve_a, const Stretch& a, FingerCurve& curve_b, const Stretch& b,
                     double slack) const;

  /// One equation, or a sum of them: the contacts' weights, the first one first, and what the sum has to be.
  struct Equation {
    std::vector<Ball> weights;
    Ball right;

    Ball off(const Stretch& a, const Stretch& b) const { return a.sum(weights) - b.sum(weights) - right; }
  };

  /// A stretch by a parameter that runs through it in steps of its width: the contacts' angles about in the middle,
  /// where it is 0, with what it leaves open; how fast they change; and the parameter at both ends.
  struct Linear {
    std::vector<Ball> middle;
    std::vector<Ball> rate;
    Ball lo;
    Ball hi;
  };

 private:
  std::optional<std::pair<long, long>> whole_turns(const Stretch& a, const Stretch& b, double bound) const;
  bool map_inside(const Linear& of_a, const Linear& of_b, const std::array<std::size_t, 2>& rows, double slack) const;

  std::vector<Equation> equations_;  // of the readings in order, then of the facing
  bool has_facing_;
};

}  // namespace rollfix_verify
