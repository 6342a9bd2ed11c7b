#include "plan/contact_way.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rollfix/error.hpp"

namespace rollfix {
namespace {

// A step of a search is at most this share of a turn, of the perimeter, and of the way: then a margin can't change by
// more than some degrees, and the proof that follows halves what is left.
constexpr double kStepShare = 1.0 / 240;
// A side that is nearly flat takes steps of x that are ever smaller; beyond this nothing is gained.
constexpr int kMostHalvings = 12;

}  // namespace

double ContactPlace::inward() const { return angle + std::numbers::pi / 2; }

double turn_between(const ContactPlace& one, const ContactPlace& two) {
  const double turned = two.turned - one.turned;
  return std::max(std::abs(turned), std::abs(turned - (two.angle - one.angle)));
}

ContactWay::ContactWay(const Part& part, const PlanFinger& finger, double heading)
    : start_(*finger.start), psi_(finger.psi - heading), u_(finger.u) {
  if (!std::isfinite(start_)) throw InputError("expected a finite start of a roll");
  track_ = track_of(part, finger.finger, start_, u_);
  const double base = part.closed() ? wrap(start_, part.perimeter()).base : start_;
  const int direction = finger.length.value_or(1) < 0 || (!part.closed() && base >= part.perimeter()) ? -1 : 1;
  from_start_.start = track_->place(base, direction);
  from_start_.start_angle = track_->turning(track_->stretch(from_start_.start.index), from_start_.start.s).angle;
  from_start_.first = track_->first_contact(from_start_.start, from_start_.start_angle, psi_);
  from_start_.velocity = 1;
}

Motion ContactWay::motion(double length) const {
  RollPlan plan;
  plan.start = start_;
  plan.psi = psi_;
  plan.u = u_;
  plan.rows = 2;
  plan.distance = length;
  return plan_motion(*track_, plan);
}

double ContactWay::turned_after(double length) const {
  if (length == 0) return 0;
  const Motion there = motion(length);
  return there.velocity * there.duration;
}

double ContactWay::furthest(int direction, double most) const {
  const auto can = [&](double length) {
    try {
      turned_after(direction * length);
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  if (!(most > 0)) return 0;
  if (can(most)) return direction * most;
  double lo = 0;
  double hi = most;
  while (hi - lo > kStepShare * kStepShare * part().perimeter()) {
    const double middle = 0.5 * (lo + hi);
    (can(middle) ? lo : hi) = middle;
  }
  return direction * lo;
}

std::vector<ContactPlace> ContactWay::places(const std::vector<double>& turned) const {
  const std::vector<RollState> states = states_of(*track_, from_start_, turned);
  std::vector<ContactPlace> places;
  places.reserve(turned.size());
  for (std::size_t k = 0; k < turned.size(); ++k) {
    const RollState& state = states[k];
    const Vec2 point = part().point(state.s);
    places.push_back(
        {turned[k], state.s, state.angle, state.contact, point, centre_of(finger(), point, state.contact)});
  }
  return places;
}

std::vector<double> ContactWay::nodes(double lo, double hi, std::size_t steps) const {
  if (!(hi > lo)) return {lo};
  const double most_turn = std::min(kStepShare * (2 * std::numbers::pi), (hi - lo) / static_cast<double>(steps));
  const auto count = static_cast<std::size_t>(std::ceil((hi - lo) / most_turn));
  std::vector<double> nodes;
  for (std::size_t k = 0; k <= count; ++k) {
    nodes.push_back(lo + (hi - lo) * (static_cast<double>(k) / static_cast<double>(count)));
  }
  if (lo < 0 && hi > 0) nodes.insert(std::upper_bound(nodes.begin(), nodes.end(), 0.0), 0.0);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const double most_length = kStepShare * part().perimeter();
  for (int round = 0; round < kMostHalvings; ++round) {
    const std::vector<ContactPlace> there = places(nodes);
    std::vector<double> finer{nodes.front()};
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      const double middle = 0.5 * (nodes[k - 1] + nodes[k]);
      const bool is_long = std::abs(there[k].s - there[k - 1].s) > most_length;
      if (is_long && middle > nodes[k - 1] && middle < nodes[k]) finer.push_back(middle);
      finer.push_back(nodes[k]);
    }
    if (finer.size() == nodes.size()) break;
    nodes = std::move(finer);
  }
  return nodes;
}

}  // namespace rollfix
