#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "rollfix/part.hpp"

namespace rollfix {

/// A tree of stretches of the boundary. Each is near a chord; the short ones are split when somebody asks for it, once
/// for all who do.
class BoundaryTree {
 public:
  struct Node {
    double lo = 0;  // arc lengths of its ends
    double hi = 0;
    Vec2 start;  // the chord: of a single stretch between its ends; of many a point, the middle of their box
    Vec2 end;
    double deviation = 0;  // no point of the boundary is further from the chord
    Turning at_lo;         // of a single stretch
    Turning at_hi;
    std::int32_t spiral = -1;  // that a single stretch lies on
    std::int32_t left = -1;
    std::int32_t right = -1;
    Vec2 on_curve;  // a point of the boundary, and its arc length
    double on_curve_s = 0;

    bool is_single() const { return spiral >= 0; }
    double length() const { return hi - lo; }
  };

  explicit BoundaryTree(const Part& part);

  std::int32_t root() const { return root_; }
  const Node& node(std::int32_t index) const { return nodes_[static_cast<std::size_t>(index)]; }
  /// The two halves; equal to the node itself where it is too short to have any.
  std::pair<std::int32_t, std::int32_t> halves(std::int32_t index);

  /// The single stretches as they were before any was split, in order.
  const std::vector<std::int32_t>& leaves() const { return leaves_; }
  const Part& part() const { return part_; }
  const Spiral& spiral_of(const Node& node) const {
    return part_.turning().spirals()[static_cast<std::size_t>(node.spiral)];
  }
  /// The distance between where spiral k starts and where the one before it ends: a drawing's rounded digits.
  double gap_before(std::size_t spiral) const { return gaps_[spiral]; }
  double diagonal() const { return diagonal_; }  // of the boundary's box

 private:
  std::int32_t add_single(std::int32_t spiral, double lo, double hi, const Vec2& start, const Vec2& end,
                          const Turning& at_lo, const Turning& at_hi);
  std::int32_t join(std::size_t from, std::size_t to, Vec2& least, Vec2& most);

  const Part& part_;
  std::vector<Node> nodes_;
  std::vector<std::int32_t> leaves_;
  std::vector<double> gaps_;
  double diagonal_ = 0;
  std::int32_t root_ = -1;
};

}  // namespace rollfix
