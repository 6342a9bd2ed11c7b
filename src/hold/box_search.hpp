#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "arc_tree.hpp"
#include "touch/heading_arc.hpp"
#include "wheel_pins.hpp"

namespace rollfix::hold {

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
