#include "march/preprocessing.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "outline/turn.hpp"

// Notation (section 2.2, "In preprocessing, we compute all points of inflection")
//   z_i          sign changes of the density g, `changes`, each with the length and the integral from s = 0 to it
//   P            perimeter, `loop.length`
//   variation    integral of |g| over the whole outline, to a few digits
//   Refusal      what the march is not made for: corners, lines, arcs, zeros not simple, for eq. (6) jumps of kappa
// Idea: what the paper asks of a curve (no corner, line or arc, simple inflections) is checked once, and said before
// it marches.

namespace rollfix::march {

namespace {

/// Tangents that differ by less (radians) are one tangent with rounding errors: such a joint is smooth.
constexpr double kSmoothJoint = 1e-9;
/// A curve whose tangent turns by less over its whole length (radians) is a line.
constexpr double kFlatTurn = 1e-9;
/// An analytic function that varies by less than this part of its size along a curve is constant on it.
constexpr double kConstant = 1e-9;
/// Against the largest value on the outline: smaller ones are rounding errors.
constexpr double kZero = 1e-12;
/// Against the largest curvature: a larger jump where two curves meet is a jump.
constexpr double kCurvatureJump = 1e-9;

constexpr const char* kCure = "rollfix::locate handles it";

/// What a check looks at, and its way to refuse.
struct Context {
  const Path& path;
  const Preprocessed& preprocessed;
  const Samples& samples;

