#include "rollfix/locate/march/walker.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix::march {

namespace {

/// A Newton step shorter than this part of the parameter step is taken without another quadrature: what it leaves is
/// its square, a rounding error.
constexpr double kLastCorrection = 1e-8;
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

bool Walker::last_step() const {
  return !path_->closed() && position_.curve + 1 == path_->curves() &&
         position_.index + 1 == path_->steps(position_.curve);
}

void Walker::next_step() {
  position_ = next_position(*path_, position_);
  ++tally_->steps;
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
