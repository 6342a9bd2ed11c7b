#include "march/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

// Notation (docs/march.md, "Numerical integration")
//   u           parameter of a curve; alpha(u) its point, `speed` = |alpha'(u)|
//   h           step in u, `step`; each step is integrated by Gauss-Legendre quadrature with five nodes
//   length      integral of |alpha'|, eq. (4); `integral` that of g |alpha'|, eq. (5) where g = kappa
//   Position    a place: step, u within it, and both integrals from s = 0 on
// Idea: a Walker goes from step to step and sums up; within a step it lands on a given length or integral by Newton's
// iteration. Reference: Abramowitz and Stegun, Handbook of Mathematical Functions, 25.4.29.

namespace rollfix::march {

namespace {

/// An automatic step is small enough when halving it changes the sum over a curve by no more than this part of it:
/// some rounding errors per step.
constexpr double kStepAccuracy = 1e-14;
/// The same for the density's integral, whose integrand is a quotient of higher derivatives.
constexpr double kIntegralAccuracy = 1e-13;
/// What the last trial must come to at least.
constexpr double kUnresolved = 1e-10;
/// Automatic steps per curve, first and last trial.
constexpr std::size_t kFewestSteps = 4;
constexpr std::size_t kMostSteps = 4096;
/// A given step divides a curve's parameter range to this accuracy, or another step is added.
constexpr double kStepRounding = 1e-9;

/// One node of Gauss-Legendre quadrature on [-1, 1]. The weights add up to 2, the interval's length.
struct Node {
  /// abscissa
  double place;
  double weight;
};

/// The rule with five nodes: exact for polynomials of degree nine. Abramowitz and Stegun 25.4.29, in closed form.
std::array<Node, 5> gauss_legendre() {
  const double inner = std::sqrt(5.0 - 2.0 * std::sqrt(10.0 / 7.0)) / 3.0;
  const double outer = std::sqrt(5.0 + 2.0 * std::sqrt(10.0 / 7.0)) / 3.0;
  const double inner_weight = (322.0 + 13.0 * std::sqrt(70.0)) / 900.0;
  const double outer_weight = (322.0 - 13.0 * std::sqrt(70.0)) / 900.0;
  return {{{-outer, outer_weight},
           {-inner, inner_weight},
           {0.0, 128.0 / 225.0},
           {inner, inner_weight},
           {outer, outer_weight}}};
}

const std::array<Node, 5> kNodes = gauss_legendre();

/// Part number `index` of `count` equal parts. The last one ends at domain.hi itself, so that a curve's steps cover its
/// domain without a gap that rounding leaves.
Interval nth_part(const Interval& domain, std::size_t count, std::size_t index) {
  const auto end = [&](std::size_t i) {
    return i == count ? domain.hi : domain.lo + domain.width() * (static_cast<double>(i) / static_cast<double>(count));
  };
  return {end(index), end(index + 1)};
}

}  // namespace

Path::Path(Outline outline, Density density, double step) : outline_(std::move(outline)), density_(std::move(density)) {
  if (outline_.curves.empty()) throw InputError("march: expected an outline of at least one curve, found none");
  // Each curve has its own equal steps: no step reaches over a joint, where g may jump.
  for (std::size_t curve = 0; curve < curves(); ++curve) {
    domains_.push_back(outline_.curves[curve].domain());
    const double range = domains_.back().width();
    parameter_range_ += range;
    const std::size_t count = step > 0
                                  ? static_cast<std::size_t>(std::fmax(1.0, std::ceil(range / step - kStepRounding)))
                                  : choose_steps(curve);
    steps_.push_back(count);
    steps_per_loop_ += count;
    // Also for a given step: Result reports the error of one loop whatever the step.
    loop_error_ = loop_error_ + try_steps(curve, count).error;
  }
}

/// Integrates a curve in `count` equal steps, and again in halves of them; the difference estimates the error of the
/// whole steps.
Path::Trial Path::try_steps(std::size_t curve, std::size_t count) {
  Trial trial;
  for (std::size_t index = 0; index < count; ++index) {
    const Interval whole = nth_part(domains_[curve], count, index);
    const Span once = integrate(curve, whole.lo, whole.hi);
    const Span twice = integrate(curve, whole.lo, whole.middle()) + integrate(curve, whole.middle(), whole.hi);
    // Absolute values: errors of neighbouring steps must not cancel, and an integral whose parts cancel over the curve
    // must not make small errors look large.
    trial.error = trial.error + Span{std::fabs(once.length - twice.length), std::fabs(once.integral - twice.integral)};
    trial.sum = trial.sum + Span{twice.length, std::fabs(twice.integral)};
  }
  // one quadrature over each step and two over its halves
  choosing_steps_ += 3 * count;
  return trial;
}

/// The fewest steps of 4, 8, ... 4096 at which halving changes neither sum by more than rounding: the automatic h.
/// Throws Refusal (unresolved) where 4096 steps do not come to kUnresolved either.
std::size_t Path::choose_steps(std::size_t curve) {
  Trial trial;
  for (std::size_t count = kFewestSteps; count <= kMostSteps; count *= 2) {
    trial = try_steps(curve, count);
    if (trial.error.length <= kStepAccuracy * trial.sum.length &&
        trial.error.integral <= kIntegralAccuracy * trial.sum.integral) {
      return count;
    }
  }
  // Not to rounding, but accurate enough to go on; `loop_error_` has what is left.
  if (trial.error.length <= kUnresolved * trial.sum.length &&
      trial.error.integral <= kUnresolved * trial.sum.integral) {
    return kMostSteps;
  }
  throw Refusal(Reason::unresolved, 0,
                fmt::format("march: expected {} to be resolved by {} equal steps of curve {}, found it too sharp (its "
                            "integral is uncertain by {:.1e} of itself); give a step, or use rollfix::locate",
                            density_.name, kMostSteps, curve, trial.error.integral / trial.sum.integral));
}

/// The parameters [u, u + h] of one step.
Interval Path::step(std::size_t curve, std::size_t index) const {
  return nth_part(domains_[curve], steps_[curve], index);
}

/// |alpha'(u)| and g at the parameter u of a curve.
Local Path::at(std::size_t curve, double u) const {
  const Jet jet = outline_.curves[curve].jet(u);
  return {jet.first.norm(), density_.per_length({curve, u, jet})};
}

/// Both integrals from parameter `from` to `to`; with to < from both change their sign.
Span Path::integrate(std::size_t curve, double from, double to) const {
  const double half = 0.5 * (to - from);
  const double middle = from + half;
  Span sum;
  for (const Node& node : kNodes) {
    const Local local = at(curve, middle + half * node.place);
    sum.length += node.weight * local.speed;
    // ds = speed du, and g is per unit of arc length
    sum.integral += node.weight * local.speed * local.density;
  }
  return sum * half;
}

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
  // gap < 0: the target is ahead
  ++tally.landings;
  const Interval step = path.step(from.curve, from.index);
  // The root lies in the bracket at each turn: `value` is short of the target at lo, and reaches it by hi.
  Interval bracket{from.u, u_end};
  Position at = from;
  for (int i = 0; i < kMostRefinements; ++i) {
    double u = at.u - gap / rate(at.local);
    // Outside where the rate is small or 0, as near an inflection; `!` also catches a u that is not a number.
    if (!(u > bracket.lo && u <= bracket.hi)) u = bracket.middle();
    at.u = u;
    // From the step's beginning, not from where the last landing was: errors do not add up over many landings.
    at.here = at.before + path.integrate(at.curve, step.lo, u);
    at.local = path.at(at.curve, u);
    ++tally.refinements;
    gap = value(at.here) - target;
    const double correction = -gap / rate(at.local);
    if (std::fabs(correction) <= kLastCorrection * step.width()) {
      at.u = std::clamp(u + correction, from.u, step.hi);
      // The last correction is linear: the integrands do not change over it to rounding.
      at.here = at.here + at.local.spans() * (at.u - u);
      return at;
    }
    (gap < 0 ? bracket.lo : bracket.hi) = u;
    // The bracket holds no number between its ends: nothing is left to halve.
    if (!(bracket.middle() > bracket.lo && bracket.middle() < bracket.hi)) return at;
  }
  return at;
}

