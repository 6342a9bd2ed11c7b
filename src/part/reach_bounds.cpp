#include <algorithm>
#include <cmath>
#include <numbers>

#include "arc_height.hpp"
#include "cursor.hpp"
#include "reach_search.hpp"

// Notation:
//   s               arc length: a node holds [`lo`, `hi`]
//   chord           from `start` to `end`; of a node over many stretches a point, the middle of their box
//   deviation       no point of the boundary is further from the chord
//   Theta           tangent's angle at both ends of a single stretch: `at_lo`, `at_hi`
//   x, y            along the tangent at the contact, and against the outward normal there; phi: the slope's angle
//   kappa, k        curvature of the boundary and of the finger; d(sin phi)/dx = kappa, and of the disk's rim it is -k
//   e               by how much kappa falls short of -k: `excess_`; j, x_j: turn and place of a concave joint: `jumps_`
// Follows docs/reach.md, "How it is decided", its tree (1) and the safe stretch around a contact (3).
// Idea: a stretch that turns in one direction lies near its chord (arc_height.hpp). Long runs are bounded by boxes,
// short stretches are halved when somebody asks for it. Around a contact, while kappa >= -k, the boundary stays above
// the rim, and the finger can't enter it. Else it comes below by no more than (e x^2 / 2 + sum of j (x - x_j)) / cos^3
// of the steepest slope: while that is within the slack, and the slopes make sense, the stretch is safe.
namespace rollfix::part {
namespace {

// A spiral is cut into so many equal lengths that they turn by no more than this on average, radians: then most of them
// are close to their chords.
constexpr double kLeafTurn = 0.4;
// Positions are rounded: this share of the perimeter.
constexpr double kPlaceRounding = 2e-15;
// A stretch shorter than this share of the perimeter has no halves.
constexpr double kShortest = 1e-13;

}  // namespace

BoundaryTree::BoundaryTree(const Part& part) : part_(part) {
  const TurningFunction& turning = part.turning();
  const std::vector<Spiral>& spirals = turning.spirals();
  // Just before a joint the point is still on the spiral that ends there, which may be a rounded digit away.
  const double before_end = 1e-14 * part.perimeter();
  std::vector<Vec2> ends;
  for (std::size_t k = 0; k < spirals.size(); ++k) {
    const Spiral& spiral = spirals[k];
    // As many pieces of equal length as kLeafTurn asks for.
    const int count = 1 + static_cast<int>(std::abs(spiral.turn()) / kLeafTurn);
    Vec2 from = part.point(spiral.lo);
    Turning at_from = spiral.start;
    gaps_.push_back(k == 0 ? 0 : (from - ends.back()).norm());
    for (int i = 1; i <= count; ++i) {
      const double lo = i == 1 ? spiral.lo : spiral.lo + (spiral.hi - spiral.lo) * (i - 1) / count;
      const double hi = i == count ? spiral.hi : spiral.lo + (spiral.hi - spiral.lo) * i / count;
      const Vec2 to = part.point(i == count ? std::max(spiral.hi - before_end, lo) : hi);
      const Turning at_to = i == count ? spiral.end : turning.on_spiral(spiral, hi);
      leaves_.push_back(add_single(static_cast<std::int32_t>(k), lo, hi, from, to, at_from, at_to));
      from = to;
      at_from = at_to;
    }
    ends.push_back(from);
  }
  if (part.closed()) gaps_.front() = (part.point(0) - ends.back()).norm();
  // Only the tree over them is built here; single stretches are halved when somebody asks.
  Vec2 least, most;
  root_ = join(0, leaves_.size(), least, most);
  diagonal_ = (most - least).norm();
}

std::int32_t BoundaryTree::add_single(std::int32_t spiral, double lo, double hi, const Vec2& start, const Vec2& end,
                                      const Turning& at_lo, const Turning& at_hi) {
  Node node;
  node.lo = lo;
  node.hi = hi;
  node.start = start;
  node.end = end;
  const double turn = std::abs(at_hi.angle - at_lo.angle);
  node.deviation = arc_height((end - start).norm(), hi - lo, turn) + kPlaceRounding * part_.perimeter();
  node.at_lo = at_lo;
  node.at_hi = at_hi;
  node.spiral = spiral;
  node.on_curve = start;
  node.on_curve_s = lo;
  nodes_.push_back(node);
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

/// A node over many stretches is a point, the middle of their box, with half the diagonal as its deviation. Its point
/// of the boundary is one between both halves.
std::int32_t BoundaryTree::join(std::size_t from, std::size_t to, Vec2& least, Vec2& most) {
  if (to - from == 1) {
    const Node& leaf = node(leaves_[from]);
    const Vec2 margin = Vec2::Constant(leaf.deviation);
    least = leaf.start.cwiseMin(leaf.end) - margin;
    most = leaf.start.cwiseMax(leaf.end) + margin;
    return leaves_[from];
  }
  const std::size_t middle = from + (to - from) / 2;
  Node joined;
  Vec2 other_least, other_most;
  joined.left = join(from, middle, least, most);
  joined.right = join(middle, to, other_least, other_most);
  least = least.cwiseMin(other_least);
  most = most.cwiseMax(other_most);
  joined.lo = node(joined.left).lo;
  joined.hi = node(joined.right).hi;
  joined.start = joined.end = 0.5 * (least + most);
  joined.deviation = 0.5 * (most - least).norm();
  joined.on_curve = node(joined.right).on_curve;
  joined.on_curve_s = node(joined.right).on_curve_s;
  nodes_.push_back(joined);
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

std::pair<std::int32_t, std::int32_t> BoundaryTree::halves(std::int32_t index) {
  // A copy: adding nodes moves them.
  const Node whole = node(index);
  if (whole.left >= 0) return {whole.left, whole.right};
  const double middle = 0.5 * (whole.lo + whole.hi);
  if (whole.length() <= kShortest * part_.perimeter() || !(middle > whole.lo && middle < whole.hi)) {
    return {index, index};
  }
  const Vec2 point = part_.point(middle);
  const Turning at = part_.turning().on_spiral(spiral_of(whole), middle);
  const std::int32_t left = add_single(whole.spiral, whole.lo, middle, whole.start, point, whole.at_lo, at);
  const std::int32_t right = add_single(whole.spiral, middle, whole.hi, point, whole.end, at, whole.at_hi);
  nodes_[static_cast<std::size_t>(index)].left = left;
  nodes_[static_cast<std::size_t>(index)].right = right;
  return {left, right};
}

namespace {

// The boundary is safe while its tangent stays within these angles of the stance's.
constexpr double kMostInward = std::numbers::pi / 2 + 1e-9;  // turned away from the finger
constexpr double kMostOutward = std::numbers::pi / 3;        // turned towards it
constexpr double kLeaning = 8;                               // 1 / cos^3 of kMostOutward
// Far enough from the stance the bounds do as well: so many spirals, and so many times the stance's length, are enough.
constexpr int kMostSafeSpirals = 64;
constexpr double kMostSafeLength = 16;
constexpr double kMostSafeLengthOfSeveral = 4;  // of a stance on several spirals, which is long
constexpr int kSafeRounds = 30;                 // of halving where it ends

/// Walks from a stance in one direction (+1 or -1) as far as the finger can't enter the boundary.
class SafeWalk {
 public:
  /// `angles`: of the tangent on the stance.
  SafeWalk(const BoundaryTree& tree, double curvature, double slack, const Stance& stance, const Interval& angles,
           int direction)
      : tree_(tree),
        turning_(tree.part().turning()),
        curvature_(curvature),
        slack_(slack),
        stance_(stance),
        forwards_(direction > 0),
        allowed_(forwards_ ? Interval{angles.hi - kMostOutward, angles.lo + kMostInward}
                           : Interval{angles.hi - kMostInward, angles.lo + kMostOutward}),
        at_(Cursor::at_spiral(turning_, stance.spiral + (forwards_ ? stance.spirals - 1 : 0))) {}

  /// Where it ends: the arc length up to which the stretch is safe, unwrapped. If the stance itself is not safe, the
  /// walk ends at the stance's other end, so that the walks in both directions leave an empty stretch.
  double end() {
    if (!leave_stance()) return here_;
    const bool is_on_several = stance_.spirals > 1;
    const double enough = (is_on_several ? kMostSafeLengthOfSeveral : kMostSafeLength) * length_;
    bool at_joint = stance_.is_pivot && !forwards_;  // a pivot looks back at the spiral before
    // Each turn passes the rest of a spiral and the joint behind it.
    for (int seen = 0; (seen <= kMostSafeSpirals && !is_on_several) || length_ <= enough; ++seen) {
      if (!at_joint && !pass_spiral()) break;
      at_joint = false;
      if (!pass_joint()) break;
    }
    return here_ + at_.shift();
  }

 private:
  /// From the stance to its end in the walk's direction; false where not even the stance is safe.
  bool leave_stance() {
    const Spiral& spiral = at_.spiral();
    // A pivot stands on the joint itself and has no length. Backwards the walk starts with the spiral before.
    if (stance_.is_pivot) {
      here_ = spiral.lo;
      return !forwards_ || allowed_.contains(spiral.start.angle);
    }
    length_ = stance_.range.width();
    if (stance_.spirals > 1) return leave_several();
    // kappa is monotone: its least value is at an end.
    for (const double end : {stance_.range.lo, stance_.range.hi}) excess_ = std::max(excess_, excess_at(end));
    const bool is_safe = fits(length_, excess_);
    here_ = is_safe == forwards_ ? stance_.range.hi : stance_.range.lo;
    return is_safe;
  }

  /// The boundary bends away from the finger on all of them; joints count as if they were where it touches.
  bool leave_several() {
    for (std::size_t k = stance_.spiral + 1; k < stance_.spiral + stance_.spirals; ++k) {
      jumps_ += std::max(0.0, -Cursor::at_spiral(turning_, k).jump());
      gaps_ += tree_.gap_before(k);
    }
    const bool is_safe = fits(length_, excess_);
    here_ = is_safe == forwards_ ? stance_.range.hi : stance_.range.lo;
    return is_safe;
  }

  /// On to the spiral's end; false where the tangent or the slack ends the walk before that, which bisection finds.
  bool pass_spiral() {
    const Spiral& spiral = at_.spiral();
    const double end = forwards_ ? spiral.hi : spiral.lo;
    const auto excess_up_to = [&](double s) { return std::max({excess_, excess_at(s), excess_at(here_)}); };
    // True up to some s and false behind it, so bisection finds where it ends: the angle is monotone, and the length
    // and the excess grow with s.
    const auto reaches = [&](double s) {
      return allowed_.contains(turning_.on_spiral(spiral, s).angle + at_.lift()) &&
             fits(length_ + std::abs(s - here_), excess_up_to(s));
    };
    if (!reaches(end)) {
      double inside = here_;
      double outside = end;
      for (int round = 0; round < kSafeRounds; ++round) {
        const double middle = 0.5 * (inside + outside);
        (reaches(middle) ? inside : outside) = middle;
      }
      here_ = inside;
      return false;
    }
    excess_ = excess_up_to(end);
    length_ += std::abs(end - here_);
    here_ = end;
    return true;
  }

  /// Over the joint behind the spiral; false at an end of an open boundary, after a whole lap, or where the jump or the
  /// gap ends the walk. A concave joint adds to what the boundary comes below the rim by.
  bool pass_joint() {
    if ((forwards_ ? at_.is_last() : at_.is_first()) || length_ > turning_.perimeter()) return false;
    Cursor next = at_;
    forwards_ ? next.advance() : next.retreat();
    const Cursor& joint = forwards_ ? next : at_;  // where the spiral starts that comes after it
    const double jump = joint.angle_after() - joint.angle_before();
    if (jump < 0) {
      jumps_ -= jump;
      jump_places_ -= jump * length_;
    }
    gaps_ += tree_.gap_before(joint.index());
    if (!allowed_.contains(forwards_ ? joint.angle_after() : joint.angle_before())) return false;
    if (!fits(length_, excess_)) return false;
    at_ = next;
    here_ = forwards_ ? at_.spiral().lo : at_.spiral().hi;
    return true;
  }

  /// By how much kappa falls short of -k at s; below 0 where the rim bends away.
  double excess_at(double s) const { return -turning_.on_spiral(at_.spiral(), s).curvature - curvature_; }

  /// Whether a boundary that goes on for this length stays less than the slack below the rim: the bound at the head of
  /// this file, plus the gaps.
  bool fits(double length, double excess) const {
    const double below = 0.5 * excess * length * length + std::max(0.0, jumps_ * length - jump_places_);
    return kLeaning * below + gaps_ <= slack_;
  }

  const BoundaryTree& tree_;
  const TurningFunction& turning_;
  double curvature_;
  double slack_;
  const Stance& stance_;
  bool forwards_;
  Interval allowed_;  // angles of the tangent
  Cursor at_;
  double here_ = 0;         // on its spiral
  double length_ = 0;       // x
  double excess_ = 0;       // e
  double jumps_ = 0;        // sum of j
  double jump_places_ = 0;  // sum of j x_j
  double gaps_ = 0;
};

}  // namespace

/// `angles`: the tangent's range over the stance; on each spiral it is monotone, so that its ends have it.
Interval safe_stretch(const BoundaryTree& tree, double curvature, double slack, const Stance& stance) {
  const TurningFunction& turning = tree.part().turning();
  const Spiral& spiral = turning.spirals()[stance.spiral];
  Interval angles = stance.range;
  if (stance.spirals > 1) {
    angles = {spiral.start.angle, spiral.start.angle};
    for (std::size_t k = stance.spiral; k < stance.spiral + stance.spirals; ++k) {
      for (const double angle : {turning.spirals()[k].start.angle, turning.spirals()[k].end.angle}) {
        angles = {std::min(angles.lo, angle), std::max(angles.hi, angle)};
      }
    }
  } else if (!stance.is_pivot) {
    const double one = turning.on_spiral(spiral, stance.range.lo).angle;
    const double two = turning.on_spiral(spiral, stance.range.hi).angle;
    angles = {std::min(one, two), std::max(one, two)};
    // A stance that turns by more is itself not within the angles that make a stretch safe. Equal lengths of a spiral
    // may turn by much.
    if (angles.width() > kMostOutward) return {stance.range.hi, stance.range.lo};
  }
  return {SafeWalk(tree, curvature, slack, stance, angles, -1).end(),
          SafeWalk(tree, curvature, slack, stance, angles, 1).end()};
}

}  // namespace rollfix::part
