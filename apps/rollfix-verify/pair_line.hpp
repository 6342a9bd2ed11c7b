#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pair_equations.hpp"

namespace rollfix_verify {

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

  double partner(double t) const { return from_[0] + way_ * (t - from_[1]); }
  std::optional<Interval> partners(const Interval& of_b, const Interval& near, double slack) const;
  bool is_same_for_both() const;
  std::optional<Row> row(double s) const;
  Series curvature(std::size_t finger, const Place& from, const Place& to) const;
  bool fit(const PairEquations& equations, const Row& from, const Row& to, double most, int depth) const;
  std::vector<Ball> off(const PairEquations& equations, const Row& from, const Row& to) const;

  const Boundary& boundary_;
  const std::array<std::vector<Ball>, 2>& lengths_;
  double period_;
  std::array<double, 2> from_;
  double to_ = 0;   // finger a's last first contact
  double way_ = 1;  // of finger b as finger a moves ahead
  bool is_round_ = false;
};

}  // namespace rollfix_verify
