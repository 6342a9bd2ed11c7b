#include "march/path.hpp"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

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

/// Gauss-Legendre quadrature with five points: exact for polynomials of degree nine. Abramowitz and Stegun 25.4.29.
struct Node {
  double place;
  double weight;
};

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

Interval nth_part(const Interval& domain, std::size_t count, std::size_t index) {
  const auto end = [&](std::size_t i) {
    return i == count ? domain.hi : domain.lo + domain.width() * (static_cast<double>(i) / static_cast<double>(count));
  };
  return {end(index), end(index + 1)};
}

}  // namespace

Path::Path(Outline outline, Density density, double step) : outline_(std::move(outline)), density_(std::move(density)) {
  if (outline_.curves.empty()) throw InputError("march: expected an outline of at least one curve, found none");
  for (std::size_t curve = 0; curve < curves(); ++curve) {
    domains_.push_back(outline_.curves[curve].domain());
    const double range = domains_.back().width();
    parameter_range_ += range;
    const std::size_t count = step > 0
                                  ? static_cast<std::size_t>(std::fmax(1.0, std::ceil(range / step - kStepRounding)))
                                  : choose_steps(curve);
    steps_.push_back(count);
    steps_per_loop_ += count;
    loop_error_ = loop_error_ + try_steps(curve, count).error;
  }
}

Path::Trial Path::try_steps(std::size_t curve, std::size_t count) {
  Trial trial;
  for (std::size_t index = 0; index < count; ++index) {
    const Interval whole = nth_part(domains_[curve], count, index);
    const Span once = integrate(curve, whole.lo, whole.hi);
    const Span twice = integrate(curve, whole.lo, whole.middle()) + integrate(curve, whole.middle(), whole.hi);
    trial.error = trial.error + Span{std::fabs(once.length - twice.length), std::fabs(once.integral - twice.integral)};
    trial.sum = trial.sum + Span{twice.length, std::fabs(twice.integral)};
  }
  choosing_steps_ += 3 * count;
  return trial;
}

std::size_t Path::choose_steps(std::size_t curve) {
  Trial trial;
  for (std::size_t count = kFewestSteps; count <= kMostSteps; count *= 2) {
    trial = try_steps(curve, count);
    if (trial.error.length <= kStepAccuracy * trial.sum.length &&
        trial.error.integral <= kIntegralAccuracy * trial.sum.integral) {
      return count;
    }
  }
  if (trial.error.length <= kUnresolved * trial.sum.length &&
      trial.error.integral <= kUnresolved * trial.sum.integral) {
    return kMostSteps;
  }
  throw Refusal(Reason::unresolved, 0,
                fmt::format("march: expected {} to be resolved by {} equal steps of curve {}, found it too sharp (its "
                            "integral is uncertain by {:.1e} of itself); give a step, or use rollfix::locate",
                            density_.name, kMostSteps, curve, trial.error.integral / trial.sum.integral));
}

Interval Path::step(std::size_t curve, std::size_t index) const {
  return nth_part(domains_[curve], steps_[curve], index);
}

Local Path::at(std::size_t curve, double u) const {
  const Jet jet = outline_.curves[curve].jet(u);
  return {jet.first.norm(), density_.per_length({curve, u, jet})};
}

Span Path::integrate(std::size_t curve, double from, double to) const {
  const double half = 0.5 * (to - from);
  const double middle = from + half;
  Span sum;
  for (const Node& node : kNodes) {
    const Local local = at(curve, middle + half * node.place);
    sum.length += node.weight * local.speed;
    sum.integral += node.weight * local.speed * local.density;
  }
  return sum * half;
}

}  // namespace rollfix::march
