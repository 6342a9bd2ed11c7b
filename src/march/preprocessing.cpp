#include <fmt/format.h>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "march/sweep.hpp"
#include "outline/turn.hpp"

// Notation (section 2.2, preprocessing)
//   g        density: the curvature (its zeros are inflections), its derivative by s (vertices), or another
//   z        a sign change of g, as a curve and a parameter u on it
//   order    of a zero: g grows like (u - z)^order; a simple one has order 1, footnotes 1 and 2 of the paper
// Idea: g is sampled as densely as it is integrated; between samples of different signs a root is bracketed (TOMS 748,
// Alefeld, Potra, Shi 1995), between samples of one sign the local minimum of |g| tells whether it touches zero.
namespace rollfix::march {

namespace {

/// As dense as the quadrature's nodes: what lies between them is searched by its local minima.
constexpr std::size_t kSamplesPerStep = 6;
/// At the ends of a curve smaller densities (against the largest on the outline) are taken as zero: the sign there is
/// that of the nearest inner sample, and a sign change lies at the joint.
constexpr double kZeroAtJoint = 1e-12;
/// A local minimum of |g| below this (against the largest) is a zero without a sign change.
constexpr double kTouchingZero = 1e-9;
/// A zero's order is measured at one and at two of these parts of a step beside it.
constexpr double kOrderProbe = 1e-3;
/// g(2d)/g(d) is 2 at a simple zero and 8 at a threefold one; this lies between.
constexpr double kSimpleRatio = 4.0;
/// The minimum of |g| matters to half the digits of u only.
constexpr int kMinimumBits = 27;
constexpr std::uintmax_t kMostSolverRounds = 200;

/// -1, 0 or 1
int sign_of(double value) { return (value > 0) - (value < 0); }

/// One pass over the samples of all curves, in order. `last_sign_` is the sign of g before the sample in question: a
/// sample of the other sign means a sign change in between.
class Finder {
 public:
  Finder(const Path& path, const Samples& samples) : path_(path), samples_(samples) {}

  Zeros find() {
    for (std::size_t curve = 0; curve < path_.curves(); ++curve) find_on(curve);
    found_.first_sign = first_sign_;
    // The sign before s = P and the sign after s = 0 differ: one more sign change, at s = 0 itself.
    const bool at_seam = path_.closed() && last_sign_ == -first_sign_;
    if (at_seam) {
      const double u = samples_.curves.front().front().u;
      found_.list.insert(found_.list.begin(), Zero{0, u, first_sign_, is_simple(0, u)});
    }
    return found_;
  }

 private:
  /// The zeros on one curve, and the one at the joint where it begins.
  void find_on(std::size_t curve) {
    const std::vector<Sample>& values = samples_.curves[curve];
    const Sample* previous = nullptr;  // on this curve, with a sign
    for (std::size_t i = 0; i < values.size(); ++i) {
      look_beside(curve, i);
      const int sign = sign_at(values, i);
      // A sample is 0, at a joint to rounding: the next sample with a sign tells whether the sign changes there.
      if (sign == 0) continue;
      if (first_sign_ == 0) first_sign_ = sign;
      if (last_sign_ == -sign) {
        // Without a previous sample of its own the sign change lies where this curve begins.
        const double u = previous == nullptr ? values.front().u : zero_between(curve, previous->u, values[i].u);
        found_.list.push_back({curve, u, sign, is_simple(curve, u)});
      }
      last_sign_ = sign;
      previous = &values[i];
    }
  }

  /// Two sign changes, or a zero without one, may hide beside a sample at which |g| is least.
  void look_beside(std::size_t curve, std::size_t i) {
    const std::vector<Sample>& values = samples_.curves[curve];
    if (i == 0 || i + 1 >= values.size()) return;
    const Sample& before = values[i - 1];
    const Sample& after = values[i + 1];
    const int sign = sign_of(before.density);
    // Different signs are for find_on; beside a sample that is exactly 0 nothing can be told here.
    if (sign == 0 || sign_of(after.density) != sign || sign_of(values[i].density) == -sign) return;
    const double least = std::fabs(values[i].density);
    // Not the least of the three. One of both comparisons is strict: of two equal samples one is looked at.
    if (least > std::fabs(before.density) || least >= std::fabs(after.density)) return;
    const double most = std::max(std::fabs(before.density), std::fabs(after.density));
    if (least > most - least) return;  // a parabola through the three stays away from zero

    const auto [u, depth] = boost::math::tools::brent_find_minima([&](double x) { return sign * density(curve, x); },
                                                                  before.u, after.u, kMinimumBits);
    // The dip stays away from zero.
    if (depth > kTouchingZero * samples_.scale) return;
    // It touches zero, to rounding, or two zeros are too close to be told apart: not simple, and refused later.
    if (depth >= -kTouchingZero * samples_.scale) {
      found_.list.push_back({curve, u, sign, false});
      return;
    }
    // Below zero at the minimum: one sign change on each side of it.
    const double down = zero_between(curve, before.u, u);
    const double up = zero_between(curve, u, after.u);
    found_.list.push_back({curve, down, -sign, is_simple(curve, down)});
    found_.list.push_back({curve, up, sign, is_simple(curve, up)});
  }

