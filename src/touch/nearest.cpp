#include "nearest.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "outline/turn.hpp"

// Notation:
//   q, tau          a touch as the part's frame has it: `InPart::at`, `tangent`
//   c(u), theta(u)  centre and tangent's angle of a place of the path: CentrePoint
//   d^2             |q - c|^2 / place_unit^2 + (tau - theta)^2 / angle_unit^2: `Distance::square`
// Idea: branch and bound over the tree of stretches, by the distance from a node's disc and from its interval of
// angles; on a stretch that bends little Newton's method, which goes on to the neighbours as long as that is downhill.
// How far a point is from the part is asked of the path of a finger without size: docs/touch.md, "Where nothing was
// touched".
namespace rollfix::touch {
namespace {

// Newton's steps of one descent, and a step that is no more than this many units.
// A drawing's many short curves take a step each.
constexpr int kMostSteps = 40;
constexpr double kNoStep = 1e-5;
// A stretch that turns by no more, radians, has one nearest place to a touch that is not far from it.
constexpr double kOneNearest = 0.3;
// Sides that meet at a joint turn by no more, radians: a drawing's arcs are so smooth.
constexpr double kNoTurn = 1e-6;
// A place is not nearer where its squares are smaller by no more than this share, or this much.
// Without it rounding alone would look like a nearer place.
constexpr double kNotNearer = 1e-6;

/// The place at an end of the neighbouring stretch on this side; past corners where nothing changes for this touch.
/// None beyond an end of an open outline, or beside a gap of the finger's reach. A corner is nothing for a point
/// without a normal: its stretch has one centre, and no residual changes on it.
std::optional<PathPlace> neighbour(const CentrePath& path, const InPart& touch, std::size_t stretch, bool forwards) {
  // No more than a few such corners lie next to each other.
  for (std::size_t passed = 0; passed < 3; ++passed) {
    const CentreStretch& from = path.stretches()[stretch];
    const std::optional<std::size_t> next = forwards ? from.after : from.before;
    if (!next) return std::nullopt;
    const CentreStretch& to = path.stretches()[*next];
    const bool is_nothing = to.corner && path.radius() == 0 && !touch.tangent;
    if (!is_nothing) return PathPlace{*next, forwards ? to.u.lo : to.u.hi};
    stretch = *next;
  }
  return std::nullopt;
}

/// Where it goes on downhill beyond the end of a stretch at which it is.
/// None where the squares rise from there on: then the end is the nearest place so far.
std::optional<OnPath> beyond(const CentrePath& path, const InPart& touch, const OnPath& here, bool forwards) {
  const std::optional<PathPlace> next = neighbour(path, touch, here.place.stretch, forwards);
  if (!next) return std::nullopt;
  const OnPath there{*next, path.at(*next)};
  const Distance then = distance_at(there.point, touch);
  if (forwards ? then.slope <= 0 : then.slope >= 0) return std::nullopt;
  // At a concave corner, where nothing leads from one normal to the other, the next side may be a step up.
  const bool turns = touch.tangent && std::abs(nearest_angle(there.point.angle - here.point.angle)) > kNoTurn;
  if (turns && then.square > distance_at(here.point, touch).square) return std::nullopt;
  return there;
}

/// How far a point is from a node's disc, of a single one from the strip of it that the tangents leave.
/// At least so far: no centre of the node is nearer.
double distance_to(const PathTree::Node& node, const Vec2& point) {
  const Vec2 off = point - node.middle;
  const double off_disc = std::max(0.0, off.norm() - node.radius);
  if (!node.is_single() || off_disc == 0) return off_disc;
  const double ahead = std::max(0.0, std::abs(off.dot(node.along)) - node.radius);
  const double aside = std::max(0.0, std::abs(cross(node.along, off)) - node.flat);
  return std::max(off_disc, std::hypot(ahead, aside));
}

/// Makes the best place known the nearest of all, if any is nearer than `least`. Of a node that holds the place
/// `known` nothing else is looked at where it has one nearest place.
/// Branch and bound, the more promising half first. `waiting` has lower bounds of d^2; a node goes where its bound is
/// no less than the least square known. A node that turns by no more than kOneNearest ends in a descent.
void look_for_nearer(PathTree& tree, const InPart& touch, double least, const PathPlace* known,
                     std::optional<OnPath>& best) {
  boost::container::small_vector<std::pair<double, std::int32_t>, 64> waiting{{0.0, tree.root()}};
  while (!waiting.empty()) {
    const auto [bound, index] = waiting.back();
    waiting.pop_back();
    if (bound >= least) continue;
    const PathTree::Node& node = tree.node(index);
    // So little turn leaves one nearest place on the node: Newton's method from its middle finds it.
    const bool is_plain = node.is_single() && node.half_turn <= 0.5 * kOneNearest;
    const PathPlace middle{static_cast<std::size_t>(node.stretch), node.u.middle()};
    const bool is_known = is_plain && known != nullptr && known->stretch == middle.stretch && node.u.contains(known->u);
    if (is_known) continue;
    // A node too short to be halved counts as plain as well.
    const auto [left, right] = is_plain ? std::make_pair(index, index) : tree.halves(index);
    if (left == right) {
      const OnPath place = downhill(tree.path(), touch, {middle, tree.path().at(middle)});
      const double square = distance_at(place.point, touch).square;
      if (square < least) {
        least = square;
        best = place;
      }
      continue;
    }
    const double of_left = least_square(tree.node(left), touch);
    const double of_right = least_square(tree.node(right), touch);
    const bool left_first = of_left <= of_right;
    // On a stack the last one is looked at first: the nearer half.
    waiting.emplace_back(std::max(of_left, of_right), left_first ? right : left);
    waiting.emplace_back(std::min(of_left, of_right), left_first ? left : right);
  }
}

// The tangents beside a place, for the side that a point is on, are taken so far from it, in shares of the perimeter.
constexpr double kBeside = 1e-8;
// There is a corner where they differ by more, radians.
constexpr double kCornerTurn = 1e-4;
// So near to the boundary, in shares of its diagonal, the direction of a smooth side is that of its normal: the nearest
// point is known no better.
constexpr double kAtBoundary = 1e-5;
// Places of a hole's box, each way, among which its middle is looked for.
constexpr int kLooks = 16;

}  // namespace

/// d^2 is at least (distance to disc or strip / place_unit)^2 + (angle off the interval / angle_unit)^2.
double least_square(const PathTree::Node& node, const InPart& touch) {
  const double place = touch.has_place ? distance_to(node, touch.at) / touch.place_unit : 0;
  if (!touch.tangent) return place * place;
  const double off = std::abs(nearest_angle(*touch.tangent - node.angle)) - node.half_turn;
  const double angle = std::max(0.0, off) / touch.angle_unit;
  return place * place + angle * angle;
}

/// With v the residuals' derivative by u: `slope` is -v.r, `weight` v.v; `bend` is -r . c'' / unit^2, with c'' taken as
/// that of a circle, bend times the left normal of c'. No residual of what was not measured.
Distance distance_at(const CentrePoint& point, const InPart& touch) {
  Distance distance;
  if (touch.has_place) {
    const Vec2 off = (touch.at - point.centre) / touch.place_unit;
    const Vec2 along = point.along / touch.place_unit;
    distance = {off.squaredNorm(), off.dot(along), along.squaredNorm(), -point.bend * cross(along, off)};
  }
  if (touch.tangent) {
    const double angle = nearest_angle(*touch.tangent - point.angle) / touch.angle_unit;
    const double bend = point.bend / touch.angle_unit;
    distance.square += angle * angle;
    distance.slope += angle * bend;
    distance.weight += bend * bend;
  }
  return distance;
}

/// Newton's method on d^2 / 2, clamped to the stretch; at an end it goes on to the neighbour if that is downhill. A
/// step that makes d^2 larger is halved until it does not. Ends at a local minimum, or after kMostSteps at the best
/// place met.
OnPath downhill(const CentrePath& path, const InPart& touch, OnPath from) {
  double last = std::numeric_limits<double>::infinity();
  OnPath best = from;
  double shortened = 1;
  const auto go_to = [&](double u) {
    from.place.u = u;
    from.point = path.at(from.place);
  };
  for (int step = 0; step < kMostSteps; ++step) {
    const CentreStretch& stretch = path.stretches()[from.place.stretch];
    const Distance here = distance_at(from.point, touch);
    if (here.square > last) {  // too far: half of it
      shortened *= 0.5;
      if (best.place.stretch != from.place.stretch || shortened < 1e-6) return best;
      go_to(0.5 * (best.place.u + from.place.u));
      continue;
    }
    last = here.square;
    best = from;
    shortened = 1;
    const double u = from.place.u;
    // Nothing changes along this stretch, as at a corner that a point touches: go on to a neighbour.
    const bool is_still = here.weight == 0;
    // The full second derivative, unless the bend makes it so small or negative that the step would be wild: then
    // Gauss-Newton's.
    const double curved = here.weight + here.bend;
    const double move = is_still ? 0 : here.slope / (curved > 0.25 * here.weight ? curved : here.weight);
    const double to = std::clamp(u + move, stretch.u.lo, stretch.u.hi);
    const bool at_lo = to == stretch.u.lo && u == to && (move < 0 || is_still);
    const bool at_hi = to == stretch.u.hi && u == to && (move > 0 || is_still);
    // The step is small in units of residuals: settled.
    if (!is_still && !at_lo && !at_hi && std::abs(move) * std::sqrt(here.weight) <= kNoStep) return best;
    if (at_lo || at_hi || is_still) {
      std::optional<OnPath> next;
      if (at_hi || is_still) next = beyond(path, touch, from, true);
      // No neighbour on that side, or uphill there.
      if (!next && (at_lo || is_still)) next = beyond(path, touch, from, false);
      if (!next) return best;
      from = *next;
      last = std::numeric_limits<double>::infinity();  // a drawing's joints may have gaps
      continue;
    }
    go_to(to);
  }
  return best;
}

/// REQUIRES a path with a stretch.
OnPath nearest_place(PathTree& tree, const InPart& touch) {
  std::optional<OnPath> best;
  look_for_nearer(tree, touch, std::numeric_limits<double>::infinity(), nullptr, best);
  return best.value_or(OnPath{});
}

/// The bound starts below d^2 at `than`, so that most nodes go at once.
std::optional<OnPath> nearer_place(PathTree& tree, const InPart& touch, const OnPath& than) {
  const double here = distance_at(than.point, touch).square;
  std::optional<OnPath> best;
  look_for_nearer(tree, touch, here - kNotNearer * (1 + here), &than.place, best);
  return best;
}

/// The grid's box is the square around the disc of the root, so that it holds all of the part. A corner of it lies
/// outside of a solid part; inside of it only if the material is outside of the outline.
PartDistance::PartDistance(const Part& part) : part_(part), boundary_(part_, 0), tree_(boundary_) {
  const PathTree::Node& all = tree_.node(tree_.root());
  corner_ = all.middle - Vec2::Constant(all.radius);
  cell_ = Vec2::Constant(2 * all.radius / kCells);
  is_hole_ = part_.closed() && nearest(corner_).distance < 0;
}

/// Of kLooks x kLooks places of a grid, the one that is furthest from the material.
Vec2 PartDistance::middle_of_hole() {
  Vec2 best = corner_;
  double most = -std::numeric_limits<double>::infinity();
  for (int row = 0; row < kLooks; ++row) {
    for (int column = 0; column < kLooks; ++column) {
      const Vec2 place = corner_ + cell_.x() * kCells / kLooks * Vec2(column + 0.5, row + 0.5);
      const double distance = nearest(place).distance;
      if (distance <= most) continue;
      most = distance;
      best = place;
    }
  }
  return best;
}

/// Distance changes by no more than one goes.
/// In a cell of the grid that is the distance at the cell's middle, more or less how far the point is from there; cells
/// are filled when they are first asked for. Beyond the grid: from the way to its square to the square's diagonal more.
Interval PartDistance::between(const Vec2& point) {
  const Vec2 far = ((point - corner_).cwiseQuotient(cell_) / kCells - Vec2::Constant(0.5)).cwiseAbs();
  if (far.maxCoeff() >= 0.5) {
    const double out = (far - Vec2::Constant(0.5)).cwiseMax(0).norm() * cell_.x() * kCells;
    const Interval beyond{out, out + cell_.norm() * kCells};
    return is_hole_ ? Interval{-beyond.hi, -beyond.lo} : beyond;
  }
  const Vec2 number = ((point - corner_).cwiseQuotient(cell_)).array().floor();
  const int column = std::clamp(static_cast<int>(number.x()), 0, kCells - 1);
  const int row = std::clamp(static_cast<int>(number.y()), 0, kCells - 1);
  const Vec2 middle = corner_ + cell_.cwiseProduct(Vec2(column + 0.5, row + 0.5));
  of_cell_.resize(kCells * kCells, std::numeric_limits<double>::quiet_NaN());
  double& distance = of_cell_[static_cast<std::size_t>(row * kCells + column)];
  if (std::isnan(distance)) distance = nearest(middle).distance;
  const double off = (point - middle).norm();
  return {distance - off, distance + off};
}

/// The side of a corner is that of both normals together.
/// The nearest point of the boundary by branch and bound; its sign by the normals just before and behind that point.
NearestOfPart PartDistance::nearest(const Vec2& point) {
  InPart at;
  at.at = point;
  const CentrePoint place = nearest_place(tree_, at).point;
  const Vec2 off = point - place.centre;
  NearestOfPart result;
  result.contact = place.centre;
  result.s = place.s;
  result.distance = off.norm();
  const double before = part_.tangent(place.s - kBeside * part_.perimeter());
  const double after = part_.tangent(place.s + kBeside * part_.perimeter());
  const Vec2 outward(std::sin(before) + std::sin(after), -std::cos(before) - std::cos(after));
  const bool is_corner = place.along.isZero() || std::abs(nearest_angle(after - before)) > kCornerTurn;
  result.curvature = is_corner ? std::numeric_limits<double>::infinity() : place.bend;
  const bool is_inside = part_.closed() && off.dot(outward) < 0;
  result.away = result.distance > 0 ? Vec2(off / result.distance) : outward.normalized();
  // So near to it `off` is little more than rounding: the normal gives direction and sign.
  if (!is_corner && result.distance <= kAtBoundary * diagonal()) {
    result.away = outward.normalized();
    result.distance = off.dot(result.away);
    // An open outline has two outsides: the distance is positive on both.
    if (part_.closed() || result.distance >= 0) return result;
    result.distance = -result.distance;
    result.away = -result.away;
    return result;
  }
  if (!is_inside) return result;
  result.distance = -result.distance;
  result.away = -result.away;
  return result;
}

}  // namespace rollfix::touch
