#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "centre_tree.hpp"
#include "document.hpp"

namespace rollfix_verify {

/// Where a contact is on the part, if it is on some arc of the boundary: in a disc, its tangents by no more than
/// half_turn from an angle. The least and the largest tangent count with all that is between them.
struct OnArc {
  double x = 0;
  double y = 0;
  double radius = 0;  // of the disc
  double angle = 0;   // radians, counted on from lap to lap
  double half_turn = 0;
};

/// Arcs of the boundary by arc length.
class BoundaryArcs {
 public:
  explicit BoundaryArcs(const Boundary& boundary);

  bool closed() const { return closed_; }
  double period() const { return period_; }
  double turn() const { return turn_; }  // of the tangent around the part
  double size() const { return size_; }  // of the largest coordinate
  /// Of a closed outline an arc may go on from lap to lap. REQUIRES of an open one that some of it is on it.
  OnArc over(Interval arc);

 private:
  struct Lap {
    Interval arc;  // on the first lap
    double turn = 0;
  };
  /// Bounds a short arc on one curve; false: it is none.
  bool add_curve(const Interval& arc, double slack);
  /// Adds the stretches of a node that meet an arc, no longer than `grain`.
  void add(int index, const Lap& lap, double grain);
  /// One disc and one interval for all stretches that were found.
  OnArc hull_of_found() const;

  const Boundary& boundary_;
  CentreTree tree_;
  bool closed_;
  double period_;
  double turn_;
  double size_ = 0;
  std::vector<OnArc> found_;  // stretches that together hold the arc asked for
};

/// Arcs of first contacts of one finger, halved when somebody asks for it, and where the contact is at each instant.
class FirstContacts {
 public:
  FirstContacts(BoundaryArcs& boundary, const HeldFinger& finger);

  int root() const { return 0; }
  const Interval& arc(int node) const { return nodes_[static_cast<std::size_t>(node)].arc; }
  /// The finger can have rolled so from somewhere on it: within reach, and on an open boundary.
  bool is_possible(int node) const { return nodes_[static_cast<std::size_t>(node)].is_possible; }
  const OnArc& at(int index, std::size_t instant);
  /// In the least arcs that are looked at.
  double size(int index);
  std::pair<int, int> halves(int index);

 private:
  struct Node {
    Interval arc;
    bool is_possible = true;
    int left = -1;  // -1: not halved yet; the right half stands behind it
    std::vector<std::optional<OnArc>> at;
  };
  /// A new node.
  int add(const Interval& arc);
  /// Whether some first contact of the arc can have rolled as the finger did.
  bool can_be(const Interval& arc) const;
  /// Whether two arcs have a place in common.
  bool meets(const Interval& one, const Interval& other) const;
  /// An arc of first contacts, as the contacts are at an instant.
  Interval moved(const Interval& arc, std::size_t instant) const;

  BoundaryArcs& boundary_;
  const HeldFinger& finger_;
  std::deque<Node> nodes_;  // references stay
};

}  // namespace rollfix_verify
