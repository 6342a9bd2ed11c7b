#include <fmt/format.h>
#include <cmath>
#include <utility>

#include "march/sweep.hpp"
#include "rollfix/march.hpp"
#include "rollfix/turning_function.hpp"

// Notation (section 2.1; docs/march.md, "Convex boundary: Cases 1 and 2")
//   s_i, t_i    the march's two sequences: `pair.s`, `pair.t`, arc lengths; the segment is [s_i, t_i]
//   L, theta    the segment wanted: `problem.length`, and `problem.integral`, C for a general density
//   rho(s)      length of the segment from s on that has total curvature theta; found by `to_integral`, never stored
//   kappa       curvature, or another density: `density()`; a, b are the ends of the segment that is found
// Idea: s and t move in turn, each until one of equations (4) and (5) holds; Lemma 1 has both grow towards a and b
// without passing them, Lemma 2 says how fast, and Proposition 3 that the limit is the first segment that fits.
namespace rollfix::march {

namespace {

using End = Approach::End;

/// The mode's end is known from preprocessing, and the target lies beyond it: no need to go and see.
bool beyond(const std::optional<Position>& mark, double target, int sign) {
  return mark && sign * (target - mark->here.integral) > 0;
}

/// Case 1, rho(s_i) > L: t_i = s_i + rho(s_i); s_{i+1} = t_i - L.
End case_1(Pair& pair, const Mode& mode, const LimitRule& rule, Approach& result) {
  const double target = pair.s.integral() + pair.problem.integral;
  if (beyond(mode.t_mark, target, mode.sign_t)) return End::exit;
  if (!pair.t.to_integral(target, mode.sign_t, mode.t_end)) return End::exit;  // Phi(s_i, t_i) = theta
  const double next = pair.t.length() - pair.problem.length;                   // s_{i+1} = t_i - L
  // >= 0 by Lemma 1: phi(s_i) is short of C, so that t_i lies beyond s_i + L.
  const double advance = next - pair.s.length();
  pair.s.to_length(next);
  result.rate = pair.s.density() / pair.t.density();  // Lemma 2: kappa(a) / kappa(b)
  return judge(advance, result.rate, rule, result.error);
}

/// Case 2, rho(s_i) < L: t_i = s_i + L; Phi(s_{i+1}, t_i) = theta.
End case_2(Pair& pair, const Mode& mode, const LimitRule& rule, Approach& result) {
  const double target = pair.t.integral() - pair.problem.integral;
  const double before = pair.s.length();
  if (beyond(mode.s_mark, target, mode.sign_s)) return End::exit;
  if (!pair.s.to_integral(target, mode.sign_s, mode.s_end)) return End::exit;  // Phi(s_{i+1}, t_i) = theta
  pair.t.to_length(pair.s.length() + pair.problem.length);                     // t_{i+1} = s_{i+1} + L
  result.rate = pair.t.density() / pair.s.density();                           // Lemma 2: kappa(b) / kappa(a)
  return judge(pair.s.length() - before, result.rate, rule, result.error);
}

}  // namespace

void Mode::finish(Pair& pair) const {
  if (s_mark) {
    pair.s.jump(*s_mark);
  } else {
    pair.s.to_length(s_end);
  }
  if (t_mark) {
    pair.t.jump(*t_mark);
  } else {
    pair.t.to_length(t_end);
  }
}

Found case_of(const Pair& pair, const Mode& mode) {
  return mode.sign_s * pair.excess() < 0 ? Found::case_1 : Found::case_2;
}

/// The case holds for the whole approach: s_{i+1} never passes the root, so that phi - C keeps its sign.
Approach alternate(Pair& pair, const Mode& mode, const LimitRule& rule, std::vector<Iterate>* sequence) {
  Approach result{End::going_on};
  const bool falls_short = case_of(pair, mode) == Found::case_1;
  while (result.end == End::going_on && result.iterations < rule.iterations) {
    Iterate iterate{pair.s.length(), pair.t.length()};
    result.end = falls_short ? case_1(pair, mode, rule, result) : case_2(pair, mode, rule, result);
    if (falls_short) iterate.end = pair.t.length();
    if (sequence != nullptr) sequence->push_back(iterate);
    ++result.iterations;
  }
  if (result.end == End::going_on) result.end = End::stalled;
  return result;
}

// ---- the march
// Notation (sections 2 and 5, eqs. (4) to (6))
//   g, C      density, and the value of its integral that is wanted: g = kappa, C = theta is eq. (5);
//             g = kappa', C = 0 is eq. (6), kappa(t) - kappa(s) = 0: the stationary points of phi;
//             any other g is section 5's problem
//   L, P      length of the segment, `length`, and the perimeter
//   segments  the answer: all [s, s + L] over which g integrates to C
// Idea: a length of more than a loop is reduced by whole loops, and their integral taken off C. What is left slides
// once along the boundary (sweep.cpp).

namespace {

/// A length within this part of P of a whole number of loops is that number of loops: the integral is then the same for
/// every start, up to what the length's own rounding explains.
constexpr double kWholeLoop = 1e-12;
/// ... and equals C to rounding if it does to this part of the density's variation.
constexpr double kWholeLoopIntegral = 1e-11;

/// The smallest reset that is accepted, as a part of P: a few units in the last place of s.
constexpr double kLeastReset = 1e-15;

/// Throws InputError for an option out of range. A reset below the limit is allowed here: finds may then repeat, which
/// Result::found_again counts.
void check(const Options& options) {
  const auto expect = [](bool good, const char* what, double found) {
    if (!good) throw InputError(fmt::format("march: expected {}, found {}", what, found));
  };
  expect(options.step >= 0 && std::isfinite(options.step), "a step that is positive, or 0 for automatic", options.step);
  expect(options.limit >= kLeastLimit && options.limit < 1, "a limit from 1e-14 to 1 (parts of P)", options.limit);
  expect(options.reset >= kLeastReset && options.reset < 1, "a reset from 1e-15 to 1 (parts of P)", options.reset);
  expect(options.iterations > 0, "at least one iteration per limit", 0);
}

}  // namespace

/// g = kappa, in radians per unit of length: eq. (5).
Density curvature_density() {
  return {Density::Kind::curvature, "the curvature", "inflection",
          [](const Site& site) { return curvature(site.jet); }};
}

/// g = d kappa / ds: the derivative by the curve's own parameter, divided by the speed |alpha'|. Eq. (6).
Density curvature_rate_density() {
  return {Density::Kind::curvature_rate, "the curvature's derivative", "vertex",
          [](const Site& site) { return curvature_rate(site.jet) / site.jet.first.norm(); }};
}

/// g = f of section 5. The march learns its zeros from samples, as those of the other two.
Density density(DensityFunction f, std::string name) {
  return {Density::Kind::other, std::move(name), "sign change", std::move(f)};
}

/// What is computed once per outline and density: the steps, and the sign changes with their sums.
struct March::Data {
  Data(const Outline& outline, const Density& density, const Options& given)
      : options(given), path(outline, density, given.step), preprocessed(preprocess(path)) {}

