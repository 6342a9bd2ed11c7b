#include "march/walker.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix::march {

namespace {

/// Newton falls back to halving where it leaves the bracket; so many halvings exhaust a double.
constexpr int kMostRefinements = 100;

/// Where `value`, a nondecreasing function of the sums, meets the target, between `from` and u_end on from's step.
/// `rate` is value's derivative by u. Safeguarded Newton with the same rule as the whole steps.
template <class Value, class Rate>
Position land(const Path& path, Tally& tally, const Position& from, double u_end, double target, const Value& value,
              const Rate& rate) {
  double gap = value(from.here) - target;
  if (gap >= 0) return from;
  ++tally.landings;
  const Interval step = path.step(from.curve, from.index);
  Interval bracket{from.u, u_end};
  Position at = from;
  for (int i = 0; i < kMostRefinements; ++i) {
    double u = at.u - gap / rate(at.local);
    if (!(u > bracket.lo && u <= bracket.hi)) u = bracket.middle();
    at.u = u;
    at.here = at.before + path.integrate(at.curve, step.lo, u);
    at.local = path.at(at.curve, u);
    ++tally.refinements;
    gap = value(at.here) - target;
    const double correction = -gap / rate(at.local);
    if (std::fabs(correction) <= kLastCorrection * step.width()) {
      at.u = std::clamp(u + correction, from.u, step.hi);
      at.here = at.here + at.local.spans() * (at.u - u);
      return at;
    }
    (gap < 0 ? bracket.lo : bracket.hi) = u;
    if (!(bracket.middle() > bracket.lo && bracket.middle() < bracket.hi)) return at;
  }
  return at;
}

/// Where the length is `target` on the step on which `from` lies, whichever side of it. A walker that has just entered
/// the step starts from where the length would be if the speed were the step's mean.
Position land_on_length(const Path& path, Tally& tally, const Position& from, double target, bool entered) {
  if (from.here.length == target) return from;
  ++tally.landings;
  const Interval step = path.step(from.curve, from.index);
  Position at = from;
  double u = entered ? step.lo + step.width() * (target - from.before.length) / from.step.length
                     : from.u + (target - from.here.length) / from.local.speed;
  Interval bracket = step;
  for (int i = 0; i < kMostRefinements; ++i) {
    if (!(u >= bracket.lo && u <= bracket.hi)) u = bracket.middle();
    at.u = u;
    at.here = at.before + path.integrate(at.curve, step.lo, u);
    at.local = path.at(at.curve, u);
    ++tally.refinements;
    const double correction = (target - at.here.length) / at.local.speed;
    if (std::fabs(correction) <= kLastCorrection * step.width()) {
      at.u = std::clamp(u + correction, step.lo, step.hi);
      at.here = at.here + at.local.spans() * correction;
      break;
    }
    (correction > 0 ? bracket.lo : bracket.hi) = u;
    if (!(bracket.middle() > bracket.lo && bracket.middle() < bracket.hi)) break;
    u += correction;
  }
  at.here.length = target;  // what the landing left is a rounding error
  return at;
}

}  // namespace

Position Position::moved_by(const Span& loops) const {
  Position moved = *this;
  moved.before = before + loops;
  moved.here = here + loops;
  return moved;
}

Position first_position(const Path& path) {
  Position first;
  const Interval step = path.step(0, 0);
  first.u = step.lo;
  first.step = path.integrate(0, step.lo, step.hi);
  first.local = path.at(0, step.lo);
  return first;
}

Position next_position(const Path& path, const Position& position) {
  Position next = position;
  if (++next.index == path.steps(next.curve)) {
    next.index = 0;
    next.curve = next.curve + 1 == path.curves() ? 0 : next.curve + 1;
  }
  const Interval step = path.step(next.curve, next.index);
  next.u = step.lo;
  next.before = position.before + position.step;
  next.step = path.integrate(next.curve, step.lo, step.hi);
  next.here = next.before;
  next.local = path.at(next.curve, step.lo);
  return next;
}

Position previous_position(const Path& path, const Position& position) {
  Position previous = position;
  if (previous.index == 0) {
    previous.curve = (previous.curve == 0 ? path.curves() : previous.curve) - 1;
    previous.index = path.steps(previous.curve);
  }
  --previous.index;
  const Interval step = path.step(previous.curve, previous.index);
  previous.u = step.hi;
  previous.step = path.integrate(previous.curve, step.lo, step.hi);
  previous.before = position.before - previous.step;
  previous.here = position.before;
  previous.local = path.at(previous.curve, step.hi);
  return previous;
}

bool Walker::last_step() const {
  return !path_->closed() && position_.curve + 1 == path_->curves() &&
         position_.index + 1 == path_->steps(position_.curve);
}

bool Walker::first_step() const { return !path_->closed() && position_.curve == 0 && position_.index == 0; }

void Walker::next_step() {
  position_ = next_position(*path_, position_);
  ++tally_->steps;
  ++net_steps_;
}

void Walker::previous_step() {
  position_ = previous_position(*path_, position_);
  ++tally_->steps;
  --net_steps_;
}

void Walker::move_to_length(double target) {
  const long before = net_steps_;
  while (target > at_step_end().length && !last_step()) next_step();
  while (target < position_.before.length && !first_step()) previous_step();
  position_ = land_on_length(*path_, *tally_, position_, target, net_steps_ != before);
}

void Walker::nudge(double by) {
  const Interval step = path_->step(position_.curve, position_.index);
  const double change = by / position_.local.speed;
  position_.u = std::clamp(position_.u + change, step.lo, step.hi);
  position_.here = position_.here + position_.local.spans() * change;
}

Position Walker::at_length(double target) {
  Position at = land(
      *path_, *tally_, position_, path_->step(position_.curve, position_.index).hi, target,
      [](const Span& span) { return span.length; }, [](const Local& local) { return local.speed; });
  at.here.length = std::fmax(target, position_.here.length);  // what the landing left is a rounding error
  return at;
}

void Walker::to_length(double target) {
  while (at_step_end().length < target && !last_step()) next_step();
  position_ = at_length(target);
}

bool Walker::to_integral(double target, int sign, double end) {
  const auto short_by = [&](const Span& span) { return sign * (target - span.integral); };
  while (at_step_end().length < end && short_by(at_step_end()) > 0 && !last_step()) next_step();

  double u_end = path_->step(position_.curve, position_.index).hi;
  if (at_step_end().length >= end) {  // the mode ends on this step: beyond, the density may have the other sign
    const Position stop = at_length(end);
    if (short_by(stop.here) > 0) {
      position_ = stop;
      return false;
    }
    u_end = stop.u;
  }
  position_ = land(
      *path_, *tally_, position_, u_end, sign * target, [sign](const Span& span) { return sign * span.integral; },
      [sign](const Local& local) { return sign * local.density * local.speed; });
  return true;
}

}  // namespace rollfix::march
