#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "convex.hpp"
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
  /// By which numbers of whole turns the facing may be off; nothing: by none.
  std::optional<std::pair<long, long>> whole_turns(const Stretch& a, const Stretch& b, double bound) const;
  /// Krawczyk's operator of two equations maps both stretches into themselves.
  bool map_inside(const Linear& of_a, const Linear& of_b, const std::array<std::size_t, 2>& rows, double slack) const;

  std::vector<Equation> equations_;  // of the readings in order, then of the facing
  bool has_facing_;
};

/// A straight line of pairs of first contacts along which both fingers' contacts move by the same arc length, ahead or
/// against each other.
class PairLine {
 public:
  /// From pair to pair. `lengths`: how far from the first contact each finger's contacts are, the first one among them.
  /// Throws std::domain_error: it has another slope, or is none.
  PairLine(const Boundary& boundary, const std::array<std::vector<Ball>, 2>& lengths, std::array<double, 2> from,
           std::array<double, 2> to);

  /// Whether each pair of it is proved to fit: no equation is off by more than that.
  bool fits(const PairEquations& equations, double most) const;

  /// Whether a pair is on it, but for that.
  bool holds(double s, double t, double slack) const;

  /// REQUIRES each pair of it fits. Where all that fits on two stretches is beside it: a convex set that holds it, on
  /// which nothing is off by more than kNear tolerances. Nothing: it can't be told.
  std::optional<Polygon> beside(const FingerCurve& curve_a, const PairEquations& equations, const Stretch& a,
                                const Stretch& b, double tolerance) const;

 private:
  /// The contacts of both fingers at a pair of it.
  struct Row {
    double s = 0;
    std::array<std::vector<Place>, 2> contacts;
  };

  /// s' of t.
  double partner(double t) const { return from_[0] + way_ * (t - from_[1]); }
  std::optional<Interval> partners(const Interval& of_b, const Interval& near, double slack) const;
  bool is_same_for_both() const;
  /// All contacts at a pair of the line.
  std::optional<Row> row(double s) const;
  /// Of a contact from place to place along the line.
  Series curvature(std::size_t finger, const Place& from, const Place& to) const;
  /// Each pair between two rows fits, shown by halves.
  bool fit(const PairEquations& equations, const Row& from, const Row& to, double most, int depth) const;
  /// Of each equation what it is off by, anywhere between two rows.
  std::vector<Ball> off(const PairEquations& equations, const Row& from, const Row& to) const;

  const Boundary& boundary_;
  const std::array<std::vector<Ball>, 2>& lengths_;
  double period_;
  std::array<double, 2> from_;  // its first pair
  double to_ = 0;               // finger a's last first contact
  double way_ = 1;              // of finger b as finger a moves ahead
  bool is_round_ = false;
};

/// One of the boxes that a cover is made of, and what is claimed of it.
struct Leaf {
  enum Kind { apart, placement, unproved } kind = unproved;
  Box box;
  double bound = 0;        // apart: some equation is off by more, radians
  std::size_t number = 0;  // placement: which one
};

/// Reads a cover of a box: `s` or `t` halves it across finger a's or b's first contacts and the two halves follow; else
/// it is a leaf: one character of 0-9A-Za-f for the power of 1/2 that bounds it, [number] of a placement, or `?`.
/// Throws std::domain_error where it is none.
void read_cover(const std::string& text, const Box& whole, const std::function<void(const Leaf&)>& use);

/// What is proved of two fingers' equations in a box of pairs of first contacts.
class PairBoxes {
 public:
  /// `lengths`: how far from the first contact each finger's contacts are, the first one among them.
  PairBoxes(const Boundary& boundary, const std::array<std::vector<Ball>, 2>& lengths, PairEquations equations)
      : curves_{FingerCurve(boundary, lengths[0]), FingerCurve(boundary, lengths[1])},
        equations_(std::move(equations)) {}

  /// At every pair some equation is off by more than the bound. Throws std::domain_error where it could not be proved.
  void prove_apart(const Box& box, double bound);

  enum class Roots { unknown, one, one_pivot };
  /// Whether one stretch of each finger in the box has exactly one root, with all that is within the tolerance of it
  /// inside, and all others have none.
  Roots roots_in(const Box& box, double tolerance);

  /// Whether all equations can be off by no more than that at once at some pair, as far as it can be told.
  bool may_fit(const Box& box, double most);

  /// Convex sets that hold all that is within the tolerance, on which nothing is off by more than kNear tolerances;
  /// nothing: it can't be told. `line`: of pairs that fit, if one is known there.
  std::optional<std::vector<Polygon>> remains(const Box& box, double tolerance, const PairLine* line);

 private:
  using Cuts = FingerCurve::Cuts;
  using Halves = std::array<std::array<const Stretch*, 2>, 2>;

  template <class Is>
  bool all_of(const Box& box, Cuts cuts, const Is& is);
  /// Two pairs of stretches that together are the given pair.
  std::optional<Halves> halves(const Stretch& a, const Stretch& b);
  /// `parts`: looked at so far.
  void prove_apart(const Stretch& a, const Stretch& b, double bound, int depth, std::size_t& parts);
  std::optional<Polygon> remains(const Stretch& a, const Stretch& b, double tolerance, const PairLine* line) const;
  /// Adds what may fit of two stretches, in parts; false: it can't be told.
  bool add_remains(const Stretch& a, const Stretch& b, double tolerance, const PairLine* line, int depth,
                   std::size_t& parts, std::vector<Polygon>& remains);

  std::array<FingerCurve, 2> curves_;
  PairEquations equations_;
};

}  // namespace rollfix_verify