  double perimeter() const { return preprocessed.loop.length; }
  /// the counts and errors that every result of this outline has
  Result prepared_result() const;
  /// L of either sign and any size
  Result on_closed(double length, double integral) const;
  /// |L| <= P
  Result on_open(double length, double integral) const;
  /// L = 0 after its reduction
  Result without_length(double integral) const;

  Options options;
  Path path;
  Preprocessed preprocessed;
};

/// Whole loops add the same length and the same integral to every segment: what is left of L lies in [0, P).
Result March::Data::on_closed(double length, double integral) const {
  double loops = std::floor(length / perimeter());
  double rest = length - loops * perimeter();
  // A rest just below P is a whole loop with rounding errors.
  if (rest >= perimeter() * (1 - kWholeLoop)) {
    loops += 1;
    rest = 0;
  }
  // C without the loops' part; for kappa that is 2 pi each on a simple loop.
  const double left = integral - loops * preprocessed.loop.integral;
  if (rest <= kWholeLoop * perimeter()) return without_length(left);
  Result result = prepared_result();
  sweep(path, preprocessed, {rest, left}, options, result);
  // The sweep's ends are not reduced: t goes on to s + L.
  for (Segment& segment : result.segments) {
    segment.start = wrap(segment.start, perimeter()).base;
    segment.end = wrap(segment.end, perimeter()).base;
  }
  return result;
}

/// A segment of negative length is the segment between the same two points, walked from the other end.
Result March::Data::on_open(double length, double integral) const {
  if (std::fabs(length) > perimeter() * (1 + kWholeLoop)) {
    throw InputError(fmt::format("march: expected a length of at most {:.17g}, that of the open outline, found {:.17g}",
                                 perimeter(), length));
  }
  if (std::fabs(length) <= kWholeLoop * perimeter()) return without_length(integral);
  Result result = prepared_result();
  sweep(path, preprocessed, {std::fabs(length), length < 0 ? -integral : integral}, options, result);
  // s + L may exceed P by rounding on an open outline.
  for (Segment& segment : result.segments) {
    segment.end = std::fmin(segment.end, perimeter());
    if (length < 0) std::swap(segment.start, segment.end);
  }
  // Doubts are about starts of the segment asked for: the other end, |L| further on.
  if (length < 0) {
    for (Doubt& doubt : result.doubts) doubt.where = {doubt.where.lo - length, doubt.where.hi - length};
  }
  return result;
}

/// L is nothing but whole loops: every start fits, or none.
Result March::Data::without_length(double integral) const {
  if (std::fabs(integral) <= kWholeLoopIntegral * preprocessed.variation) {
    throw Refusal(
        Reason::continuum, 0,
        "march: expected isolated segments, found that every start fits (the length is zero or a whole number "
        "of loops); rollfix::locate reports such stretches");
  }
  return prepared_result();
}

/// What does not depend on the question.
Result March::Data::prepared_result() const {
  Result result;
  result.steps.choosing = path.choosing_steps();
  result.steps.preprocessing = path.steps_per_loop();
  result.perimeter = preprocessed.loop.length;
  result.parameter_range = path.parameter_range();
  result.steps_per_loop = path.steps_per_loop();
  result.length_error = path.loop_error().length;
  result.integral_error = path.loop_error().integral;
  result.step = path.parameter_range() / static_cast<double>(path.steps_per_loop());
  return result;
}

March::March(const Outline& outline, const Density& density, const Options& options) {
  check(options);
  data_ = std::make_shared<const Data>(outline, density, options);
}

Result March::segments(double length, double integral) const {
  if (!std::isfinite(length) || !std::isfinite(integral)) {
    throw InputError(fmt::format("march: expected finite numbers, found length {} and integral {}", length, integral));
  }
  return data_->path.closed() ? data_->on_closed(length, integral) : data_->on_open(length, integral);
}

/// The z_i with their sums from s = 0.
std::vector<Breakpoint> March::breakpoints() const {
  std::vector<Breakpoint> points;
  for (const SignChange& change : data_->preprocessed.changes) {
    points.push_back({change.at.here.length, change.at.here.integral, change.sign_after});
  }
  return points;
}

Result locate(const Outline& outline, const Reading& reading, const Options& options) {
  return March(outline, curvature_density(), options).segments(reading.length[0], reading.turn);
}

Result stationary_points(const Outline& outline, double length, const Options& options) {
  return March(outline, curvature_rate_density(), options).segments(length, 0);
}

Result segments_with_integral(const Outline& outline, const DensityFunction& f, double length, double integral,
                              const Options& options) {
  return March(outline, density(f), options).segments(length, integral);
}

}  // namespace rollfix::march
