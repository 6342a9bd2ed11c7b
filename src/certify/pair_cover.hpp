#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pair_bounds.hpp"
#include "rollfix/locate.hpp"

namespace rollfix {

/// A placement as the cover sees it.
struct CoveredPair {
  const Placement* placement = nullptr;
  std::optional<PairBox> box;    // holds all that belongs to it; none: the cells that are left near it do
  bool has_cell = false;         // one that holds its start; of one without a box
  std::optional<PairLine> line;  // of a family: all of it fits
};

/// Halves a box of pairs until some equation is off on each part of it, or the part is in a placement's box. What can't
/// be told apart any further goes to a placement without a box that it is near to.
class PairCover {
 public:
  PairCover(const Part& part, PairBounds& bounds, double tolerance, std::vector<CoveredPair>& pairs)
      : part_(part), bounds_(bounds), tolerance_(tolerance), pairs_(pairs) {}

  /// As text: docs/certificates.md.
  std::string cells(const PairBox& whole);

 private:
  struct Cell {
    PairBox box;
    std::string token;      // of a leaf; "s", "t": halved
    std::size_t first = 0;  // of its halves
  };

  std::string settled(const PairBox& box);
  std::optional<std::size_t> owner(const PairBox& box);
  bool belongs(const PairBox& box, std::size_t family);
  bool is_of(const PairBox& set, const CoveredPair& pair) const;
  bool meets(const PairBox& one, const PairBox& two, double room) const;
  bool holds_start(const PairBox& box, const Placement& placement) const;
  std::string left_over(const PairBox& box);
  bool is_flat(const PairBox& box);
  bool is_inside(const PairBox& inner, const PairBox& outer) const;
  bool is_near(const PairBox& box, const Placement& placement) const;
  using Shares = std::array<Interval, 3>;
  Shares shares_near(const Interval& way, double place, double reach) const;
  bool is_near_line(const PairBox& box, const Placement& placement, double reach) const;
  void write(std::size_t cell, std::string& text) const;

  const Part& part_;
  PairBounds& bounds_;
  double tolerance_;
  std::vector<CoveredPair>& pairs_;
  std::vector<Cell> cells_;
};

}  // namespace rollfix
