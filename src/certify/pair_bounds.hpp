#pragma once

#include <array>
#include <optional>
#include <vector>

#include "contact_curve.hpp"
#include "locate/pair/range.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

/// First contacts of finger a and of finger b.
using PairBox = std::array<Interval, 2>;

/// Pairs along which both fingers' contacts move by the same arc length: from (s, t) on by `length`, finger b ahead as
/// well (`way` 1) or against it (-1).
struct PairLine {
  double s = 0;
  double t = 0;
  int way = 1;
  double length = 0;  // of a lap: it goes round
};

/// How far two fingers' equations are off, in the search's own numbers: f_k of each reading, then the facing's.
class PairBounds {
 public:
  PairBounds(const Part& part, const std::vector<Reading>& readings, const std::optional<double>& facing);

  std::size_t count() const { return turns_.size() + (facing_ ? 1 : 0); }

  /// Of each equation what it is off by at a pair.
  std::vector<double> off(double s, double t) const;

  /// At every pair in a box some equation is off by more.
  double bound(const PairBox& box);

  /// The same of the tolerance, as far as some halvings tell.
  bool are_apart(const PairBox& box, double tolerance);

  /// Boxes around all that may fit in a box, where equations are planes to some tolerances, or where it is beside a
  /// line of pairs that fit. Nothing: it can't be told.
  std::optional<std::vector<PairBox>> remains(const PairBox& box, double tolerance, const PairLine* line);

  /// How much an equation changes at the most while a finger's first contact moves, or pivots, in a range; of what
  /// pivots change, this share.
  double change(const Interval& side, std::size_t finger, double share_of_pivots = 1);

  /// From the least to the largest that its part of an equation is anywhere in a range.
  double spread(const Interval& side, std::size_t finger);

  /// How much there is to be gained by halving that range.
  double use_of_halving(const Interval& side, std::size_t finger);

  /// Exactly one pair in a box solves some two equations (all, where there are two), all that is within the tolerance
  /// is inside of it.
  bool has_one_root(const PairBox& box, double tolerance);

 private:
  using Weights = std::vector<double>;
  /// The first and the last number of whole turns that the facing may be off by.
  using Turns = std::pair<int, int>;

  Weights contact_weights(const Weights& weights) const;
  double right_side(const Weights& weights, int turns) const;
  Weights unit(std::size_t row) const;
  Range combined(const ContactStretch& a, const ContactStretch& b, const Weights& weights, int turns) const;
  Turns turns(const ContactStretch& a, const ContactStretch& b) const;
  double bound(const ContactStretch& a, const ContactStretch& b) const;
  double bound(const ContactStretch& a, const ContactStretch& b, int turns) const;
  bool has_one_root(const ContactStretch& a, const ContactStretch& b, std::array<std::size_t, 2> rows,
                    double tolerance) const;
  bool has_one_root(const PairBox& box, std::array<std::size_t, 2> rows, double tolerance);
  bool is_apart(const PairBox& box, double tolerance, int& budget);
  std::optional<Polygon> flat_part(const ContactStretch& a, const ContactStretch& b, double tolerance) const;
  std::optional<Polygon> part_beside(const ContactStretch& a, const ContactStretch& b, double tolerance,
                                     const PairLine& line);
  bool add_remains(const ContactStretch& a, const ContactStretch& b, double tolerance, const PairLine* line,
                   std::vector<PairBox>& remains);

  std::array<ContactCurve, 2> curves_;
  std::vector<double> turns_;
  std::optional<double> facing_;
  double period_;
  bool closed_;
};

}  // namespace rollfix
