#include "centre_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "check.hpp"
#include "document.hpp"

// Notation:
//   p(u), n         a curve's point, and its outward normal (sin Theta, -cos Theta)
//   r, c            the finger's radius and its centre, c = p + r n
//   node            a stretch of a curve, or a pivot at a corner, with the disc of its centres and the interval of its
//                   tangents
// Follows docs/certificates.md, "Touches", "How it is checked".
// Idea: |dc| = |1 + r kappa| ds <= ds + r |d Theta|. So from the middle of a stretch c goes no further than the way to
// its longer end, and Theta turns no further than the largest |d Theta / du| over half of it. At a corner c is on an
// arc about p. Everything is a ball until it is rounded outwards into a node.
namespace rollfix_verify {
namespace {

// Stated angles that end so near to the end of a corner's cone, radians, reach it: its ends are enclosed no better, and
// to look at more places is no harm.
constexpr double kConeSlack = 1e-7;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// What doubles make of a sum of bounds.
constexpr double kRoundUp = 1 + 1e-12;
constexpr double kNodeWork = 1;
constexpr int kMostCuts = 20;

/// The middle as a double, and how far all of the ball is from it.
double rounded(const Ball& ball, double& error) {
  const double middle = ball.middle();
  error = std::max(error, abs(ball - middle).upper());
  return middle;
}

/// The largest absolute value as a double; infinite where the ball is not known.
double bound(const Ball& ball) {
  const double most = abs(ball).upper();
  return ball.is_finite() && most >= 0 ? most : kInfinity;
}

/// The disc around two discs: the larger one if it holds the other, else one whose middle is on the line through both.
/// Rounded outwards.
void enclose(const CentreTree::Node& one, const CentreTree::Node& other, CentreTree::Node& both) {
  const double apart = std::hypot(other.x - one.x, other.y - one.y);
  const bool is_within = apart + std::min(one.radius, other.radius) <= std::max(one.radius, other.radius);
  // One without a bound makes the whole disc unbounded.
  if (is_within || !(apart < kInfinity)) {
    const CentreTree::Node& larger = one.radius > other.radius ? one : other;
    both.x = larger.x;
    both.y = larger.y;
    both.radius = apart < kInfinity ? larger.radius * kRoundUp : kInfinity;
    return;
  }
  both.radius = 0.5 * (apart + one.radius + other.radius);
  const double share = (both.radius - one.radius) / apart;
  both.x = one.x + share * (other.x - one.x);
  both.y = one.y + share * (other.y - one.y);
  both.radius = both.radius * kRoundUp + 1e-15 * (std::abs(both.x) + std::abs(both.y));
}

}  // namespace

/// Stretches of all curves and arcs at all corners, in the order of s, then joined in pairs up to the root. `radius` 0:
/// the boundary itself.
CentreTree::CentreTree(const Boundary& boundary, double radius, const std::optional<Considered>& considered)
    : boundary_(boundary), radius_(radius), period_(boundary.perimeter().middle()) {
  // Theta counts from 0 at the first point: this is the tangent's direction there.
  const Point v = boundary.velocity(boundary.front(0));
  base_ = atan2(v.y, v.x);
  for (long curve = 0; curve < boundary.curves(); ++curve) {
    add_curve(curve, considered);
    add_corner(curve, considered);
  }
  // Nothing is considered: the tree has no root.
  if (nodes_.empty()) return;
  root_ = join(0, nodes_.size());
}

/// Of all parameters of the curve, or of those whose arc lengths are on the arcs.
void CentreTree::add_curve(long curve, const std::optional<Considered>& considered) {
  const Place front = boundary_.front(curve);
  const Place back = boundary_.back(curve);
  const Interval whole{front.u.middle(), back.u.middle()};
  if (!considered) {
    add_stretch(curve, whole, 0);
    return;
  }
  // An arc that ends within the slack of a curve's end is taken to reach it.
  const double slack = kLengthSlack * period_;
  // Of the curve's parameter, one for each arc and lap that meets the curve.
  std::vector<Interval> pieces;
  for (const Interval& arc : considered->arcs) {
    for (const double lap : boundary_.laps()) {
      const double from = arc.lo + lap;
      const double to = arc.hi + lap;
      if (!(from < back.s.middle() - slack && to > front.s.middle() + slack)) continue;
      const auto parameter = [&](double s, bool is_from) {
        const std::optional<Place> place = boundary_.after(s);
        // At a joint the parameter is not known: all of the curve up to its end is the safe side.
        if (!place) return is_from ? whole.lo : whole.hi;
        // Rounded outwards: the piece holds all of the arc.
        return is_from ? place->u.lower() : place->u.upper();
      };
      Interval u = whole;
      // The arc begins on this curve.
      if (from > front.s.middle() + slack) u.lo = std::clamp(parameter(from, true), whole.lo, whole.hi);
      // The arc ends on it.
      if (to < back.s.middle() - slack) u.hi = std::clamp(parameter(to, false), whole.lo, whole.hi);
      if (u.lo < u.hi) pieces.push_back(u);
    }
  }
  std::sort(pieces.begin(), pieces.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  for (const Interval& u : pieces) add_stretch(curve, u, 0);
}

/// In parts, where all of it has no bounds.
void CentreTree::add_stretch(long curve, const Interval& u, int depth) {
  // A stretch at rest may have no bound: then it is halved until all but a tiny part has one.
  const Node node = stretch(curve, u);
  const double middle = 0.5 * (u.lo + u.hi);
  const bool is_bounded = node.radius < kInfinity && node.half_turn < kInfinity;
  if (is_bounded || depth == kMostCuts || !(middle > u.lo && middle < u.hi)) {
    add(node);
    return;
  }
  add_stretch(curve, {u.lo, middle}, depth + 1);
  add_stretch(curve, {middle, u.hi}, depth + 1);
}

/// To the slack of stated lengths, on any lap.
bool CentreTree::is_on(double s, const std::vector<Interval>& arcs) const {
  const double slack = kLengthSlack * period_;
  return std::any_of(arcs.begin(), arcs.end(), [&](const Interval& arc) {
    return std::any_of(boundary_.laps().begin(), boundary_.laps().end(),
                       [&](double lap) { return s >= arc.lo + lap - slack && s <= arc.hi + lap + slack; });
  });
}

/// Theta before the joint to Theta behind it. A smooth joint pivots by rounding; a concave corner, and an end of an
/// open outline, do not.
std::optional<Ball> CentreTree::pivots(long curve) const {
  const bool is_end = !boundary_.closed() && curve + 1 == boundary_.curves();
  if (is_end || (boundary_.turns(curve) && !boundary_.pivots(curve))) return std::nullopt;
  const Ball before = direction(boundary_.back(curve));
  return hull(before, before + boundary_.jump(curve));
}

/// A corner that is stated has the stated angles; any other one has all if its place is on an arc.
std::vector<Interval> CentreTree::angles_at(long curve, const Ball& pivots, const Considered& considered) const {
  const Interval whole{pivots.lower(), pivots.upper()};
  const double s = boundary_.back(curve).s.middle();
  const double slack = kLengthSlack * period_;
  for (const CornerAngles& stated : considered.corners) {
    // The corner at s = 0 may be stated as at P.
    const double apart = std::abs(s - stated.s);
    if (!(apart <= slack || (boundary_.closed() && std::abs(apart - period_) <= slack))) continue;
    const double turn = full_turn().middle();
    std::vector<Interval> result;
    for (const Interval& angles : stated.angles) {
      const double middle = 0.5 * (angles.lo + angles.hi);
      // Whole turns, to the lap of the corner's own angles.
      const double laps = turn * std::round((0.5 * (whole.lo + whole.hi) - middle) / turn);
      // The stated angles that the cone has.
      Interval kept{std::max(whole.lo, angles.lo + laps - kTurnSlack),
                    std::min(whole.hi, angles.hi + laps + kTurnSlack)};
      if (kept.lo - whole.lo <= kConeSlack) kept.lo = whole.lo;
      if (whole.hi - kept.hi <= kConeSlack) kept.hi = whole.hi;
      if (kept.lo <= kept.hi) result.push_back(kept);
    }
    return result;
  }
  return is_on(s, considered.arcs) ? std::vector<Interval>{whole} : std::vector<Interval>{};
}

/// The arc of centres about a corner at which the finger pivots, in pieces if only some angles are considered.
void CentreTree::add_corner(long curve, const std::optional<Considered>& considered) {
  const std::optional<Ball> all = pivots(curve);
  if (!all) return;
  std::vector<Interval> pieces{{all->lower(), all->upper()}};
  if (considered) pieces = angles_at(curve, *all, *considered);
  for (const Interval& angles : pieces) add(corner(curve, angles));
}

/// Its index.
int CentreTree::add(Node node) {
  nodes_.push_back(node);
  return static_cast<int>(nodes_.size()) - 1;
}

/// A disc about the centre at the middle parameter, and an interval about its tangent.
CentreTree::Node CentreTree::stretch(long curve, const Interval& u) const {
  Budget::spend(kNodeWork);
  const double middle = 0.5 * (u.lo + u.hi);
  const Place from = boundary_.at(curve, u.lo);
  const Place at = boundary_.at(curve, middle);
  const Place to = boundary_.at(curve, u.hi);
  // All parameters of the stretch.
  const Ball all = hull(u.lo, u.hi);
  const Ball angle = direction(at);
  const Point point = boundary_.position(at);
  const double reach = std::max(u.hi - middle, middle - u.lo);
  // The way to the longer end.
  const double length = std::max(bound(at.s - from.s), bound(to.s - at.s));
  // |Theta - Theta(middle)| <= max |dTheta/du| * half of the parameters.
  const double turn = reach > 0 ? bound(boundary_.turning(curve, all)) * reach : 0;
  Node node;
  double error = 0;
  node.x = rounded(point.x + radius_ * sin(angle), error);
  node.y = rounded(point.y - radius_ * cos(angle), error);
  node.radius = length;
  // Two bounds on the way of c: ds + r |dTheta|, and |1 + r kappa| ds, which is smaller where the curve is concave.
  if (radius_ > 0) {
    const double along = bound(1.0 + radius_ * boundary_.bend(curve, all).curvature);
    node.radius = std::min(length + radius_ * turn, length > 0 ? along * length : 0.0);
  }
  // The middle was rounded to a double in x and in y.
  node.radius = (node.radius + 2 * error) * kRoundUp;
  error = 0;
  node.angle = rounded(angle, error);
  node.half_turn = (turn + error) * kRoundUp;
  node.s = {from.s.lower(), to.s.upper()};
  node.curve = curve;
  node.u = u;
  return node;
}

/// A disc about the centre at the middle angle: the arc has the length r times the half angle to either side.
CentreTree::Node CentreTree::corner(long curve, const Interval& angles) const {
  Budget::spend(kNodeWork);
  const Place place = boundary_.back(curve);
  const Point point = boundary_.position(place);
  Node node;
  node.angle = 0.5 * (angles.lo + angles.hi);
  node.half_turn = std::max(angles.hi - node.angle, node.angle - angles.lo) * kRoundUp;
  double error = 0;
  node.x = rounded(point.x + radius_ * sin(Ball(node.angle)), error);
  node.y = rounded(point.y - radius_ * cos(Ball(node.angle)), error);
  // The next curve starts where this one ends but for the gap.
  node.radius = (radius_ * node.half_turn + 2 * error + boundary_.largest_gap()) * kRoundUp;
  node.s = {place.s.lower(), place.s.upper()};
  node.curve = curve;
  node.is_corner = true;
  node.u = angles;
  return node;
}

/// A balanced tree over nodes in order: its depth is log n.
int CentreTree::join(std::size_t from, std::size_t to) {
  if (to - from == 1) return static_cast<int>(from);
  // In order of s: neighbours are near each other, and their disc is small.
  const std::size_t middle = from + (to - from) / 2;
  Node joined;
  joined.left = join(from, middle);
  joined.right = join(middle, to);
  const Node& left = node(joined.left);
  const Node& right = node(joined.right);
  enclose(left, right, joined);
  const double lo = std::min(left.angle - left.half_turn, right.angle - right.half_turn);
  const double hi = std::max(left.angle + left.half_turn, right.angle + right.half_turn);
  joined.angle = 0.5 * (lo + hi);
  joined.half_turn = std::max(hi - joined.angle, joined.angle - lo) * kRoundUp;
  // No bound on the tangent: any angle will do as the middle.
  if (!(joined.half_turn < kInfinity)) joined.angle = 0;
  joined.s = {left.s.lo, right.s.hi};
  return add(joined);
}

/// Inner nodes have theirs; a single stretch, or an arc at a corner, is halved by its parameter and keeps the halves.
std::pair<int, int> CentreTree::halves(int index) {
  const Node whole = node(index);
  if (whole.left >= 0) return {whole.left, whole.right};
  const double middle = 0.5 * (whole.u.lo + whole.u.hi);
  if (whole.curve < 0 || !(middle > whole.u.lo && middle < whole.u.hi)) return {index, index};
  const auto half = [&](const Interval& u) {
    return add(whole.is_corner ? corner(whole.curve, u) : stretch(whole.curve, u));
  };
  const int left = half({whole.u.lo, middle});
  const int right = half({middle, whole.u.hi});
  nodes_[static_cast<std::size_t>(index)].left = left;
  nodes_[static_cast<std::size_t>(index)].right = right;
  return {left, right};
}

}  // namespace rollfix_verify
