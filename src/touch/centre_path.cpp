#include "centre_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "part/cursor.hpp"
#include "part/part_data.hpp"
#include "rollfix/part.hpp"

// Notation:
//   p(s), n(s)      the boundary and its outward normal, r the finger's radius
//   u               place on a stretch of the path: arc length s along a spiral, the tangent's angle theta at a corner
//   c(u)            the finger's centre there: p + r n along a spiral, about a convex corner p + r n(theta), theta in
//                   between the sides' angles: `CentrePath::at`
//   stretches       these pieces in order, without those that the finger's reach or a roll's readings leave out
//   (c, rho)        the disc that holds the centres of a node of the tree: `middle`, `radius`
//   theta +- w      the tangents on it: `angle`, `half_turn`
//   number          a place's number, growing along the path, by which neighbours are known
// A finger without size has the boundary itself for its path, and at a corner a stretch of no length that turns.
// Follows docs/touch.md, "How it works".
// Idea: a stretch's disc is about its middle place, with the way to the further end as its radius; on a spiral Theta is
// monotone, so that its ends bound it. Two nodes have the smallest disc around both.
namespace rollfix::touch {
namespace {

// A jump of Theta that is smaller, radians, is rounding and no corner.
// Two stretches then follow one another without a pivot between them.
constexpr double kNoCorner = 1e-11;

/// What an arc of the boundary and a spiral have in common, at most two pieces.
/// `arc`: lo in [0, P), hi may exceed P: then a closed boundary is looked at once more, a lap back. Pieces that are
/// points are left out.
std::vector<Interval> within(const Interval& arc, const Interval& spiral, const Boundary& boundary) {
  std::vector<Interval> pieces;
  for (const double shift : {0.0, boundary.perimeter}) {
    if (shift > 0 && !boundary.closed) break;
    const Interval piece{std::max(spiral.lo, arc.lo - shift), std::min(spiral.hi, arc.hi - shift)};
    if (piece.lo < piece.hi) pieces.push_back(piece);
  }
  std::sort(pieces.begin(), pieces.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  return pieces;
}

/// What some arcs of the boundary and a spiral have in common, in order.
std::vector<Interval> on_arcs(const std::vector<Interval>& arcs, const Interval& spiral, const Boundary& boundary) {
  std::vector<Interval> pieces;
  for (const Interval& arc : arcs) {
    for (const Interval& piece : within(arc, spiral, boundary)) pieces.push_back(piece);
  }
  std::sort(pieces.begin(), pieces.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  return pieces;
}

/// The tangent's angles at which a disk can touch the corner where spiral k starts.
/// Without a finger's reach, of a point, all between both sides. Of a disk those of its pivots; at a jump that Reach
/// does not have as a corner all or none, by whether the place is within reach.
std::vector<Interval> angles_at(const std::optional<Reach>& reach, const Cursor& corner) {
  const double before = corner.angle_before();
  const double after = corner.angle_after();
  const Interval whole{std::min(before, after), std::max(before, after)};
  if (!reach) return {whole};
  for (const PivotReach& pivot : reach->pivots) {
    if (pivot.s == corner.spiral().lo) return pivot.angles;
  }
  return reach->contains(corner.spiral().lo) ? std::vector<Interval>{whole} : std::vector<Interval>{};
}

/// Of these angles at a corner those that a contact is confined to.
/// `s`: of the corner. None where no arc of the contact holds the corner.
std::vector<Interval> pivots_of(const std::vector<Interval>& angles, const Confined* confined, const Boundary& boundary,
                                double s) {
  if (confined == nullptr) return angles;
  const double rounding = kLengthAccuracy * boundary.perimeter;
  const bool is_on = std::any_of(confined->arcs.begin(), confined->arcs.end(),
                                 [&](const Interval& arc) { return boundary.contains(arc, s, rounding); });
  std::vector<Interval> kept;
  for (const Interval& piece : angles) {
    const Interval within = is_on && confined->angles ? confined->angles(s, piece) : piece;
    if (is_on && within.lo <= within.hi) kept.push_back(within);
  }
  return kept;
}

// Positions are rounded: this share of the perimeter.
constexpr double kDiscRounding = 4e-15;

/// The smallest disc around two.
/// c and rho alone. Its diameter is rho_1 + |c_1 - c_2| + rho_2, on the line through both middles; widened by 1e-14 of
/// itself for rounding. One disc inside the other: that one.
void enclose(const PathTree::Node& one, const PathTree::Node& other, PathTree::Node& both) {
  const Vec2 between = other.middle - one.middle;
  const double apart = between.norm();
  if (apart + other.radius <= one.radius || apart + one.radius <= other.radius) {
    const PathTree::Node& larger = one.radius > other.radius ? one : other;
    both.middle = larger.middle;
    both.radius = larger.radius;
    return;
  }
  both.radius = 0.5 * (apart + one.radius + other.radius) * (1 + 1e-14);
  both.middle = one.middle + between * ((both.radius - one.radius) / apart);
}

}  // namespace

/// May be empty: a disk that fits nowhere, or a contact that is confined to nothing.
CentrePath::CentrePath(const Part& part, double radius, const Confined* confined) : part_(part), radius_(radius) {
  add_spirals(confined);
  connect();
}

/// Stretches in order along the boundary: before each spiral the pivots of the corner at its start, then the pieces of
/// it that reach and `confined` leave. `diagonal_` is of a box of points, not of the exact one: the ends and the
/// middles of spirals.
void CentrePath::add_spirals(const Confined* confined) {
  const TurningFunction& turning = part_.turning();
  const std::vector<Spiral>& spirals = turning.spirals();
  std::optional<Reach> reach;
  if (radius_ > 0) reach = reach_of_disk(part_, radius_);
  Vec2 least = part_.point(0), most = least;
  for (std::size_t k = 0; k < spirals.size(); ++k) {
    const Cursor start = Cursor::at_spiral(turning, k);
    const double jump = start.jump();
    // A concave corner of a drawing has no pivot, as no finger rolls over it. A jump backwards that is as small as a
    // joint's has: Theta takes every value in between there.
    const bool is_corner = jump > kNoCorner || (jump < -kNoCorner && jump > -kJointTurn);
    if (is_corner) add_corner(k, pivots_of(angles_at(reach, start), confined, part_.boundary(), spirals[k].lo));
    std::vector<Interval> pieces{{spirals[k].lo, spirals[k].hi}};
    // What both the finger's reach and the roll's readings leave.
    if (reach) pieces = on_arcs(reach->arcs, pieces.front(), part_.boundary());
    if (confined != nullptr) {
      std::vector<Interval> kept;
      for (const Interval& piece : pieces) {
        const std::vector<Interval> more = on_arcs(confined->arcs, piece, part_.boundary());
        kept.insert(kept.end(), more.begin(), more.end());
      }
      pieces = std::move(kept);
    }
    for (const Interval& piece : pieces) {
      CentreStretch stretch;
      stretch.u = piece;
      stretch.spiral = k;
      stretch.angle = {turning.on_spiral(spirals[k], piece.lo).angle, turning.on_spiral(spirals[k], piece.hi).angle};
      // Theta falls where the part is concave.
      if (stretch.angle.lo > stretch.angle.hi) std::swap(stretch.angle.lo, stretch.angle.hi);
      add(stretch);
    }
    for (const double s : {spirals[k].lo, 0.5 * (spirals[k].lo + spirals[k].hi)}) {
      least = least.cwiseMin(part_.point(s));
      most = most.cwiseMax(part_.point(s));
    }
  }
  diagonal_ = (most - least).norm();
}

/// At a corner u is the tangent's angle itself.
void CentrePath::add_corner(std::size_t spiral, const std::vector<Interval>& angles) {
  for (const Interval& piece : angles) {
    CentreStretch stretch;
    stretch.u = stretch.angle = piece;
    stretch.corner = true;
    stretch.spiral = spiral;
    stretch.s = part_.turning().spirals()[spiral].lo;
    stretch.point = part_.point(stretch.s);
    add(stretch);
  }
}

void CentrePath::add(CentreStretch stretch) { stretches_.push_back(std::move(stretch)); }

/// Neighbours share a place of the boundary, whatever the tangent does there. What is out of reach lies between others.
void CentrePath::connect() {
  if (stretches_.empty()) return;
  const double rounding = kLengthAccuracy * part_.perimeter();
  const auto lo = [](const CentreStretch& one) { return one.corner ? one.s : one.u.lo; };
  const auto hi = [](const CentreStretch& one) { return one.corner ? one.s : one.u.hi; };
  // Pivots at one corner that lie apart do not follow one another.
  // Places of the boundary are one where they differ by no more than rounding.
  const auto joined = [&](const CentreStretch& one, const CentreStretch& next) {
    const bool both = one.corner && next.corner && one.spiral == next.spiral;
    return !both && part_.boundary().distance(hi(one), lo(next)) <= rounding;
  };
  // A stretch has the numbers from its own to the next whole one; a gap takes a number that no place has.
  double number = 0;
  for (std::size_t k = 0; k < stretches_.size(); ++k) {
    if (k > 0 && joined(stretches_[k - 1], stretches_[k])) {
      stretches_[k].before = k - 1;
      stretches_[k - 1].after = k;
    } else if (k > 0) {
      number += 1;  // a gap: places with neighbouring numbers are neighbours
    }
    stretches_[k].number = number;
    number += 1;
  }
  if (!part_.closed() || !joined(stretches_.back(), stretches_.front())) return;
  stretches_.back().after = 0;
  stretches_.front().before = stretches_.size() - 1;
  // The last stretch leads on to the first: numbers go round. Of an open path, or one with a gap there, they do not.
  period_ = number;
}

/// c(u), dc/du, theta(u), dtheta/du. On a spiral dc/du = (1 + r kappa) t, which points backwards where the disk is too
/// large for a concave stretch; at a corner r t, with t the tangent.
CentrePoint CentrePath::at(const PathPlace& place) const {
  const CentreStretch& stretch = stretches_[place.stretch];
  const TurningFunction& turning = part_.turning();
  CentrePoint point;
  if (stretch.corner) {
    const Vec2 tangent(std::cos(place.u), std::sin(place.u));
    point.centre = stretch.point + radius_ * Vec2(tangent.y(), -tangent.x());
    point.along = radius_ * tangent;
    point.angle = place.u;
    point.bend = 1;
    point.s = stretch.s;
    return point;
  }
  const Spiral& spiral = turning.spirals()[stretch.spiral];
  const std::uint32_t panel = turning.panel_index(spiral.first_panel, spiral.last_panel, place.u);
  const Turning at = turning.on_panel(turning.panels()[panel], place.u);
  const Vec2 tangent(std::cos(at.angle), std::sin(at.angle));
  point.centre = PartAccess::point(part_, panel, place.u) + radius_ * Vec2(tangent.y(), -tangent.x());
  point.along = (1 + radius_ * at.curvature) * tangent;
  point.angle = at.angle;
  point.bend = at.curvature;
  point.s = place.u;
  return point;
}

/// c - r n, n = (sin theta, -cos theta) outward.
Vec2 CentrePath::contact(const PathPlace& place) const {
  const CentrePoint point = at(place);
  return point.centre - radius_ * Vec2(std::sin(point.angle), -std::cos(point.angle));
}

/// At a corner r times the angle. On a spiral the integral of (1 + r kappa) ds, or where that is below 0 anywhere the
/// bound ds + r |dTheta|.
double CentrePath::length(const CentreStretch& stretch, const Interval& u) const {
  if (stretch.corner) return radius_ * u.width();
  const TurningFunction& turning = part_.turning();
  const Spiral& spiral = turning.spirals()[stretch.spiral];
  const Turning lo = turning.on_spiral(spiral, u.lo);
  const Turning hi = turning.on_spiral(spiral, u.hi);
  // The curvature is monotone: its ends bound it, and where 1 + r kappa keeps its sign the length is its integral.
  const double turn = radius_ * (hi.angle - lo.angle);
  const bool is_forwards = 1 + radius_ * std::min(lo.curvature, hi.curvature) >= 0;
  return is_forwards ? u.width() + turn : u.width() + std::abs(turn);
}

/// Of the whole path down to single stretches: one node for each, joined two by two. Halves of stretches come later,
/// when the search asks.
PathTree::PathTree(const CentrePath& path) : path_(path) { root_ = join(0, path.stretches().size()); }

/// A node of part of one stretch. The disc is about the centre at its middle u; no centre is further than the longer
/// way to an end. `flat`: going from the middle no step leaves the line's direction by more than the half turn, so
/// aside is at most radius times its sine.
std::int32_t PathTree::add_single(std::int32_t stretch, const Interval& u, const Interval& number) {
  const CentreStretch& whole = path_.stretches()[static_cast<std::size_t>(stretch)];
  const auto angle_at = [&](double place) {
    return whole.corner ? place
                        : path_.part().turning().on_spiral(path_.part().turning().spirals()[whole.spiral], place).angle;
  };
  Node node;
  node.stretch = stretch;
  node.u = u;
  node.number = number;
  node.middle = path_.at({static_cast<std::size_t>(stretch), u.middle()}).centre;
  node.radius = std::max(path_.length(whole, {u.lo, u.middle()}), path_.length(whole, {u.middle(), u.hi})) +
                kDiscRounding * path_.part().perimeter();
  const double at_lo = angle_at(u.lo);  // Theta is monotone on a spiral
  const double at_hi = angle_at(u.hi);
  node.angle = 0.5 * (at_lo + at_hi);
  node.half_turn = 0.5 * std::abs(at_hi - at_lo) + kTurnAccuracy;
  node.along = {std::cos(node.angle), std::sin(node.angle)};
  node.flat = node.radius * std::sin(std::min(node.half_turn, 0.5 * std::numbers::pi)) +
              kDiscRounding * path_.part().perimeter();
  nodes_.push_back(node);
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

/// A node of the stretches from `from` up to `to`, balanced by their number. Angles are unwrapped along the boundary,
/// so that the interval around both children's is one.
std::int32_t PathTree::join(std::size_t from, std::size_t to) {
  if (to - from == 1) {
    const CentreStretch& stretch = path_.stretches()[from];
    return add_single(static_cast<std::int32_t>(from), stretch.u, {stretch.number, stretch.number + 1});
  }
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
  joined.half_turn = 0.5 * (hi - lo);
  joined.flat = joined.radius;
  joined.number = {left.number.lo, right.number.hi};
  nodes_.push_back(joined);
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

/// New nodes only where none were asked for before: `left` is set then. `nodes_` may move, so `whole` is a copy.
std::pair<std::int32_t, std::int32_t> PathTree::halves(std::int32_t index) {
  const Node whole = node(index);
  if (whole.left >= 0) return {whole.left, whole.right};
  const double middle = whole.u.middle();
  const double number = whole.number.middle();
  // Nothing lies between its ends in doubles, neither in u nor in its numbers.
  const bool is_point =
      !(middle > whole.u.lo && middle < whole.u.hi) || !(number > whole.number.lo && number < whole.number.hi);
  if (is_point) return {index, index};
  const std::int32_t left = add_single(whole.stretch, {whole.u.lo, middle}, {whole.number.lo, number});
  const std::int32_t right = add_single(whole.stretch, {middle, whole.u.hi}, {number, whole.number.hi});
  nodes_[static_cast<std::size_t>(index)].left = left;
  nodes_[static_cast<std::size_t>(index)].right = right;
  return {left, right};
}

}  // namespace rollfix::touch
