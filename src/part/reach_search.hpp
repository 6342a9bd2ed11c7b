#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "rollfix/part.hpp"

namespace rollfix::part {

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
    // Children; -1: not split so far.
    std::int32_t left = -1;
    std::int32_t right = -1;
    Vec2 on_curve;  // a point of the boundary, and its arc length
    double on_curve_s = 0;

    bool is_single() const { return spiral >= 0; }
    double length() const { return hi - lo; }
  };

  /// Keeps a reference to the part. Cuts each spiral into pieces of equal length, which turn by 0.4 rad at most on
  /// average, and builds a balanced tree over them.
  explicit BoundaryTree(const Part& part);

  std::int32_t root() const { return root_; }
  /// The reference is good until halves() or another call adds nodes.
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
  /// Appends a single stretch between these places and returns its number.
  std::int32_t add_single(std::int32_t spiral, double lo, double hi, const Vec2& start, const Vec2& end,
                          const Turning& at_lo, const Turning& at_hi);
  /// Builds the tree over the leaves [from, to); least and most become the corners of their box.
  std::int32_t join(std::size_t from, std::size_t to, Vec2& least, Vec2& most);

  const Part& part_;
  std::vector<Node> nodes_;
  std::vector<std::int32_t> leaves_;
  std::vector<double> gaps_;
  double diagonal_ = 0;
  std::int32_t root_ = -1;
};

/// How a finger stands on the part: its contact is somewhere on a stretch of one spiral, or on several whole ones, or
/// it pivots at the convex corner where that spiral starts. Finger and part touch at p(s); the tangent there is T, the
/// outward normal n.
struct Stance {
  // On one spiral `range` is within it; on several it is from the first one's start to the last one's end.
  bool is_pivot = false;
  std::size_t spiral = 0;
  Interval range;           // of s; of a pivot, of the tangent's angle
  std::size_t spirals = 1;  // from that one on
};

/// What was found out about a stance.
struct Decision {
  Stance stance;
  bool is_free = true;  // nothing is deeper than the slack
};

/// How deep a point q is in the finger that touches at p, as a quadratic: with d = q - p and k the finger's curvature,
///   F = 2 n.d - k d.d
/// is above 0 inside; the depth h has F = h (2 - k h). It serves disks and, with k = 0, jaws. While the finger turns
/// against the part by d(omega) = d(Theta) + k ds, be it rolling or pivoting, F changes by 2 T.d d(omega).
/// F at the offset d = q - p; a length.
double deepness(const Vec2& normal, const Vec2& offset, double curvature);
/// The depth h that has this F: the smaller root of F = h (2 - k h); of a jaw F / 2.
double depth_of(double deepness, double curvature);

/// F along a chord: at_start + x slope - x^2 bend, 0 <= x <= 1.
struct ChordDeepness {
  double at_start = 0;
  double slope = 0;
  double bend = 0;

  /// The larger of the values at x = 0 and x = 1.
  double most_at_ends() const { return at_start + std::max(0.0, slope - bend); }
  /// The largest for all x in [0, 1].
  double most() const;
  /// How much larger F is at most no further than this from the chord.
  double beside(double deviation, double curvature) const;
};
/// F along the node's chord, for a finger that touches at `point` with this outward normal.
ChordDeepness deepness_on_chord(const BoundaryTree::Node& node, const Vec2& point, const Vec2& normal,
                                double curvature);

/// The stretch around a stance that a finger in it can't enter by more than the slack, in arc length unwrapped; empty
/// where the stance itself is not safe.
Interval safe_stretch(const BoundaryTree& tree, double curvature, double slack, const Stance& stance);

/// Decides for all stances of a finger whether any point of the boundary is deeper in it than the slack.
class ReachSearch {
 public:
  /// Of a finger with this curvature (1 / r; 0: a jaw) that may enter by the slack (a length). `budget`: comparisons.
  ReachSearch(BoundaryTree& tree, double curvature, double slack, std::size_t budget);

  /// In order around the part; neighbours that decide the same are not joined.
  const std::vector<Decision>& run();

  /// False: the budget ran out, and stances that were still open count as free.
  bool is_decided() const { return is_decided_; }
  /// Comparisons of a stance with a stretch so far.
  std::size_t tests() const { return tests_; }

 private:
  struct View;
  struct Comparison;

  /// Decides all stances that start on the spirals [first, end). `candidates`: nodes of the tree that together hold
  /// every point which may be in the finger there.
  void add_spirals(std::size_t first, std::size_t end, const std::vector<std::int32_t>& candidates);
  /// Whether a finger's stances on these spirals can be bounded as one.
  bool is_one_stance(std::size_t first, std::size_t end) const;
  /// The candidates, in parts if need be, that the bounds do not exclude for the whole stance.
  std::vector<std::int32_t> left_of(const Stance& stance, const std::vector<std::int32_t>& candidates);
  /// Stances at the joint where this spiral starts; none unless it is a convex corner.
  void add_pivots(std::size_t spiral, const std::vector<std::int32_t>& candidates);
  /// Stances on this spiral.
  void add_rolls(std::size_t index, const std::vector<std::int32_t>& candidates);
  /// Decides one stance: free, not free, or split.
  void decide(const Stance& stance, const std::vector<std::int32_t>& candidates);
  /// Decides both halves of a stance. One that is too short to halve counts as free.
  void split(const Stance& stance, const std::vector<std::int32_t>& candidates);
  bool is_inside(const BoundaryTree::Node& node, const Interval& around) const;
  double least(const View& view, const Vec2& point) const;
  double change(const View& view, const Vec2& offset, double beside) const;
  Comparison compare(const View& view, const BoundaryTree::Node& node) const;
  View view_of(const Stance& stance) const;
  View view_of_several(const Stance& stance) const;
  void add(const Stance& stance, bool is_free) { decisions_.push_back({stance, is_free}); }

  BoundaryTree& tree_;
  const Part& part_;
  const TurningFunction& turning_;
  double curvature_;
  double slack_;
  std::size_t budget_;
  Vec2 last_hit_;  // the point that the finger hit last
  double most_;    // F of a point as deep as the slack
  double doubt_;   // F may be this much above it
  bool is_decided_ = true;
  std::size_t tests_ = 0;
  std::vector<Decision> decisions_;
};

}  // namespace rollfix::part
