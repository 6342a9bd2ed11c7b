#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cell_search.hpp"
#include "centre_path.hpp"
#include "nearest.hpp"
#include "posterior.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::touch {

struct CellView;
struct Sieve;

/// Paths on which the finger met nothing, and what they say of the part's pose: it is nowhere nearer to a path than the
/// finger's radius, but for what the path may be off. Of an open outline only the distance counts: it has no inside.
class FreeSpace {
 public:
  /// `contacts`: the problem's. A path may be off as far as their places may.
  FreeSpace(const TouchProblem& problem, const std::vector<Measured>& contacts);
  FreeSpace(const FreeSpace&) = delete;
  FreeSpace& operator=(const FreeSpace&) = delete;

  bool is_empty() const { return paths_.empty(); }

  /// Whether in this pose the part is in the way by more than a path may be off.
  bool is_blocked(const Pose& pose);
  /// Whether it is in each pose with the first contact on the cell's node: some point of a path is so deep in the part
  /// that no pose of the cell sets it free. No pose that is free is lost.
  bool blocks_all(const Cell& cell, const PathTree& tree, const Measured& first);
  void drop_blocked(std::vector<Cell>& cells, const PathTree& tree, const Measured& first);
  /// Weighs poses by how likely they leave all paths free.
  void weigh(std::vector<PosteriorNode>& nodes);

 private:
  enum class Way { free, blocked, unknown };
  /// Whether all paths are free in each pose of the cells, or one of them blocked in each.
  Way way_of(std::span<const CellView> views);
  void add_unblocked(const Sieve& sieve, std::size_t begin, std::size_t end, std::vector<Cell>& to);
  double log_free(const PosteriorNode& node);

  PartDistance part_;
  double radius_ = 0;
  double sd_ = 0;          // of a path's place across itself; 0: without noise
  double bound_ = 0;       // the part is no nearer to any place of a path than this
  double least_step_ = 0;  // along a path: what is missed between is shallow, and a pose too many
  std::vector<Clear> paths_;
};

}  // namespace rollfix::touch
