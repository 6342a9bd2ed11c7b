#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "held_rows.hpp"
#include "part/turning_range.hpp"
#include "rollfix/part.hpp"
#include "touch/heading_arc.hpp"
#include "wheel_pins.hpp"

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

// ---- boxes

/// Fingers and wheels together, at most. A box has a node for each finger.
inline constexpr std::size_t kMostFingers = 8;

/// An arc of first contacts for each finger: nodes of their trees.
using Box = std::array<std::int32_t, kMostFingers>;

/// What a search left.
struct Boxes {
  std::vector<Box> fit;        // as small as the leaf asks for, or as many as there is room for; what fits lies in them
  std::vector<Box> undecided;  // where the budget ran out
};

/// Every box of first contacts that fits at all instants, by branch and prune. A box is dropped if at some instant no
/// heading of the part suits all normals, all chords between contacts and all wheels. What is tested follows from
/// "there are first contacts, and a pose at each instant, with every residual within its slack": nothing that fits is
/// lost.
class HoldBoxSearch {
 public:
  /// Boxes end where discs are no larger than this share of the slack, and tangents turn by no more than that.
  static constexpr double kLeaf = 0.5;

  /// `instants`: rows to search with, in the order in which they tell most. `reach`: of each finger, nullptr:
  /// anywhere. `budget`: comparisons, after which all that is left is undecided.
  HoldBoxSearch(const HeldPart& part, const HeldRows& rows, const std::vector<std::size_t>& instants,
                const std::vector<const Reach*>& reach, const WheelPaths& wheels, std::size_t budget);

  /// Of all first contacts. Smaller `leaf`: smaller boxes, and more of them.
  Boxes search(double leaf = kLeaf);
  /// From these boxes alone.
  Boxes search(std::vector<Box> from, double leaf);

  ArcTree& tree(std::size_t finger) { return trees_[finger]; }
  std::size_t fingers() const { return trees_.size(); }
  /// Boxes looked at, times instants, and places of pins.
  std::size_t comparisons() const { return comparisons_ + pins_.looks(); }
  /// Where a wheel can touch at the first instant if the first contacts are in this box.
  std::vector<Interval> wheel_arcs(const Box& box, std::size_t wheel);

 private:
  /// Whether the box holds first contacts that may fit at all instants, but for those that may have an outlier.
  bool may_fit(const Box& box);
  /// The same at one instant. `spins`: of each wheel what its encoder's zero can be, narrowed from instant to
  /// instant.
  bool may_fit(const Box& box, std::size_t instant, std::vector<SpinSet>& spins);
  /// The part's headings at an instant that suit all normals and chords.
  touch::HeadingArc headings(const Box& box, std::size_t instant);
  /// A finger's contact as the wheels' pins are seen from it.
  HeldFrom from(const Box& box, std::size_t finger, std::size_t instant);
  /// Whether all wheels can touch the part at one of these headings.
  bool may_touch(const Box& box, std::size_t instant, const touch::HeadingArc& heading, std::vector<SpinSet>& spins);
  /// Of one finger beside wheels: its leaves are as short as the pins ask for.
  void add_levers(std::size_t instants);

  /// What was measured at one of the rows searched with.
  struct Instant {
    std::vector<double> tangent;  // of each finger, in the world
    std::vector<Vec2> at;         // their contacts, in the world; of no meaning without x and y
  };
  std::vector<ArcTree> trees_;     // of each finger
  std::vector<Instant> instants_;  // in the order in which they tell most
  std::vector<bool> has_place_;    // of each finger: x and y are evidence
  PinSearch pins_;                 // of the wheels
  std::size_t misses_ = 0;         // instants with an outlier, at most
  std::size_t most_boxes_;         // beyond, boxes stay as coarse as they are
  std::size_t budget_;
  std::size_t comparisons_ = 0;
};

/// Boxes that hang together: two do if the arcs of every finger have a place in common. Sets are apart: no chain of
/// boxes leads from one to another.
std::vector<std::vector<Box>> sets_of(HoldBoxSearch& search, const std::vector<Box>& boxes, const Boundary& boundary);

/// The shortest arc of one finger that holds all of its arcs in some boxes; lo in [0, P), hi may exceed P.
Interval extent_of(HoldBoxSearch& search, const std::vector<Box>& boxes, std::size_t finger, const Boundary& boundary);
/// The same of where a wheel touches at the first instant.
Interval wheel_extent(HoldBoxSearch& search, const std::vector<Box>& boxes, std::size_t wheel,
                      const Boundary& boundary);

}  // namespace rollfix::hold
