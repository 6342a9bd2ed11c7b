#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "cells.hpp"
#include "clues.hpp"
#include "index.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/solve.hpp"

namespace rollfix {

/// A part that is left, and where on it the roll can have started, of each way in which it may have gone: without cells
/// not that way. Nothing of any way: nothing is known.
struct PartLeft {
  std::size_t part = 0;
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
  const std::vector<RollClues>& ways_on(std::size_t part) const;

  const Catalog& catalog_;
  const Catalog::Index& index_;
  std::array<std::vector<RollClues>, 2> clues_;
};

}  // namespace rollfix
