#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "arc_height.hpp"
#include "outline/box.hpp"
#include "part_data.hpp"
#include "work/pulse.hpp"

// Notation:
//   arc             one of equal lengths of a spiral on one panel; they turn by `kCrossingLeafTurn` at most on average
//   turn            how far the tangent turns on it in all; of a node the corners between its arcs included
//   bulge           how far an arc can be from its chord: arc_height.hpp
//   box             around the chord, wider by the bulge
// Follows the idea of D. H. Ballard, "Strip trees: a hierarchical representation for curves" (1981).
// Idea: a stretch whose tangent turns by less than half a turn in all can't meet itself (`kSimpleTurn`), nor can two
// that join and together turn by less. So only pairs of nodes whose boxes meet, and which turn by more, are looked at
// in a binary tree of boxes, down to two arcs that are apart or meet.
namespace rollfix {
namespace {

// A stretch whose tangent turns by less than half a turn in all, corners included, can't meet itself: projected on the
// direction in the middle of its tangents' range, it always moves forwards.
constexpr double kSimpleTurn = std::numbers::pi * (1 - 1e-9);
// Leaves turn by no more than this on average, so that a chord is close to its arc.
constexpr double kCrossingLeafTurn = 0.7;
// Two arcs that are still not apart at this share of the perimeter do meet.
constexpr double kMeeting = 1e-10;
// Stretches side by side are told apart piece by piece, and the closer they are the shorter the pieces. After so many
// comparisons, some seconds, it is given up: then they are closer than a millionth of their length or so.
constexpr std::size_t kMostComparisons = 10'000'000;

/// A stretch of one spiral and one panel between arc lengths lo and hi: Theta is monotone on it.
struct LeafArc {
  double lo = 0;
  double hi = 0;
  Vec2 start;  // points of its ends
  Vec2 end;
  double turn = 0;  // of the tangent in all, |corner at its start| not included
  double bulge = 0;

  /// `turns`: |Theta(to) - Theta(from)|, radians.
  LeafArc(double from, double to, const Vec2& starts, const Vec2& ends, double turns)
      : lo(from), hi(to), start(starts), end(ends), turn(turns) {
    bulge = part::arc_height((end - start).norm(), hi - lo, turn);
  }

  /// Holds every point of the arc.
  Box box() const {
    const Vec2 margin = Vec2::Constant(bulge);
    return {Vec2(start.cwiseMin(end) - margin), Vec2(start.cwiseMax(end) + margin)};
  }
};

/// A binary tree over consecutive arcs: node k has the halves 2k and 2k + 1. A node knows its box, and how far the
/// tangent turns in it; those of a few arcs are not kept, but made of the arcs when they are asked for.
class CrossingSearch {
 public:
  explicit CrossingSearch(const Part& part) : part_(part) {
    // Nodes of up to kFewArcs arcs or so are not stored: about count / kFewArcs nodes are.
    collect_arcs();
    std::size_t kept = 1;
    while (kept * kFewArcs < arcs()) kept *= 2;
    nodes_.resize(kept);
    build(kRoot, 0, arcs());
  }

  /// The first crossing found, which need not be the one with the least s.
  std::optional<Crossing> run() {
    within(kRoot, 0, arcs());
    return found_;
  }

 private:
  static constexpr std::size_t kRoot = 1;
  static constexpr std::size_t kFewArcs = 4;

  struct Node {
    Box box;
    double turn = 0;  // corners between its arcs included
  };

  /// Where an arc starts and the one before it ends. That is all that is kept of arcs, of which there may be millions.
  struct Joint {
    Vec2 point;
    double s;
    double turn;  // of the arc that starts here
  };

  std::size_t arcs() const { return joints_.size() - 1; }
  LeafArc arc(std::size_t k) const {
    const Joint& from = joints_[k];
    const Joint& to = joints_[k + 1];
    return {from.s, to.s, from.point, to.point, from.turn};
  }

