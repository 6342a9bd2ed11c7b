#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "arc_tree.hpp"
#include "touch/heading_arc.hpp"
#include "wheel_pins.hpp"

namespace rollfix::hold {

inline constexpr std::size_t kMostFingers = 8;

/// An arc of first contacts for each finger: nodes of their trees.
using Box = std::array<std::int32_t, kMostFingers>;

/// What a search left.
struct Boxes {
  std::vector<Box> fit;        // as small as the leaf asks for, or as many as there is room for; what fits lies in them
  std::vector<Box> undecided;  // where the budget ran out
};

/// Every box of first contacts that fits at all instants, by branch and prune. A box goes where at some instant no
/// heading of the part suits all normals, all chords between contacts and all wheels. What is tested follows from
/// "there are first contacts, and a pose at each instant, with every residual within its slack": nothing that fits is
/// lost.
class BoxSearch {
 public:
  /// Boxes end where discs are no larger than this share of the slack, and tangents turn by no more than that.
  static constexpr double kLeaf = 0.5;

  BoxSearch(const HeldPart& part, const HeldRows& rows, const std::vector<std::size_t>& instants,
            const std::vector<const Reach*>& reach, const WheelPaths& wheels, std::size_t budget);

  Boxes search(double leaf = kLeaf);
  /// From these boxes alone.
  Boxes search(std::vector<Box> from, double leaf);

  ArcTree& tree(std::size_t finger) { return trees_[finger]; }
  std::size_t fingers() const { return trees_.size(); }
  std::size_t comparisons() const { return comparisons_ + pins_.looks(); }
  /// Where a wheel can touch at the first instant if the first contacts are in this box.
  std::vector<Interval> wheel_arcs(const Box& box, std::size_t wheel);

 private:
  bool may_fit(const Box& box);
  bool may_fit(const Box& box, std::size_t instant, std::vector<SpinSet>& spins);
  touch::HeadingArc headings(const Box& box, std::size_t instant);
  HeldFrom from(const Box& box, std::size_t finger, std::size_t instant);
  bool may_touch(const Box& box, std::size_t instant, const touch::HeadingArc& heading, std::vector<SpinSet>& spins);
  void add_levers(std::size_t instants);

  struct Instant {
    std::vector<double> tangent;  // of each finger, in the world
    std::vector<Vec2> at;
  };
  std::vector<ArcTree> trees_;
  std::vector<Instant> instants_;
  std::vector<bool> has_place_;
  PinSearch pins_;
  std::size_t misses_ = 0;  // instants with an outlier, at most
  std::size_t most_boxes_;
  std::size_t budget_;
  std::size_t comparisons_ = 0;
};

/// Boxes that hang together: two do if the arcs of every finger have a place in common.
std::vector<std::vector<Box>> sets_of(BoxSearch& search, const std::vector<Box>& boxes, const Boundary& boundary);

/// The shortest arc of one finger that holds all of its arcs in some boxes; lo in [0, P), hi may exceed P.
Interval extent_of(BoxSearch& search, const std::vector<Box>& boxes, std::size_t finger, const Boundary& boundary);
/// The same of where a wheel touches at the first instant.
Interval wheel_extent(BoxSearch& search, const std::vector<Box>& boxes, std::size_t wheel, const Boundary& boundary);

}  // namespace rollfix::hold
