#include "wheel_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

// Notation:
//   c(u)            the pin while the wheel touches at u: p + r n, touch::CentrePath
//   x               a point of the part's frame; e = x - c: `off`
//   n, T            normal and tangent at the nearest c: `away`, `along`
// Idea: a wheel that touches, and enters the part nowhere, has its pin on the boundary's offset as far as the disk
// reaches, with an arc about each convex corner. A pin that is measured is that far from it.
namespace rollfix::hold {
namespace {

// A nearest place is settled to this share of the part's diagonal: its distance far better.
constexpr double kPinUnit = 1e-4;
// Beyond this share of it e has a part along the path: the place is an end, and no foot.
constexpr double kNoFoot = 1e-4;
// So near to the path, in diagonals, it has none that is told from rounding.
constexpr double kOnPath = 1e-8;
constexpr std::size_t kMostStretches = 256;
// A descent from another row's place is that row's part of the path if it is no further than this share of the radius.
constexpr double kSameFoot = 0.2;

}  // namespace

WheelPath::WheelPath(const Part& part, double radius) : path_(part, radius) {
  if (is_empty()) return;
  tree_.emplace(path_);
  unit_ = kPinUnit * path_.diagonal();
  if (part.closed()) spin_period_ = std::abs(part.turning().period_turn() + part.perimeter() / radius);
}

touch::InPart WheelPath::seen(const Vec2& point) const {
  touch::InPart seen;
  seen.at = point;
  seen.place_unit = unit_;
  return seen;
}

NearPin WheelPath::described(const Vec2& point, const touch::PathPlace& place) const {
  const touch::CentrePoint at = path_.at(place);
  const bool is_corner = path_.stretches()[place.stretch].corner;
  const Vec2 tangent(std::cos(at.angle), std::sin(at.angle)), normal(tangent.y(), -tangent.x());
  Vec2 off = point - at.centre;
  NearPin near;
  near.s = at.s;
  near.angle = at.angle;
  near.away = normal;
  near.distance = off.dot(normal);
  const double beside = off.dot(tangent);
  const double pace = std::max(at.along.norm(), 1e-12);  // of the pin, per u
  const bool is_end = std::abs(beside) > kNoFoot * std::abs(near.distance) + kOnPath * path_.diagonal();
  if (is_end) {
    near.distance = std::copysign(off.norm(), near.distance);
    near.away = off / near.distance;
    return near;
  }
  near.along = tangent;
  near.turn_per_length = at.bend / pace;
  near.contact_per_length = is_corner ? 0 : 1 / pace;
  // The last step of the descent.
  near.s += beside * near.contact_per_length;
  near.angle += beside * near.turn_per_length;
  return near;
}

NearPin WheelPath::nearest(const Vec2& point) {
  return described(point, touch::nearest_place(*tree_, seen(point)).place);
}

NearPin WheelPath::nearest(const Vec2& point, std::optional<touch::PathPlace>& from) {
  if (from) {
    const touch::OnPath found = touch::downhill(path_, seen(point), {*from, path_.at(*from)});
    if ((found.point.centre - point).norm() <= kSameFoot * radius()) {
      from = found.place;
      return described(point, found.place);
    }
  }
  from = touch::nearest_place(*tree_, seen(point)).place;
  return described(point, *from);
}

std::optional<std::vector<PinStretch>> WheelPath::within(const Vec2& point, double reach) {
  std::vector<PinStretch> found;
  std::vector<std::int32_t> waiting{tree_->root()};
  while (!waiting.empty()) {
    const std::int32_t index = waiting.back();
    waiting.pop_back();
    const touch::PathTree::Node node = tree_->node(index);
    if ((node.middle - point).norm() > node.radius + reach) continue;
    const bool is_small = node.is_single() && node.radius <= 0.5 * reach;
    const auto [left, right] = is_small ? std::make_pair(index, index) : tree_->halves(index);
    if (left != right) {
      waiting.push_back(left);
      waiting.push_back(right);
      continue;
    }
    if (found.size() == kMostStretches) return std::nullopt;
    const touch::CentreStretch& stretch = path_.stretches()[static_cast<std::size_t>(node.stretch)];
    found.push_back({stretch.corner ? Interval{stretch.s, stretch.s} : node.u,
                     {node.angle - node.half_turn, node.angle + node.half_turn}});
  }
  return found;
}

}  // namespace rollfix::hold
