#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "centre_path.hpp"
#include "heading_arc.hpp"
#include "measured.hpp"

namespace rollfix::touch {

/// Places of two touches, stretches of the path, that may go together, and the part's headings if they do.
struct Cell {
  std::int32_t first = -1;  // nodes of the tree
  std::int32_t second = -1;
  HeadingArc heading;
};

/// The two touches that cells are of.
struct TouchPair {
  std::size_t first = 0;
  std::size_t second = 1;
};

/// The two whose places are known, where there are such, then those with normals, then those furthest apart. The first
/// has a place.
TouchPair choose_pair(const std::vector<Measured>& touches);

/// What a search left.
/// Disjoint cells, but for shared ends.
struct Cells {
  std::vector<Cell> fit;        // as small as the leaf asks for; what fits lies in them
  std::vector<Cell> undecided;  // where the budget ran out
};

/// Every pair of places that fits all touches, by branch and prune. A cell goes where no pose has its two touches on
/// it, by chord and normals, or where all of the boundary is out of reach of another touch. What is tested follows from
/// "there is a pose with every residual within its `most`": no such pose is lost.
class CellSearch {
 public:
  /// Cells end where discs are no larger than this share of the tolerance of length, and tangents turn by no more than
  /// it of the tolerance of angle.
  static constexpr double kLeaf = 0.5;

  /// A search that keeps more cells than this has met a continuum far wider than its tolerance, and memory ends.
  static constexpr std::size_t kMostCells = 600000;

  /// `touches` outlives this; each has a tree, which the search refines. `budget`: comparisons of nodes, of all
  /// searches together. `most_cells`: cells of one search.
  CellSearch(const std::vector<Measured>& touches, const TouchPair& pair, std::size_t budget,
             std::size_t most_cells = kMostCells);

  /// From all places; from these cells alone, to another leaf.
  Cells search(double leaf = kLeaf) {
    return search({{tree(pair_.first).root(), tree(pair_.second).root(), {}}}, leaf);
  }
  Cells search(const std::vector<Cell>& from, double leaf);

  /// Cells visited and nodes tested so far.
  std::size_t comparisons() const { return comparisons_; }

 private:
  using Lists = std::vector<std::pair<std::size_t, std::size_t>>;  // of each other touch, in candidates_

  // The steps of the search, in the order in which a cell meets them; what each does is said at its definition.
  void visit(const Cell& cell, const Lists& lists);
  HeadingArc headings(const Cell& cell) const;
  HeadingArc by_normal(std::size_t touch, std::int32_t node) const;
  bool narrow(const Cell& cell, std::size_t touch, std::pair<std::size_t, std::size_t>& list);
  /// Where a touch is by a node of another one: as that node, moved, and off by no more than `slack`.
  struct Around {
    Vec2 middle = Vec2::Zero();
    Vec2 along = Vec2::UnitX();
    double radius = 0;
    double flat = 0;
    double slack = 0;
  };
  struct Expected {
    std::array<Around, 2> places{};
    std::size_t count = 0;
  };
  static bool are_apart(const Around& around, const PathTree::Node& node);
  Expected expected(const Cell& cell, std::size_t touch) const;
  bool may_hold(const Cell& cell, const Expected& expected, std::size_t touch, std::int32_t node);
  double size(std::size_t touch, std::int32_t node) const;  // in leaves: up to 1 it is one
  void split(const Cell& cell, const Lists& lists);

  PathTree& tree(std::size_t touch) const { return *touches_[touch].tree; }

  const std::vector<Measured>& touches_;
  TouchPair pair_;
  std::size_t budget_;
  std::size_t most_cells_;
  double leaf_ = kLeaf;
  std::size_t comparisons_ = 0;
  // All touches but the pair.
  std::vector<std::size_t> others_;
  std::vector<std::int32_t> candidates_;  // a stack
  // Of `narrow`, kept to save its memory.
  std::vector<std::int32_t> waiting_;
  // Of the cell that is visited: the vector to each other touch in the part's frame, for the middle heading.
  double cosine_ = 1;
  double sine_ = 0;
  Cells found_;
};

/// How cells hang together. Two are neighbours if the places of each touch are, and headings meet.
struct CellSets {
  std::vector<Cell> cells;                                 // by the first touch's place
  std::vector<std::vector<std::size_t>> groups;            // neighbouring cells with one stretch for the first touch
  std::vector<std::pair<std::size_t, std::size_t>> links;  // of neighbouring groups
  std::vector<std::vector<std::size_t>> components;        // groups that hang together
};

/// `first`, `second`: the trees that the cells' nodes are of.
CellSets sets_of(const PathTree& first, const PathTree& second, std::vector<Cell> cells);

}  // namespace rollfix::touch
