#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "part/turning_tree.hpp"
#include "range.hpp"
#include "roll_equations.hpp"
#include "rollfix/part.hpp"

namespace rollfix {

/// Bounds on a roll's components over stretches of the boundary that are not cut into pieces yet, from the tree over
/// the part's spirals: what is between two contacts' strips. Of a part with few spirals there are none, nor of one with
/// corners: where pivots make continua, an answer's start would hang on the order of the boxes.
class RollStrips {
 public:
  /// The spirals that a contact passes: of its first lap from 0 on, on the next one from their number on.
  struct Span {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
  };

  /// `range`: of first contacts.
  RollStrips(const Part& part, const RollEquations& equations, const Interval& range);

  bool is_empty() const { return !is_wanted_; }
  /// Of each contact while the first one is anywhere on the range.
  const std::vector<Span>& whole() const { return whole_; }
  /// How often a contact passes from one spiral to the next.
  std::size_t cuts(const Span* spans) const;
  /// Where the contact that passes most spirals is half way through them. `below` and `above`: the spans on both sides.
  double halve(const Span* spans, Span* below, Span* above) const;
  /// Of each component, wherever the first contact is in s.
  void bound(const Interval& s, const Span* spans, Range* values) const;

 private:
  class Walk;

  double joint(std::uint32_t index) const;
  double place_of(std::size_t contact, std::uint32_t index) const;
  std::uint32_t spiral_at(const Span& among, double base) const;
  Walk walk(std::size_t contact, double s, const Span& span) const;
  Range between(const Walk& start, const Walk* end, double lo, double hi) const;
  Range bound(const Interval& s, Walk start, Walk* end) const;

  const TurningFunction& turning_;
  const TurningTree& tree_;
  const RollEquations& equations_;
  bool is_wanted_;
  double same_place_;
  std::vector<double> offset_;   // from the first contact to each contact's place on its first lap
  std::vector<double> winding_;  // that lap, and ...
  std::vector<double> lift_;     // ... its turn, radians
  std::vector<Span> whole_;
};

}  // namespace rollfix
