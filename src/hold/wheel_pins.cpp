#include "wheel_pins.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "outline/turn.hpp"
#include "rollfix/touch.hpp"

// Notation, as in docs/rig.md:
//   c(u)            the pin while the wheel touches at u: p + r n, touch::CentrePath
//   n, T            normal and tangent at the c that is nearest to a point x of the part's frame: `away`, `along`
//   q, p            a finger's contact in the world and on the part; p is within rho of the arc's middle: HeldFrom
//   C               the pin in the world; x = p + R(-phi)(C - q): `point`, where it is on the part; x - c: `off`
//   phi             the part's heading, within an arc: `middle`, `half`
//   Psi = Theta + t / r   what the wheel has turned against the part where it touches at t; be: its orientation
// A wheel that touches, and enters the part nowhere, has its pin on the boundary's offset as far as the disk reaches,
// with an arc about each convex corner. A pin that is measured is that far from it.
// Closure: x lies on the path of pins, within rho, what C and q may be off by, and |C - q| times the arc's half chord.
// Idea: if a point moves by m, its distance from the path changes by no more than m. At a corner, or while an arc of
// first contacts is long, phi is not known well. Its arc is halved until phi moves x by no more than x may be off.
namespace rollfix::hold {
namespace {

// A nearest place is settled to this share of the part's diagonal; its distance, to second order in that, is better.
constexpr double kPinUnit = 1e-4;
// Where an offset's part along the path is more than this share of the distance, the nearest place is an end of the
// path.
constexpr double kNoFoot = 1e-4;
// Within this share of the diagonal from the path, an offset along it is rounding.
constexpr double kOnPath = 1e-8;
constexpr std::size_t kMostStretches = 256;
// A descent from another row's place is that row's part of the path if it is no further than this share of the radius.
constexpr double kSameFoot = 0.2;

// Looks of one question. Beyond, what is left of the headings is not halved any more, and counts as possible sooner.
constexpr std::size_t kMostLooks = 4096;

}  // namespace

/// Theta + s / r grows by 2 pi k + P / r around a closed part.
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

/// The foot of the perpendicular from the point, or an end of the path. To first order in what the search left beside
/// the foot.
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
  // 0 at a foot but for what the search left.
  const double beside = off.dot(tangent);
  const double pace = std::max(at.along.norm(), 1e-12);  // of the pin, per u
  // A point off the path whose offset has a part along it: the path ends there, where the wheel hits the part.
  const bool is_end = std::abs(beside) > kNoFoot * std::abs(near.distance) + kOnPath * path_.diagonal();
  if (is_end) {
    // The distance to the end itself, with the sign of the side; below 0 it grows against the offset.
    near.distance = std::copysign(off.norm(), near.distance);
    near.away = off / near.distance;
    return near;
  }
  near.along = tangent;
  // On a spiral kappa / (1 + r kappa), at a corner 1 / r. u is s on a spiral; at a corner s stays.
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

/// A local search, accepted if it ends within kSameFoot of the radius; else the global one. `from` is where it ended.
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

/// Walks down the tree of discs. A disc farther from the point than its radius and `reach` holds nothing that counts.
std::optional<std::vector<PinStretch>> WheelPath::within(const Vec2& point, double reach) {
  std::vector<PinStretch> found;
  std::vector<std::int32_t> waiting{tree_->root()};
  while (!waiting.empty()) {
    const std::int32_t index = waiting.back();
    waiting.pop_back();
    const touch::PathTree::Node node = tree_->node(index);
    if ((node.middle - point).norm() > node.radius + reach) continue;
    // Pieces end at half the reach, or where they have no halves.
    const bool is_small = node.is_single() && node.radius <= 0.5 * reach;
    const auto [left, right] = is_small ? std::make_pair(index, index) : tree_->halves(index);
    if (left != right) {
      waiting.push_back(left);
      waiting.push_back(right);
      continue;
    }
    if (found.size() == kMostStretches) return std::nullopt;
    const touch::CentreStretch& stretch = path_.stretches()[static_cast<std::size_t>(node.stretch)];
    // About a corner u is the tangent's angle, and s is the corner's.
    found.push_back({stretch.corner ? Interval{stretch.s, stretch.s} : node.u,
                     {node.angle - node.half_turn, node.angle + node.half_turn}});
  }
  return found;
}

struct PinSearch::Question {
  std::size_t wheel = 0;
  std::size_t instant = 0;
  const HeldFrom& from;
  Vec2 arm;           // C - q
  double length = 0;  // of it
  double reach = 0;   // of x, but for the heading
  PinFound* found = nullptr;
};

/// `paths` has to outlive it.
PinSearch::PinSearch(const HeldRows& rows, const std::vector<std::size_t>& instants, const WheelPaths& paths)
    : has_noise_(rows.has_noise), wheels_(rows.wheels), paths_(paths) {
  for (const std::size_t row : instants) pins_.push_back(rows.rows[row].pins);
}

/// In length. With noise of x or y and of the radius, added: on the safe side. Without noise the tolerance.
double PinSearch::slack(std::size_t wheel) const {
  return has_noise_ ? kTouchSigmas * (wheels_[wheel].place + wheels_[wheel].radius) : wheels_[wheel].place;
}

/// Beyond what follows from where the pin was: a wheel of another radius has turned otherwise.
double PinSearch::spin_slack(std::size_t wheel, std::size_t instant) const {
  const HeldWheel& one = wheels_[wheel];
  if (!has_noise_) return *one.spin;
  // The error of the radius enters t / r by as much as the wheel has turned.
  const double turned = std::abs(pins_[instant][wheel].spin - pins_.front()[wheel].spin) + 2 * std::numbers::pi;
  return kTouchSigmas * (*one.spin + one.radius / one.wheel_radius * turned);
}

/// `heading` is an arc modulo a turn; its middle is taken to the lap of the finger's own heading, as encoders need
/// it.
bool PinSearch::may_touch(std::size_t wheel, std::size_t instant, const HeldFrom& from,
                          const touch::HeadingArc& heading, PinFound* found) {
  const Vec2 arm = pins_[instant][wheel].at - from.at;
  const Question question{wheel, instant, from, arm, arm.norm(), from.reach + slack(wheel), found};
  std::size_t left = kMostLooks;
  const double middle = from.heading + nearest_angle(heading.middle - from.heading);
  return look(question, middle, std::min(heading.half, std::numbers::pi), left);
}

/// Closure at all headings within `half` of `middle` at once. x moves by at most the chord 2 |C - q| sin(half / 2),
/// and the distance from the path by no more than x does: farther off than the reach no heading of them fits.
bool PinSearch::look(const Question& question, double middle, double half, std::size_t& left) {
  ++looks_;
  left -= left > 0 ? 1 : 0;
  const Vec2 point = question.from.point + Pose{0, 0, -middle}.turned(question.arm);
  const double reach = question.reach + 2 * question.length * std::sin(0.5 * half);
  if (std::abs(paths_[question.wheel]->nearest(point).distance) > reach) return false;
  // As long as the heading moves x by more than the reach, both halves of the arc are looked at. Without `found` one
  // that fits is enough.
  if (half * question.length > question.reach && left > 0) {
    const bool is_left = look(question, middle - 0.5 * half, 0.5 * half, left);
    if (is_left && question.found == nullptr) return true;
    return look(question, middle + 0.5 * half, 0.5 * half, left) || is_left;
  }
  // Closure is all that is asked.
  if (question.found == nullptr && !wheels_[question.wheel].line) return true;
  return keep_touching(question, middle, half, point, reach);
}

/// Keeps what of the path suits the wheel's other measurements.
bool PinSearch::keep_touching(const Question& question, double middle, double half, const Vec2& point, double reach) {
  const HeldWheel& wheel = wheels_[question.wheel];
  // All places where the wheel can touch if x is anywhere within reach.
  const auto stretches = paths_[question.wheel]->within(point, reach);
  // Too many to look at each: all of them count as possible, which loses nothing.
  if (!stretches) {
    if (question.found == nullptr) return true;
    question.found->any_spin = true;
    question.found->touching.push_back({paths_[question.wheel]->whole(), {}});
    return true;
  }
  bool is_any = false;
  // How far off C - q can be, in the world; the direction of it then by asin(off / |C - q|), or any.
  const double off = question.from.place + slack(question.wheel);
  const double line_slack = !wheel.line ? 0
                            : off >= question.length
                                ? std::numbers::pi
                                : (has_noise_ ? kTouchSigmas : 1) * *wheel.line + std::asin(off / question.length);
  for (const PinStretch& one : *stretches) {
    if (wheel.line) {
      // Squeezed: C - q points along the wheel's outward normal, phi + Theta - pi / 2. Both q and C are measured in the
      // world, so that the arc of first contacts only adds the range of phi.
      const double towards = std::atan2(question.arm.y(), question.arm.x()) + 0.5 * std::numbers::pi;
      if (std::abs(nearest_angle(towards - middle - one.angle.middle())) >
          line_slack + half + 0.5 * one.angle.width()) {
        continue;
      }
    }
    is_any = true;
    if (question.found == nullptr) return true;
    question.found->touching.push_back(one);
    if (!wheel.spin) continue;
    // be0 = be - phi - Theta - t / r, with phi, Theta and t each anywhere in its interval.
    const double spin = pins_[question.instant][question.wheel].spin - middle;
    const double slack = half + spin_slack(question.wheel, question.instant);
    const double radius = wheel.wheel_radius;
    question.found->spins.push_back(
        {spin - one.angle.hi - one.s.hi / radius - slack, spin - one.angle.lo - one.s.lo / radius + slack});
  }
  return is_any;
}

}  // namespace rollfix::hold
