#include "nearest.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "outline/turn.hpp"

// Notation:
//   q, tau          a touch as the part's frame has it: `InPart::at`, `tangent`
//   c(u), theta(u)  centre and tangent's angle of a place of the path: CentrePoint
//   d^2             |q - c|^2 / place_unit^2 + (tau - theta)^2 / angle_unit^2: `Distance::square`
// Idea: branch and bound over the tree of stretches, by the distance from a node's disc and from its interval of
// angles; on a stretch that bends little Newton's method, which goes on to the neighbours as long as that is downhill.
namespace rollfix::touch {
namespace {

// Newton's steps of one descent, and a step that is no more than this many units.
constexpr int kMostSteps = 40;
constexpr double kNoStep = 1e-5;
// A stretch that turns by no more, radians, has one nearest place to a touch that is not far from it.
constexpr double kOneNearest = 0.3;
// Sides that meet at a joint turn by no more, radians: a drawing's arcs are so smooth.
constexpr double kNoTurn = 1e-6;
// A place is not nearer where its squares are smaller by no more than this share, or this much.
constexpr double kNotNearer = 1e-6;

/// The place at an end of the neighbouring stretch on this side; past corners where nothing changes for this touch.
std::optional<PathPlace> neighbour(const CentrePath& path, const InPart& touch, std::size_t stretch, bool forwards) {
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

}  // namespace

namespace {

/// How far a point is from a node's disc, of a single one from the strip of it that the tangents leave.
double distance_to(const PathTree::Node& node, const Vec2& point) {
  const Vec2 off = point - node.middle;
  const double off_disc = std::max(0.0, off.norm() - node.radius);
  if (!node.is_single() || off_disc == 0) return off_disc;
  const double ahead = std::max(0.0, std::abs(off.dot(node.along)) - node.radius);
  const double aside = std::max(0.0, std::abs(cross(node.along, off)) - node.flat);
  return std::max(off_disc, std::hypot(ahead, aside));
}

}  // namespace

double least_square(const PathTree::Node& node, const InPart& touch) {
  const double place = touch.has_place ? distance_to(node, touch.at) / touch.place_unit : 0;
  if (!touch.tangent) return place * place;
  const double off = std::abs(nearest_angle(*touch.tangent - node.angle)) - node.half_turn;
  const double angle = std::max(0.0, off) / touch.angle_unit;
  return place * place + angle * angle;
}

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
    const bool is_still = here.weight == 0;
    const double curved = here.weight + here.bend;
    const double move = is_still ? 0 : here.slope / (curved > 0.25 * here.weight ? curved : here.weight);
    const double to = std::clamp(u + move, stretch.u.lo, stretch.u.hi);
    const bool at_lo = to == stretch.u.lo && u == to && (move < 0 || is_still);
    const bool at_hi = to == stretch.u.hi && u == to && (move > 0 || is_still);
    if (!is_still && !at_lo && !at_hi && std::abs(move) * std::sqrt(here.weight) <= kNoStep) return best;
    if (at_lo || at_hi || is_still) {
      std::optional<OnPath> next;
      if (at_hi || is_still) next = beyond(path, touch, from, true);
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

namespace {

/// Makes the best place known the nearest of all, if any is nearer than `least`. Of a node that holds the place
/// `known` nothing else is looked at where it has one nearest place.
void look_for_nearer(PathTree& tree, const InPart& touch, double least, const PathPlace* known,
                     std::optional<OnPath>& best) {
  boost::container::small_vector<std::pair<double, std::int32_t>, 64> waiting{{0.0, tree.root()}};
  while (!waiting.empty()) {
    const auto [bound, index] = waiting.back();
    waiting.pop_back();
    if (bound >= least) continue;
    const PathTree::Node& node = tree.node(index);
    const bool is_plain = node.is_single() && node.half_turn <= 0.5 * kOneNearest;
    const PathPlace middle{static_cast<std::size_t>(node.stretch), node.u.middle()};
    const bool is_known = is_plain && known != nullptr && known->stretch == middle.stretch && node.u.contains(known->u);
    if (is_known) continue;
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
    waiting.emplace_back(std::max(of_left, of_right), left_first ? right : left);
    waiting.emplace_back(std::min(of_left, of_right), left_first ? left : right);
  }
}

}  // namespace

OnPath nearest_place(PathTree& tree, const InPart& touch) {
  std::optional<OnPath> best;
  look_for_nearer(tree, touch, std::numeric_limits<double>::infinity(), nullptr, best);
  return best.value_or(OnPath{});
}

std::optional<OnPath> nearer_place(PathTree& tree, const InPart& touch, const OnPath& than) {
  const double here = distance_at(than.point, touch).square;
  std::optional<OnPath> best;
  look_for_nearer(tree, touch, here - kNotNearer * (1 + here), &than.place, best);
  return best;
}

}  // namespace rollfix::touch
