#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "cells.hpp"
#include "clues.hpp"
#include "profile.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"
#include "touch/cell_search.hpp"

namespace rollfix {

/// What all parts of a catalog are asked first, side by side in memory: 660 bytes a part, and its name.
struct Catalog::Index {
  std::vector<catalog::Course> courses;                         // in the catalog's order, as all of these
  std::vector<catalog::Profile<catalog::kCoarseCells>> coarse;  // Theta on 16 cells
  std::vector<catalog::Profile<catalog::kCells>> cells;         // Theta on 64 cells
  std::vector<std::uint8_t> measured;  // its outline is not exact: bounds on it say nothing certain
  /// Read from the file.
  std::function<std::vector<catalog::Profile<catalog::kFineCells>>(const std::vector<std::size_t>& parts)> fine;
  /// Of touches: of the part itself, when it is first asked for.
  std::function<catalog::CellPlaces(std::size_t part)> places;
};

}  // namespace rollfix

namespace rollfix::catalog {

/// A part that is left, and where on it the roll can have started, of each way in which it may have gone: without cells
/// not that way. Nothing of any way: nothing is known.
struct PartLeft {
  std::size_t part = 0;  // its place in the catalog
  std::vector<Cells<kFineCells>> cells{};
};

/// Rules out parts of a catalog on which a roll can't have been: from ever finer cells, then from stretches of the
/// part.
class Bounds {
 public:
  /// `excess`: with so many times the noise.
  Bounds(const Catalog& catalog, const Problem& like, double excess);

  /// Those of the parts that are left. Throws InputError: it was told to stop, or the file is damaged.
  std::vector<PartLeft> left_of(const std::vector<std::size_t>& parts, const IdentifyOptions& options) const;

 private:
  /// A part that was not ruled out yet: the cells that are left, of each way.
  struct Candidate {
    std::size_t part = 0;
    std::vector<Cells<kCells>> cells;
  };

  std::vector<Candidate> candidates(const std::vector<std::size_t>& parts, const IdentifyOptions& options) const;
  /// From what is in memory. False: it can't be it.
  bool look_in_memory(Candidate& candidate) const;
  /// From finer cells and from the part itself; nothing: it can't be it.
  std::optional<PartLeft> look_closely(const Candidate& candidate, const Profile<kFineCells>& fine) const;
  /// The clues that hold on a part, by whether it is stored reversed.
  const std::vector<RollClues>& ways_on(std::size_t part) const;

  const Catalog& catalog_;
  const Catalog::Index& index_;
  std::array<std::vector<RollClues>, 2> clues_;  // [0]: of parts stored as they were given; [1]: reversed
};

/// Rules out parts of a catalog that touches can't be of, by cells of their boundaries.
class TouchBounds {
 public:
  /// REQUIRES that the problem is valid of some part, which does not matter.
  TouchBounds(const Catalog& catalog, const TouchProblem& like);

  /// Those of the parts that are left. Throws InputError: it was told to stop, or the file is damaged.
  std::vector<std::size_t> left_of(const std::vector<std::size_t>& parts, const IdentifyOptions& options) const;

 private:
  const Catalog& catalog_;
  std::vector<touch::Measured> touches_;  // those with a place, as the search takes them
  touch::TouchPair pair_;                 // two of them, whose cells are compared first
  double radius_ = 0;                     // of the finger; 0: a point
};

}  // namespace rollfix::catalog