/// Where the length is `target` on the step on which `from` lies, whichever side of it. A walker that has just entered
/// the step starts from where the length would be if the speed were the step's mean.
Position land_on_length(const Path& path, Tally& tally, const Position& from, double target, bool entered) {
  if (from.here.length == target) return from;
  // The target may lie on either side of from.u: the bracket is the whole step.
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
    // The speed is positive, so that the length grows with u: the correction's sign tells the side of the root.
    (correction > 0 ? bracket.lo : bracket.hi) = u;
    if (!(bracket.middle() > bracket.lo && bracket.middle() < bracket.hi)) break;
    u += correction;
  }
  at.here.length = target;  // what the landing left is a rounding error
  return at;
}

}  // namespace

/// The same place some loops further on: only the sums change.
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

/// On a closed outline the step after the last one is the first; its sums go on from those of the loop before.
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

/// The sums of the step itself are taken off, so that both directions give the same sums at a place, to rounding.
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

/// On an open outline's last step, beyond which there is nothing to enter. A closed one has no last step.
bool Walker::last_step() const {
  return !path_->closed() && position_.curve + 1 == path_->curves() &&
         position_.index + 1 == path_->steps(position_.curve);
}

/// Likewise an open outline's first step.
bool Walker::first_step() const { return !path_->closed() && position_.curve == 0 && position_.index == 0; }

