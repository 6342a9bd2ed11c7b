#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "held_rows.hpp"
#include "part/turning_range.hpp"
#include "rollfix/part.hpp"

namespace rollfix::hold {

/// Where a contact is on the part at one instant if its first contact was on some arc: in a disc, and its tangents are
/// no further than `half_turn` from `angle`.
struct ArcAt {
  Vec2 middle = Vec2::Zero();
  double radius = 0;     // of the disc, length
  double angle = 0;      // radians, in the part's frame
  double half_turn = 0;  // radians, jumps of corners included
};

/// How far off one finger's measurements can be at one instant, for the search: nothing is further off.
struct Slack {
  double travel = 0;  // length along the boundary
  double angle = 0;   // of the tangent in the world, radians
  double place = 0;   // of the contact in the world, length
};
Slack slack_of(const HeldErrors& errors, const HeldContact& contact, bool has_noise);

/// A wheel's pin as seen from the contact of the only finger: an error of the heading moves it by `arm` times that.
struct Lever {
  double arm = 0;    // |C - q|, length
  double slack = 0;  // how far off the pin's own x and y and the wheel's radius can be, length
};

/// A part as all trees look at it.
struct HeldPart {
  /// Makes the table of Theta's range. `whole` has to outlive it.
  explicit HeldPart(const Part& whole);
  const Part& part;
  TurningRange range;  // bounds on Theta over long arcs
};

/// A tree of arcs of first contacts of one finger, halved where somebody asks for it. What an arc comes to at an
/// instant is computed once.
class ArcTree {
 public:
  /// `instants`: rows that are searched with. `reach`: of the finger; nullptr: it can be anywhere.
  ArcTree(const HeldPart& part, const HeldRows& rows, std::size_t finger, const std::vector<std::size_t>& instants,
          const Reach* reach);

  /// First contacts: lo and hi in [0, P].
  const Interval& arc(std::int32_t node) const { return nodes_[static_cast<std::size_t>(node)].s; }
  /// The finger can have rolled so from somewhere on it: within its reach, and on an open boundary.
  bool is_possible(std::int32_t node) const { return nodes_[static_cast<std::size_t>(node)].possible; }
  /// Where the contact is at an instant, of those searched with, if its first contact was on the node's arc.
  const ArcAt& at(std::int32_t index, std::size_t instant);
  /// Of the finger at an instant: the same for all arcs.
  const Slack& slack(std::size_t instant) const { return slacks_[instant]; }
  /// Of the only finger beside wheels: the pins then decide how long leaves can be.
  void set_levers(std::vector<std::vector<Lever>> levers) { levers_ = std::move(levers); }
  /// How large an arc is, in arcs that leave places and tangents open by `leaf` times their slack; up to 1 it is a
  /// leaf.
  double size(std::int32_t node, double leaf);
  /// Equal to the node itself where it is too short to have halves.
  std::pair<std::int32_t, std::int32_t> halves(std::int32_t index);
  /// All of the boundary.
  std::int32_t root() const { return 0; }

 private:
  /// An arc; left and right are -1 until somebody asks for halves.
  struct Node {
    Interval s;
    bool possible = true;  // by `can_be`
    std::int32_t left = -1;
    std::int32_t right = -1;
    std::vector<ArcAt> at;  // of the first instants, as many as were asked for
  };
  /// A new leaf; its number.
  std::int32_t add(const Interval& s);
  /// The finger can have rolled so from somewhere on s: by its reach and the ends of an open boundary alone.
  bool can_be(const Interval& s) const;
  ArcAt look(const Interval& s, std::size_t instant) const;
  double size_by_levers(std::int32_t node, double leaf);
  Interval moved(const Interval& s, std::size_t instant) const;

  const HeldPart& part_;
  std::vector<double> travelled_;  // at each instant
  std::vector<Slack> slacks_;
  Interval sweep_;               // least and most of what was travelled, over all rows, less what that may be off
  std::vector<Interval> reach_;  // arcs, and corners as single places, where the finger can touch
  std::vector<Interval> gaps_;   // between them
  bool confined_ = false;        // false: the finger can be anywhere, and both are empty
  bool has_place_ = false;       // x and y are evidence
  std::vector<std::vector<Lever>> levers_;  // of each instant, of each wheel
  std::deque<Node> nodes_;                  // references stay
};

}  // namespace rollfix::hold
