#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "convex.hpp"
#include "pair_line.hpp"

namespace rollfix_verify {

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
  std::optional<Halves> halves(const Stretch& a, const Stretch& b);
  void prove_apart(const Stretch& a, const Stretch& b, double bound, int depth, std::size_t& parts);
  std::optional<Polygon> remains(const Stretch& a, const Stretch& b, double tolerance, const PairLine* line) const;
  bool add_remains(const Stretch& a, const Stretch& b, double tolerance, const PairLine* line, int depth,
                   std::size_t& parts, std::vector<Polygon>& remains);

  std::array<FingerCurve, 2> curves_;
  PairEquations equations_;
};

}  // namespace rollfix_verify