/// Into the next step, at its beginning: one quadrature, counted as a step of the theorems.
void Walker::next_step() {
  position_ = next_position(*path_, position_);
  ++tally_->steps;
  ++net_steps_;
}

/// Into the step before, at its end. It counts as a step as well.
void Walker::previous_step() {
  position_ = previous_position(*path_, position_);
  ++tally_->steps;
  --net_steps_;
}

void Walker::move_to_length(double target) {
  const long before = net_steps_;
  // Lengths grow along the path, so that one of the two loops does nothing. After them the target lies on this step,
  // or beyond the end of an open outline.
  while (target > at_step_end().length && !last_step()) next_step();
  while (target < position_.before.length && !first_step()) previous_step();
  position_ = land_on_length(*path_, *tally_, position_, target, net_steps_ != before);
}

/// `by` is an arc length. The sums are extended by the integrands at u: what that leaves is of second order in `by`,
/// a rounding error for shifts of the size of kLastCorrection.
void Walker::nudge(double by) {
  const Interval step = path_->step(position_.curve, position_.index);
  const double change = by / position_.local.speed;
  position_.u = std::clamp(position_.u + change, step.lo, step.hi);
  position_.here = position_.here + position_.local.spans() * change;
}

/// Where on this step the length is `target`, at or ahead of the walker, which does not move. A target behind it gives
/// the walker's own place.
Position Walker::at_length(double target) {
  Position at = land(
      *path_, *tally_, position_, path_->step(position_.curve, position_.index).hi, target,
      [](const Span& span) { return span.length; }, [](const Local& local) { return local.speed; });
  at.here.length = std::fmax(target, position_.here.length);  // what the landing left is a rounding error
  return at;
}

void Walker::to_length(double target) {
  // Whole steps first; the target then lies on the step that the walker is on.
  while (at_step_end().length < target && !last_step()) next_step();
  position_ = at_length(target);
}

bool Walker::to_integral(double target, int sign, double end) {
  // Up to `end` the density has the sign `sign`, so that sign * integral grows with arc length.
  const auto short_by = [&](const Span& span) { return sign * (target - span.integral); };
  // A step whose end falls short and lies before `end` does not contain the target: by monotonicity.
  while (at_step_end().length < end && short_by(at_step_end()) > 0 && !last_step()) next_step();

  double u_end = path_->step(position_.curve, position_.index).hi;
  if (at_step_end().length >= end) {  // the mode ends on this step: beyond, the density may have the other sign
    const Position stop = at_length(end);
    // The target is not reached at `end`: none on this mode.
    if (short_by(stop.here) > 0) {
      position_ = stop;
      return false;
    }
    u_end = stop.u;
  }
  // Here the step holds the target up to u_end, and the integral is monotone up to there: one root.
  position_ = land(
      *path_, *tally_, position_, u_end, sign * target, [sign](const Span& span) { return sign * span.integral; },
      [sign](const Local& local) { return sign * local.density * local.speed; });
  return true;
}

}  // namespace rollfix::march
