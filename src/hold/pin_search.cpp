#include "pin_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"
#include "rollfix/touch.hpp"

// Notation, as in docs/rig.md:
//   q, p            a finger's contact in the world and on the part; p is within rho of the arc's middle: HeldFrom
//   C               the pin in the world; x = p + R(-phi)(C - q): `point`, where it is on the part
//   phi             the part's heading, within an arc: `middle`, `half`
//   Psi = Theta + t / r   what the wheel has turned against the part where it touches at t; be: its orientation
// Closure: x lies on the path of pins, within rho, what C and q may be off by, and |C - q| times the arc's half chord.
// Idea: distance changes by no more than one goes. At a corner, or while an arc is long, phi is not known well: its arc
// is halved until the way that it moves x is what x is off by anyway.
namespace rollfix::hold {
namespace {

// Of one question: beyond, what is left of the headings is looked at as a whole.
constexpr std::size_t kMostLooks = 4096;

}  // namespace

struct PinSearch::Question {
  std::size_t wheel = 0;
  std::size_t instant = 0;
  const HeldFrom& from;
  Vec2 arm;           // C - q
  double length = 0;  // of it
  double reach = 0;   // of x, but for the heading
  PinFound* found = nullptr;
};

PinSearch::PinSearch(const HeldRows& rows, const std::vector<std::size_t>& instants, const WheelPaths& paths)
    : has_noise_(rows.has_noise), wheels_(rows.wheels), paths_(paths) {
  for (const std::size_t row : instants) pins_.push_back(rows.rows[row].pins);
}

double PinSearch::slack(std::size_t wheel) const {
  return has_noise_ ? kTouchSigmas * (wheels_[wheel].place + wheels_[wheel].radius) : wheels_[wheel].place;
}

/// Beyond what follows from where the pin was: a wheel of another radius has turned otherwise.
double PinSearch::spin_slack(std::size_t wheel, std::size_t instant) const {
  const HeldWheel& one = wheels_[wheel];
  if (!has_noise_) return *one.spin;
  const double turned = std::abs(pins_[instant][wheel].spin - pins_.front()[wheel].spin) + 2 * std::numbers::pi;
  return kTouchSigmas * (*one.spin + one.radius / one.wheel_radius * turned);
}

bool PinSearch::may_touch(std::size_t wheel, std::size_t instant, const HeldFrom& from,
                          const touch::HeadingArc& heading, PinFound* found) {
  const Vec2 arm = pins_[instant][wheel].at - from.at;
  const Question question{wheel, instant, from, arm, arm.norm(), from.reach + slack(wheel), found};
  std::size_t left = kMostLooks;
  const double middle = from.heading + nearest_angle(heading.middle - from.heading);
  return look(question, middle, std::min(heading.half, std::numbers::pi), left);
}

bool PinSearch::look(const Question& question, double middle, double half, std::size_t& left) {
  ++looks_;
  left -= left > 0 ? 1 : 0;
  const Vec2 point = question.from.point + Pose{0, 0, -middle}.turned(question.arm);
  const double reach = question.reach + 2 * question.length * std::sin(0.5 * half);
  if (std::abs(paths_[question.wheel]->nearest(point).distance) > reach) return false;
  if (half * question.length > question.reach && left > 0) {
    const bool is_left = look(question, middle - 0.5 * half, 0.5 * half, left);
    if (is_left && question.found == nullptr) return true;
    return look(question, middle + 0.5 * half, 0.5 * half, left) || is_left;
  }
  if (question.found == nullptr && !wheels_[question.wheel].line) return true;
  return keep_touching(question, middle, half, point, reach);
}

/// Keeps what of the path suits the wheel's other measurements.
bool PinSearch::keep_touching(const Question& question, double middle, double half, const Vec2& point, double reach) {
  const HeldWheel& wheel = wheels_[question.wheel];
  const auto stretches = paths_[question.wheel]->within(point, reach);
  if (!stretches) {
    if (question.found == nullptr) return true;
    question.found->any_spin = true;
    question.found->touching.push_back({paths_[question.wheel]->whole(), {}});
    return true;
  }
  bool is_any = false;
  const double off = question.from.place + slack(question.wheel);
  const double line_slack = !wheel.line ? 0
                            : off >= question.length
                                ? std::numbers::pi
                                : (has_noise_ ? kTouchSigmas : 1) * *wheel.line + std::asin(off / question.length);
  for (const PinStretch& one : *stretches) {
    if (wheel.line) {
      // The wheel's normal points from the finger's contact to the pin; that contact may be anywhere on its arc.
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
    const double spin = pins_[question.instant][question.wheel].spin - middle;
    const double slack = half + spin_slack(question.wheel, question.instant);
    const double radius = wheel.wheel_radius;
    question.found->spins.push_back(
        {spin - one.angle.hi - one.s.hi / radius - slack, spin - one.angle.lo - one.s.lo / radius + slack});
  }
  return is_any;
}

}  // namespace rollfix::hold
