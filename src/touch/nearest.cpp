#include "nearest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "outline/turn.hpp"

namespace rollfix::touch {
namespace {

// Newton's steps of one descent, and a step that is no more than this many units.
constexpr int kMostSteps = 40;
constexpr double kNoStep = 1e-5;
// A stretch that turns by no more, radians, has one nearest place to a touch that is not far from it.
constexpr double kOneNearest = 0.3;

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

/// Where it goes on downhill beyond this end of a stretch.
std::optional<PathPlace> beyond(const CentrePath& path, const InPart& touch, std::size_t stretch, bool forwards) {
  const std::optional<PathPlace> next = neighbour(path, touch, stretch, forwards);
  if (!next) return std::nullopt;
  const double slope = distance_at(path.at(*next), touch).slope;
  return (forwards ? slope > 0 : slope < 0) ? next : std::nullopt;
}

}  // namespace

double least_square(const PathTree::Node& node, const InPart& touch) {
  const double off_disc = touch.has_place ? (touch.at - node.middle).norm() - node.radius : 0;
  const double place = std::max(0.0, off_disc) / touch.place_unit;
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
    distance = {off.squaredNorm(), off.dot(along), along.squaredNorm()};
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

PathPlace downhill(const CentrePath& path, const InPart& touch, PathPlace from) {
  double last = std::numeric_limits<double>::infinity();
  PathPlace best = from;
  double shortened = 1;
  for (int step = 0; step < kMostSteps; ++step) {
    const CentreStretch& stretch = path.stretches()[from.stretch];
    const Distance here = distance_at(path.at(from), touch);
    if (here.square > last) {  // too far: half of it
      shortened *= 0.5;
      from.u = best.stretch == from.stretch ? 0.5 * (best.u + from.u) : from.u;
      if (best.stretch != from.stretch || shortened < 1e-6) return best;
      continue;
    }
    last = here.square;
    best = from;
    shortened = 1;
    const bool is_still = here.weight == 0;
    const double move = is_still ? 0 : here.slope / here.weight;
    const double to = std::clamp(from.u + move, stretch.u.lo, stretch.u.hi);
    const bool at_lo = to == stretch.u.lo && from.u == to && (move < 0 || is_still);
    const bool at_hi = to == stretch.u.hi && from.u == to && (move > 0 || is_still);
    if (!is_still && !at_lo && !at_hi && std::abs(move) * std::sqrt(here.weight) <= kNoStep) return best;
    if (at_lo || at_hi || is_still) {
      std::optional<PathPlace> next;
      if (at_hi || is_still) next = beyond(path, touch, from.stretch, true);
      if (!next && (at_lo || is_still)) next = beyond(path, touch, from.stretch, false);
      if (!next) return best;
      from = *next;
      last = std::numeric_limits<double>::infinity();  // a drawing's joints may have gaps
      continue;
    }
    from.u = to;
  }
  return best;
}

PathPlace nearest_place(PathTree& tree, const InPart& touch) {
  PathPlace best;
  double least = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, std::int32_t>> waiting{{0.0, tree.root()}};
  while (!waiting.empty()) {
    const auto [bound, index] = waiting.back();
    waiting.pop_back();
    if (bound >= least) continue;
    const PathTree::Node node = tree.node(index);
    const bool is_plain = node.is_single() && node.half_turn <= 0.5 * kOneNearest;
    const auto [left, right] = is_plain ? std::make_pair(index, index) : tree.halves(index);
    if (left == right) {
      const PathPlace place = downhill(tree.path(), touch, {static_cast<std::size_t>(node.stretch), node.u.middle()});
      const double square = distance_at(tree.path().at(place), touch).square;
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
  return best;
}

}  // namespace rollfix::touch
