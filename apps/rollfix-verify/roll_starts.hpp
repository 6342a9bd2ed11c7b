#pragma once

#include <optional>
#include <vector>

#include "boundary.hpp"
#include "centre_tree.hpp"

namespace rollfix_verify {

/// How far a roll had gone along the outline, and turned with it, radians.
struct RollReading {
  Ball length;
  Ball turn;
};

/// Where on the boundary a roll can have started by its readings alone: all of them within a tolerance at once, with
/// one tangent where the finger pivots at the start.
class RollStarts {
 public:
  /// On all contacts of a node of centres: how far readings may be from what they are on it is told for certain.
  struct On {
    bool may_start = true;  // false: at none of them
    bool all_start = false;
    double spread = 0;  // of what decides it, in tolerances: halving the node makes it less
  };

  /// `tree`: of the finger's centres, on whose nodes it is asked; outlives this, as `boundary` does.
  RollStarts(const Boundary& boundary, const CentreTree& tree, std::vector<RollReading> readings, double tolerance);

  const On& on(int node);
  /// Whether it can have started at this place with a tangent of this angle (in the outline's own frame), as far as
  /// places are stated.
  bool may_start(const Place& place, const Ball& direction) const;

 private:
  /// Computes `on`.
  On look(const CentreTree::Node& node) const;
  /// A reading's f over a node by its slope; none: not known.
  std::optional<Ball> by_slope(const CentreTree::Node& node, const RollReading& reading) const;
  std::optional<std::vector<Ball>> ends(const Ball& from, const Ball& to, const Ball& length) const;
  std::optional<Place> clear_of_joints(const Ball& s, int way) const;
  /// All rolls from between two places end beyond an open outline.
  bool leaves(const Ball& from, const Ball& to, const Ball& length) const;

  const Boundary& boundary_;
  const CentreTree& tree_;
  std::vector<RollReading> readings_;
  double tolerance_;
  double period_;
  Ball base_;  // the tangent's angle at s = 0
  std::vector<std::optional<On>> known_;
};

}  // namespace rollfix_verify
