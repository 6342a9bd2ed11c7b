#include "pin_look.hpp"

#include <algorithm>
#include <cmath>

#include "angles.hpp"
#include "budget.hpp"
#include "document.hpp"

// Notation, as in docs/rig.md:
//   q, p            a finger's contact in the world and on the part; C: the pin; v = C - q: `arm`
//   phi +- h        the part's heading; x = p + R(-phi) v: the pin on the part
//   (c, rho), psi +- w, t   a stretch of the pin's path, the tangents and the places at which the wheel touches
// A stretch may hold the pin if |x - c| <= reach + rho + delta + 2 |v| sin(h / 2). With an encoder its zero is then
// be - phi - psi - t / r, within the tolerance; squeezed the direction of v is phi + psi - pi / 2, likewise.
// Idea: at a corner phi is not known well; its interval is halved until it moves x no further than x is known.
namespace rollfix_verify {
namespace {

constexpr double kPinWork = 1e-3;
constexpr double kPinRounding = 1e-13;
constexpr double kPinAngleRounding = 1e-13;
// Stretches that hold the pin are no larger than this share of how far off it may be; those that just come near enough
// than the second.
constexpr double kPinGrain = 0.1;
constexpr double kPinEdge = 0.002;
// Headings are halved until they move the pin no further than this share of it.
constexpr double kHeadingGrain = 0.5;
/// In order, those that overlap as one.
std::vector<Interval> joined(std::vector<Interval> all) {
  std::sort(all.begin(), all.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  std::vector<Interval> result;
  for (const Interval& one : all) {
    if (result.empty() || one.lo > result.back().hi) {
      result.push_back(one);
    } else {
      result.back().hi = std::max(result.back().hi, one.hi);
    }
  }
  return result;
}

}  // namespace

void Zeros::keep(std::vector<Interval> others) {
  others = joined(std::move(others));
  if (!known_) {
    known_ = std::move(others);
    return;
  }
  std::vector<Interval> common;
  for (const Interval& one : *known_) {
    for (const Interval& other : others) {
      const double first = period_ > 0 ? std::ceil((one.lo - other.hi) / period_) : 0;
      const double last = period_ > 0 ? std::floor((one.hi - other.lo) / period_) : 0;
      for (double lap = first; lap <= last; lap += 1) {
        const double on = lap * period_;
        const Interval both{std::max(one.lo, other.lo + on), std::min(one.hi, other.hi + on)};
        if (both.lo <= both.hi) common.push_back(both);
      }
    }
  }
  known_ = joined(std::move(common));
}

/// Of one look.
struct PinLook::Question {
  std::size_t instant = 0;
  double x = 0;  // of the contact on the part
  double y = 0;
  double arm_x = 0;
  double arm_y = 0;
  double arm = 0;
  double reach = 0;
  std::vector<Interval>& zeros;
};

PinLook::PinLook(const Boundary& boundary, const HeldWheel& wheel, double turn)
    : wheel_(wheel), path_(boundary, wheel.radius, wheel.reach) {
  if (path_.root() < 0) refuse("a wheel that can be nowhere");
  if (boundary.closed()) period_ = std::abs(turn + boundary.perimeter().middle() / wheel.radius);
  const CentreTree::Node& root = path_.node(path_.root());
  double largest = std::hypot(root.x, root.y) + root.radius;
  for (const HeldWheel::At& at : wheel.at) largest = std::max({largest, std::abs(at.x), std::abs(at.y)});
  rounding_ = kPinRounding * largest;
}

bool PinLook::may_touch(const SeenFrom& from, std::size_t instant, double heading, double half,
                        std::vector<Interval>& zeros) {
  const HeldWheel::At& pin = wheel_.at[instant];
  const double arm_x = pin.x - from.world_x;
  const double arm_y = pin.y - from.world_y;
  const double arm = std::hypot(arm_x, arm_y);
  Question question{instant, from.x, from.y, arm_x, arm_y, arm, from.reach + wheel_.place + rounding_, zeros};
  return look(question, heading, std::min(half, 0.5 * kTurn));
}

bool PinLook::look(Question& question, double heading, double half) {
  Budget::spend(kPinWork);
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  const double x = question.x + c * question.arm_x + s * question.arm_y;
  const double y = question.y + c * question.arm_y - s * question.arm_x;
  const double reach = question.reach + 2 * question.arm * std::sin(0.5 * half);
  if (half * question.arm > kHeadingGrain * question.reach) {
    if (!is_near(x, y, reach)) return false;
    const bool is_below = look(question, heading - 0.5 * half, 0.5 * half);
    return look(question, heading + 0.5 * half, 0.5 * half) || is_below;
  }
  if (!wheel_.spin && !wheel_.line) return is_near(x, y, reach);
  bool is_any = false;
  std::vector<int> waiting{path_.root()};
  while (!waiting.empty()) {
    Budget::spend(kPinWork);
    const int index = waiting.back();
    waiting.pop_back();
    const CentreTree::Node node = path_.node(index);
    const double apart = std::hypot(x - node.x, y - node.y);
    if (apart > reach + node.radius) continue;
    const double grain = apart <= reach ? kPinGrain : kPinEdge;
    const bool is_small = node.curve >= 0 && node.radius <= grain * reach;
    const auto [left, right] = is_small ? std::make_pair(index, index) : path_.halves(index);
    if (left != right) {
      waiting.push_back(left);
      waiting.push_back(right);
      continue;
    }
    if (!suits(question, heading, half, node)) continue;
    is_any = true;
    if (!wheel_.spin) return true;
    const double zero = wheel_.at[question.instant].spin - heading - node.angle;
    const double off = half + node.half_turn + *wheel_.spin + kPinAngleRounding * (1 + std::abs(zero));
    question.zeros.push_back({zero - node.s.hi / wheel_.radius - off, zero - node.s.lo / wheel_.radius + off});
  }
  return is_any;
}

/// Whether the path comes within reach: its nearest stretches are asked first.
bool PinLook::is_near(double x, double y, double reach) {
  std::vector<int> waiting{path_.root()};
  while (!waiting.empty()) {
    Budget::spend(kPinWork);
    const int index = waiting.back();
    waiting.pop_back();
    const CentreTree::Node node = path_.node(index);
    const double apart = std::hypot(x - node.x, y - node.y);
    if (apart > reach + node.radius) continue;
    if (node.curve >= 0 && (apart <= reach || node.radius <= kPinEdge * reach)) return true;
    const auto [left, right] = path_.halves(index);
    if (left == right) return true;
    const auto distance = [&](int half) { return std::hypot(x - path_.node(half).x, y - path_.node(half).y); };
    const bool is_left_nearer = distance(left) < distance(right);
    waiting.push_back(is_left_nearer ? right : left);
    waiting.push_back(is_left_nearer ? left : right);
  }
  return false;
}

/// Squeezed: the wheel's normal points from the finger's contact to the pin, as measured.
bool PinLook::suits(const Question& question, double heading, double half, const CentreTree::Node& node) const {
  if (!wheel_.line) return true;
  const double towards = std::atan2(question.arm_y, question.arm_x) + 0.25 * kTurn;
  const double most = *wheel_.line + half + node.half_turn + kPinAngleRounding * (2 + std::abs(node.angle));
  return !(std::abs(nearest(towards - heading - node.angle)) > most);
}

}  // namespace rollfix_verify