  /// g at a parameter of a curve, per unit of arc length.
  double density(std::size_t curve, double u) const { return path_.at(curve, u).density; }

  /// The sign of a sample; 0 at either end of a curve where g is rounding only.
  int sign_at(const std::vector<Sample>& values, std::size_t i) const {
    const bool at_joint = i == 0 || i + 1 == values.size();
    if (at_joint && std::fabs(values[i].density) <= kZeroAtJoint * samples_.scale) return 0;
    return sign_of(values[i].density);
  }

  /// The parameter of a zero of g. REQUIRES g of different signs, or 0, at lo and hi.
  double zero_between(std::size_t curve, double lo, double hi) const {
    std::uintmax_t rounds = kMostSolverRounds;
    const auto [below, above] = boost::math::tools::toms748_solve([&](double u) { return density(curve, u); }, lo, hi,
                                                                  boost::math::tools::eps_tolerance<double>(), rounds);
    return 0.5 * (below + above);
  }

  /// Whether g grows like the distance from u on both sides, as far as they lie on this curve.
  bool is_simple(std::size_t curve, double u) const {
    const double lo = samples_.curves[curve].front().u;
    const double hi = samples_.curves[curve].back().u;
    const double probe = kOrderProbe * path_.step(curve, 0).width();
    for (const double d : {-probe, probe}) {
      if (u + 2 * d < lo || u + 2 * d > hi) continue;
      // g(2d) / g(d) is 2 to the power of the zero's order, to first order in d.
      const double near = std::fabs(density(curve, u + d));
      const double far = std::fabs(density(curve, u + 2 * d));
      if (far > kSimpleRatio * near) return false;
    }
    return true;
  }

  const Path& path_;
  const Samples& samples_;
  Zeros found_;
  /// of g just after s = 0; 0 until a sample has a sign
  int first_sign_ = 0;
  /// of the last sample with a sign, on this curve or one before
  int last_sign_ = 0;
};

}  // namespace

/// g at six equally spaced parameters of each step and at each curve's end. Both curves have a sample at a joint: g may
/// jump there.
Samples sample(const Path& path) {
  Samples samples;
  for (std::size_t curve = 0; curve < path.curves(); ++curve) {
    std::vector<Sample> values;
    const auto add = [&](double u) {
      values.push_back({u, path.at(curve, u).density});
      samples.scale = std::max(samples.scale, std::fabs(values.back().density));
    };
    for (std::size_t index = 0; index < path.steps(curve); ++index) {
      const Interval step = path.step(curve, index);
      for (std::size_t k = 0; k < kSamplesPerStep; ++k) {
        add(step.lo + step.width() * (static_cast<double>(k) / static_cast<double>(kSamplesPerStep)));
      }
    }
    add(path.step(curve, path.steps(curve) - 1).hi);
    samples.curves.push_back(std::move(values));
  }
  return samples;
}

Zeros find_zeros(const Path& path, const Samples& samples) { return Finder(path, samples).find(); }

// ---- preprocessing
// Notation (section 2.2, "In preprocessing, we compute all points of inflection")
//   z_i          sign changes of the density g, `changes`, each with the length and the integral from s = 0 to it
//   P            perimeter, `loop.length`
//   variation    integral of |g| over the whole outline, to a few digits
//   Refusal      what the march is not made for: corners, lines, arcs, zeros not simple, for eq. (6) jumps of kappa
// Idea: what the paper asks of a curve (no corner, line or arc, simple inflections) is checked once, and said before
// it marches.

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