  /// Throws Refusal for a curve; the place is the arc length at which the curve starts.
  [[noreturn]] void refuse(Reason reason, std::size_t curve, const std::string& what) const {
    const double where = preprocessed.curve_starts[curve];
    throw Refusal(reason, where, fmt::format("march: {} (curve {}, s = {:.17g}); {}", what, curve, where, kCure));
  }
};

/// Largest |value| and the spread of the values.
struct Range {
  double largest = 0;
  double spread = 0;
};

/// `value` is taken of each sample of one curve, which are as dense as the quadrature's nodes.
template <class Value>
Range range_of(const std::vector<Sample>& samples, const Value& value) {
  double lo = value(samples.front());
  double hi = lo;
  for (const Sample& sample : samples) {
    lo = std::min(lo, value(sample));
    hi = std::max(hi, value(sample));
  }
  return {std::max(std::fabs(lo), std::fabs(hi)), hi - lo};
}

/// The curvature along a curve is what lines and arcs are told by, also where the density is another one.
void check_curvature(const Context& context, std::size_t curve) {
  const Curve& shape = context.path.outline().curves[curve];
  const auto value = [&](const Sample& sample) { return curvature(shape.jet(sample.u)); };
  const Range range = range_of(context.samples.curves[curve], value);
  const double end = curve + 1 < context.path.curves() ? context.preprocessed.curve_starts[curve + 1]
                                                       : context.preprocessed.loop.length;
  const double length = end - context.preprocessed.curve_starts[curve];
  // The turn over the curve is at most the largest |kappa| times the length.
  if (range.largest * length <= kFlatTurn) {
    context.refuse(Reason::line, curve, "expected curvature that vanishes at isolated points only, found a line");
  }
  if (range.spread <= kConstant * range.largest) {
    context.refuse(Reason::arc, curve, "expected curvature that varies, found a circular arc");
  }
}

/// For a density of section 5: g may be constant, but not zero along a curve, where its zeros are not isolated.
void check_not_zero(const Context& context, std::size_t curve) {
  const Range range = range_of(context.samples.curves[curve], [](const Sample& sample) { return sample.density; });
  if (range.largest <= kZero * context.samples.scale) {
    context.refuse(Reason::zero_density, curve,
                   fmt::format("expected {} to vanish at isolated points only, found zero along a curve",
                               context.path.density().name));
  }
}

/// Where curve `number` ends and the next begins.
void check_joint(const Context& context, std::size_t number) {
  const std::size_t following = (number + 1) % context.path.curves();
  const Curve& curve = context.path.outline().curves[number];
  const Curve& next = context.path.outline().curves[following];
  const Jet before = curve.jet(curve.domain().hi);
  const Jet after = next.jet(next.domain().lo);
  const double turn = angle_between(before.first, after.first);
  if (std::fabs(turn) > kSmoothJoint) {
    context.refuse(Reason::corner, following,
                   fmt::format("expected a smooth boundary, found a corner of {:.17g} rad", turn));
  }
  // A jump of kappa does not matter for eq. (5). In eq. (6) kappa(t) - kappa(s) is taken as an integral of kappa'.
  if (context.path.density().kind != Density::Kind::curvature_rate) return;
  const double jump = std::fabs(curvature(after) - curvature(before));
  if (jump > kCurvatureJump * std::max(std::fabs(curvature(after)), std::fabs(curvature(before)))) {
    context.refuse(Reason::curvature_jump, following,
                   fmt::format("expected a continuous curvature for eq. (6), found a jump of {:.17g}", jump));
  }
}

/// Throws Refusal where the outline or its density is outside what section 2 assumes:
///  * corner: the tangent jumps by more than kSmoothJoint where two curves meet
///  * line: the tangent turns nowhere by more than kFlatTurn along a curve
///  * arc: the curvature is constant along a curve (to kConstant of its size); for eq. (6) this and a line are one
///  * zero_density: any other density is zero along a curve (to kZero of its scale)
///  * curvature_jump: for eq. (6), the curvature jumps where two curves meet
void check_preconditions(const Path& path, const Preprocessed& preprocessed, const Samples& samples) {
  const Context context{path, preprocessed, samples};
  const std::size_t curves = path.curves();
  const bool other = path.density().kind == Density::Kind::other;
  for (std::size_t i = 0; i < curves; ++i) {
    if (other) {
      check_not_zero(context, i);
    } else {
      check_curvature(context, i);
    }
  }
  if (other) return;  // a corner has no length: it adds nothing to the integral of f
  for (std::size_t i = 0; i + (path.closed() ? 0 : 1) < curves; ++i) check_joint(context, i);
}

/// The beginning of every step of the outline, in order: alive during preprocessing only.
std::vector<Position> walk_round(const Path& path) {
  std::vector<Position> steps{first_position(path)};
  while (steps.size() < path.steps_per_loop()) steps.push_back(next_position(path, steps.back()));
  return steps;
}

/// A place on the step that begins at `begin`.
Position place_on(const Path& path, const Position& begin, double u) {
  Position at = begin;
  at.u = u;
  at.here = begin.before + path.integrate(begin.curve, path.step(begin.curve, begin.index).lo, u);
  at.local = path.at(begin.curve, u);
  return at;
}

/// The step on which a zero lies: the last that begins at or before it.
const Position& step_of(const std::vector<Position>& steps, const Zero& zero) {
  const auto after = std::upper_bound(steps.begin(), steps.end(), zero, [](const Zero& place, const Position& step) {
    return place.curve != step.curve ? place.curve < step.curve : place.u < step.u;
  });
  return *(after - 1);
}

}  // namespace

Preprocessed preprocess(const Path& path) {
  // One walk gives P, the total integral and the places of all steps, from which each z_i is reached without walking.
  const std::vector<Position> steps = walk_round(path);
  Preprocessed result;
  result.front = steps.front();
  result.loop = steps.back().before + steps.back().step;
  for (const Position& step : steps) {
    if (step.index == 0) result.curve_starts.push_back(step.before.length);
    result.variation += std::fabs(step.step.integral);
  }
  result.back = place_on(path, steps.back(), path.step(steps.back().curve, steps.back().index).hi);
  // The walk's own sums, so that s = P and the loop agree to the last bit.
  result.back.here = result.loop;

  const Samples samples = sample(path);
  check_preconditions(path, result, samples);

  const Zeros zeros = find_zeros(path, samples);
  result.first_sign = zeros.first_sign;
  for (const Zero& zero : zeros.list) {
    const Position at = place_on(path, step_of(steps, zero), zero.u);
    if (!zero.simple) {
      const Density& density = path.density();
      throw Refusal(Reason::degenerate_zero, at.here.length,
                    fmt::format("march: expected every {} to be simple, found {} and its slope zero at s = {:.17g}; "
                                "rollfix::locate handles it",
                                density.zero_name, density.name, at.here.length));
    }
    result.changes.push_back({at, zero.sign_after});
  }
  return result;
}

}  // namespace rollfix::march
