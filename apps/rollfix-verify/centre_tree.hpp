#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "boundary.hpp"
#include "convex.hpp"

namespace rollfix_verify {

/// A full turn, radians, to a double's digits.
inline const double kTurn = 2 * std::acos(-1.0);

/// The angle that differs by whole turns and is nearest to 0.
inline double nearest(double angle) { return std::remainder(angle, kTurn); }

/// The tangent's angles that a finger is said to have at a corner, radians.
struct CornerAngles {
  double s = 0;
  std::vector<Interval> angles;
};

/// Where on the boundary contacts are looked for.
struct Considered {
  std::vector<Interval> arcs;         // of arc length; they may go on beyond the perimeter
  std::vector<CornerAngles> corners;  // those at which not all angles are; elsewhere on the arcs they all are
};

/// Where the centre of a round finger can be while it touches: p + r n, at a convex corner an arc about it. A tree of
/// stretches, halved when somebody asks for it; each lies in a disc, and its tangents' angles in an interval.
class CentreTree {
 public:
  struct Node {
    // The disc's middle, and how far centres are from it.
    double x = 0;
    double y = 0;
    double radius = 0;
    // The tangent's angle, radians: by no more than half_turn from this.
    double angle = 0;
    double half_turn = 0;
    Interval s;       // contacts
    long curve = -1;  // of a single stretch: that it is on, or that ends at its corner
    bool is_corner = false;
    Interval u;  // of a single stretch: its curve's parameters; at a corner angles
    int left = -1;
    int right = -1;
  };

  /// `considered`: none: all of the boundary. A finger that has no place leaves the tree without a root: -1.
  CentreTree(const Boundary& boundary, double radius, const std::optional<Considered>& considered);

  int root() const { return root_; }
  const Node& node(int index) const { return nodes_[static_cast<std::size_t>(index)]; }
  /// Both halves; twice itself where it has none. References to nodes do not outlive it.
  std::pair<int, int> halves(int index);

  /// Some stretch of a curve of the first lap, which need not be one of the tree.
  Node stretch(long curve, const Interval& u) const;

  /// The tangent's angle in the outline's own frame.
  Ball direction(const Place& place) const { return place.angle + base_; }
  /// The angles that a finger can have where this curve ends and the next one begins; none: it does not pivot there.
  std::optional<Ball> pivots(long curve) const;
  /// Those of them that are considered.
  std::vector<Interval> angles_at(long curve, const Ball& pivots, const Considered& considered) const;

 private:
  /// Nodes of one curve, or of what is considered of it.
  void add_curve(long curve, const std::optional<Considered>& considered);
  /// A node, or several where one has no bounds.
  void add_stretch(long curve, const Interval& u, int depth);
  /// Nodes of the pivot at a curve's end, if there is one.
  void add_corner(long curve, const std::optional<Considered>& considered);
  /// Whether a place is on one of the arcs.
  bool is_on(double s, const std::vector<Interval>& arcs) const;
  int add(Node node);
  /// A node of the pivot at a curve's end over some angles.
  Node corner(long curve, const Interval& angles) const;
  /// The root of a tree over the nodes `from` up to `to`, which is not included.
  int join(std::size_t from, std::size_t to);

  const Boundary& boundary_;
  double radius_;
  double period_;
  Ball base_;  // the tangent's angle at s = 0
  std::vector<Node> nodes_;
  int root_ = -1;
};

/// A contact by arc length at which a finger of this radius, infinity of a flat jaw, is not shown to enter the part,
/// though it is not among those that are considered; nothing: at all of them some point of the boundary is inside of
/// the finger.
std::optional<double> not_out_of_reach(const Boundary& boundary, double radius, const Considered& considered);

}  // namespace rollfix_verify