  /// Cuts the boundary into arcs, in order: at the ends of spirals and panels, and in between into equal lengths that
  /// turn by kCrossingLeafTurn at most on average. A corner belongs to the arc that starts there.
  void collect_arcs() {
    const std::vector<Spiral>& spirals = part_.turning().spirals();
    const std::vector<Panel>& panels = part_.turning().panels();
    joints_.reserve(panels.size() + spirals.size() + 1);
    joints_.push_back({part_.point(0), 0, 0});
    corners_.reserve(panels.size() + spirals.size());
    auto corner = part_.corners().begin();
    for (const Spiral& spiral : spirals) {
      // The corner where this spiral starts; later arcs of the spiral have none.
      double jump = 0;
      if (corner != part_.corners().end() && corner->s <= spiral.lo) jump = std::abs((corner++)->turn);
      for (std::uint32_t panel = spiral.first_panel; panel <= spiral.last_panel; ++panel) {
        const double lo = std::max(spiral.lo, panels[panel].lo);
        const double hi = std::min(spiral.hi, panels[panel].hi);
        if (hi > lo) add_arcs(spiral, lo, hi, jump);
        jump = 0;
      }
    }
  }

  /// Cuts [lo, hi], on one spiral and one panel, into arcs of equal length.
  void add_arcs(const Spiral& spiral, double lo, double hi, double jump) {
    beat();
    const TurningFunction& turning = part_.turning();
    const double all = std::abs(turning.on_spiral(spiral, hi).angle - turning.on_spiral(spiral, lo).angle);
    const int count = 1 + static_cast<int>(all / kCrossingLeafTurn);
    for (int k = 0; k < count; ++k) {
      const double to = k + 1 == count ? hi : lo + (hi - lo) * (k + 1) / count;
      joints_.back().turn = turn(joints_.back().s, to);
      joints_.push_back({part_.point(to), to, 0});
      corners_.push_back(k == 0 ? jump : 0);
    }
  }

  /// Fills the kept nodes, children before parents. Node k covers the arcs [first, last).
  void build(std::size_t node, std::size_t first, std::size_t last) {
    if (!is_kept(node)) return;
    const std::size_t middle = first + (last - first) / 2;
    build(2 * node, first, middle);
    build(2 * node + 1, middle, last);
    nodes_[node] = joined(node, first, last);
  }

  bool is_kept(std::size_t node) const { return node < nodes_.size(); }

  /// Its turn: those of both halves and the corner in between. The sum of all turns in size bounds the range of
  /// directions.
  Node joined(std::size_t node, std::size_t first, std::size_t last) const {
    const std::size_t middle = first + (last - first) / 2;
    const Node left = node_at(2 * node, first, middle);
    const Node right = node_at(2 * node + 1, middle, last);
    return {left.box.merged(right.box), left.turn + corners_[middle] + right.turn};
  }

  /// The node as stored, or made of its arcs.
  Node node_at(std::size_t node, std::size_t first, std::size_t last) const {
    if (is_kept(node)) return nodes_[node];
    return last - first == 1 ? Node{arc(first).box(), joints_[first].turn} : joined(node, first, last);
  }

  /// Does the stretch of arcs [first, last) meet itself?
  void within(std::size_t node, std::size_t first, std::size_t last) {
    // One arc counts as simple. So does any stretch that turns by less than half a turn in all.
    if (found_ || last - first == 1 || node_at(node, first, last).turn < kSimpleTurn) return;
    const std::size_t middle = first + (last - first) / 2;
    within(2 * node, first, middle);
    within(2 * node + 1, middle, last);
    between(2 * node, first, middle, 2 * node + 1, middle, last);
  }

  /// Do two stretches, the first before the second, meet elsewhere than where they join?
  void between(std::size_t node1, std::size_t first1, std::size_t last1, std::size_t node2, std::size_t first2,
               std::size_t last2) {
    if (found_) return;
    const Node one = node_at(node1, first1, last1);
    const Node two = node_at(node2, first2, last2);
    // Boxes apart: nothing in common.
    if (!one.box.intersects(two.box)) return;
    const double turns = one.turn + two.turn;
    // They join and are simple together: then they share nothing but the joint. The same across s = 0.
    if (last1 == first2 && turns + corners_[first2] < kSimpleTurn) return;
    if (last2 == arcs() && first1 == 0 && part_.closed() && turns + corners_[0] < kSimpleTurn) return;
    const bool leaf1 = last1 - first1 == 1;
    const bool leaf2 = last2 - first2 == 1;
    // The larger of the two is halved, so that both boxes shrink alike.
    if (leaf1 && leaf2) {
      meet(arc(first1), arc(first2), joint_turn(last1, first2, last2, first1));
    } else if (leaf2 || (!leaf1 && one.box.sizes().maxCoeff() >= two.box.sizes().maxCoeff())) {
      const std::size_t middle = first1 + (last1 - first1) / 2;
      between(2 * node1, first1, middle, node2, first2, last2);
      between(2 * node1 + 1, middle, last1, node2, first2, last2);
    } else {
      const std::size_t middle = first2 + (last2 - first2) / 2;
      between(node1, first1, last1, 2 * node2, first2, middle);
      between(node1, first1, last1, 2 * node2 + 1, middle, last2);
    }
  }

  /// The corners at which two neighbouring leaves join: after the first, and across s = 0 after the second.
  struct JointTurn {
    double after_first = -1;  // negative: not neighbours there
    double after_second = -1;
  };
  JointTurn joint_turn(std::size_t last1, std::size_t first2, std::size_t last2, std::size_t first1) const {
    JointTurn turn;
    if (last1 == first2) turn.after_first = corners_[first2];
    if (part_.closed() && last2 == arcs() && first1 == 0) turn.after_second = corners_[0];
    return turn;
  }

  /// Halves two arcs until they are apart, or too short to tell from one point.
  void meet(const LeafArc& one, const LeafArc& two, const JointTurn& joint) {
    if (found_ || !one.box().intersects(two.box())) return;
    const double turn = one.turn + two.turn;
    if (joint.after_first >= 0 && turn + joint.after_first < kSimpleTurn) return;
    if (joint.after_second >= 0 && turn + joint.after_second < kSimpleTurn) return;
    // Arcs that neither test excludes are halved, the longer one first, down to this length.
    const double shortest = kMeeting * part_.perimeter();
    const bool split_one = one.hi - one.lo >= two.hi - two.lo;
    const LeafArc& longer = split_one ? one : two;
    // Not apart when both are that short: they count as meeting.
    const bool gives_up = ++comparisons_ > kMostComparisons;
    if (gives_up || longer.hi - longer.lo <= shortest) {
      found_ = Crossing{one.lo, two.lo, one.start, !gives_up};
      return;
    }
    const double middle = 0.5 * (longer.lo + longer.hi);
    const LeafArc head = part_of(longer, longer.lo, middle);
    const LeafArc tail = part_of(longer, middle, longer.hi);
    // A half is a neighbour of the other arc only on its own side: the head is no longer next to what follows the
    // halved arc, the tail no longer next to what comes before it.
    if (split_one) {
      meet(head, two, {-1, joint.after_second});
      meet(tail, two, {joint.after_first, -1});
    } else {
      meet(one, head, {joint.after_first, -1});
      meet(one, tail, {-1, joint.after_second});
    }
  }

  /// A stretch of an arc; the ends that it shares with the whole keep their points.
  LeafArc part_of(const LeafArc& whole, double lo, double hi) const {
    return {lo, hi, lo == whole.lo ? whole.start : part_.point(lo), hi == whole.hi ? whole.end : part_.point(hi),
            turn(lo, hi)};
  }

  /// |Theta(hi) - Theta(lo)| with the limits from inside, radians.
  double turn(double lo, double hi) const {
    return std::abs(part_.turning().angle(hi, Side::before) - part_.turning().angle(lo, Side::after));
  }

  const Part& part_;
  std::vector<Joint> joints_;    // the last one ends the last arc
  std::vector<double> corners_;  // |turn| of the corner where each arc starts
  std::vector<Node> nodes_;      // of many arcs; the root is the second one
  std::size_t comparisons_ = 0;
  std::optional<Crossing> found_;
};

}  // namespace

std::optional<Crossing> find_crossing(const Part& part) {
  const Doing doing("looking whether the outline crosses itself");
  return CrossingSearch(part).run();
}

}  // namespace rollfix
