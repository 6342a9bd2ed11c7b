#include "rollfix/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"

// Curves as such, seen backwards and scaled; lines, arcs, and spans by their turning; and what makes them of records.
// Notation:
//   c(u), jet       a place on a curve, with its first three derivatives: Jet
//   kappa           c' x c'' / |c'|^3: `curvature`; its derivative by u: `curvature_rate`
//   start, side     of an arc c + cos(u) start + sin(u) side, also of an ellipse's
//   theta(s)        of a span a cubic of its length s: `turning_`; c(s) = start + integral of (cos theta, sin theta)
// Follows docs/notation.md; the span's integral is Gauss and Legendre's rule of 12 points.
namespace rollfix {

/// kappa = c' x c'' / |c'|^3, in 1 / length; not finite where the speed is 0.
double curvature(const Jet& jet) {
  const double speed_squared = jet.first.squaredNorm();
  return cross(jet.first, jet.second) / (speed_squared * std::sqrt(speed_squared));
}

/// d kappa / du, by the quotient rule: (c' x c''' - 3 (c' x c'') (c' . c'') / |c'|^2) / |c'|^3. The term c'' x c'' is
/// 0.
double curvature_rate(const Jet& jet) {
  const double speed_squared = jet.first.squaredNorm();
  // c' x c'', its derivative c' x c''', and c' . c'', half the derivative of |c'|^2.
  const double turning = cross(jet.first, jet.second);
  const double turning_rate = cross(jet.first, jet.third);
  const double stretching = jet.first.dot(jet.second);
  return (turning_rate - 3 * turning * stretching / speed_squared) / (speed_squared * std::sqrt(speed_squared));
}

namespace {

/// What the record of a reversed curve has before its kind.
constexpr std::string_view kReversedPrefix = "reversed ";

/// The curve seen backwards: c(lo + hi - u) over the same domain. Derivatives of odd order change their sign, and so
/// does kappa.
struct Reversed {
  Curve original;

  Interval domain() const { return original.domain(); }
  double mirror(double u) const { return domain().lo + (domain().hi - u); }
  Jet jet(double u) const {
    const Jet forward = original.jet(mirror(u));
    return {forward.position, -forward.first, forward.second, -forward.third};
  }
  Vec2 velocity(double u) const { return -original.velocity(mirror(u)); }
  /// What is small on one side of a mirror is not on the other.
  double parameter_size(const Interval& range) const {
    return original.parameter_size({std::min(mirror(range.hi), range.lo), std::max(mirror(range.lo), range.hi)});
  }
  // Twice reversed keeps two prefixes: the record makes the same curve again.
  std::optional<CurveRecord> record() const { return backwards(original.record()); }
  std::optional<CurveRecord> formula() const { return backwards(original.formula()); }
  /// Every formula runs over the same range as the curve.
  double formula_parameter(double u) const { return mirror(original.formula_parameter(mirror(u))); }

  /// The record with the prefix; nothing stays nothing.
  static std::optional<CurveRecord> backwards(std::optional<CurveRecord> forwards) {
    if (forwards) forwards->kind.insert(0, kReversedPrefix);
    return forwards;
  }
};

/// What the record of a scaled curve has before its kind; the factor is its last number.
constexpr std::string_view kScaledPrefix = "scaled ";

/// All lengths times a factor above 0. The parameter stays, so all derivatives are multiplied by it; kappa is divided
/// by it.
struct Scaled {
  Curve original;
  double factor;

  Interval domain() const { return original.domain(); }
  Jet jet(double u) const {
    const Jet jet = original.jet(u);
    return {factor * jet.position, factor * jet.first, factor * jet.second, factor * jet.third};
  }
  Vec2 velocity(double u) const { return factor * original.velocity(u); }
  double parameter_size(const Interval& range) const { return original.parameter_size(range); }
  std::optional<CurveRecord> record() const { return times(original.record()); }
  std::optional<CurveRecord> formula() const { return times(original.formula()); }
  double formula_parameter(double u) const { return original.formula_parameter(u); }

  /// The record with the prefix and the factor behind its numbers.
  std::optional<CurveRecord> times(std::optional<CurveRecord> record) const {
    if (!record) return record;
    record->kind.insert(0, kScaledPrefix);
    record->numbers.push_back(factor);
    return record;
  }
};

}  // namespace

Curve reversed(const Curve& curve) { return Reversed{curve}; }

Curve scaled(const Curve& curve, double factor) { return Scaled{curve, factor}; }

namespace {

/// Hands out the numbers of a record one after the other.
class Numbers {
 public:
  explicit Numbers(const std::vector<double>& all) : all_(all) {}

  /// Whether any are left. The counts are checked before: number() is not asked for more than there are.
  bool left() const { return next_ < all_.size(); }
  double number() { return all_[next_++]; }
  Vec2 point() { return Vec2{number(), number()}; }

 private:
  const std::vector<double>& all_;  // in the record's order
  std::size_t next_ = 0;
};

/// Control points as a record has them; weights empty: all equal.
struct WrittenControls {
  std::vector<Vec2> points;
  std::vector<double> weights;
};

/// Reads x, y, and of a rational curve the weight, until no numbers are left.
WrittenControls controls(Numbers& numbers, bool rational) {
  WrittenControls result;
  while (numbers.left()) {
    result.points.push_back(numbers.point());
    if (rational) result.weights.push_back(numbers.number());
  }
  return result;
}

// Each makes one kind of curve of its record's numbers. Braces take the numbers from left to right, which the arguments
// of a call in parentheses need not.

Curve line(Numbers& n) { return Line{n.point(), n.point()}; }
Curve arc(Numbers& n) { return Arc{n.point(), n.number(), n.number(), n.number()}; }
Curve elliptic_arc(Numbers& n) { return EllipticArc{n.point(), n.point(), n.point(), n.number(), n.number()}; }
Curve cubic(Numbers& n) { return CubicSpan{n.point(), n.point(), n.point(), n.point()}; }
Curve turning_span(Numbers& n) {
  return TurningSpan{n.point(), {n.number(), n.number(), n.number(), n.number()}, n.number()};
}

template <bool Rational>
Curve bezier(Numbers& numbers) {
  WrittenControls all = controls(numbers, Rational);
  return Bezier(std::move(all.points), std::move(all.weights));
}

template <bool Rational, Rest End>
Curve resting_bezier(Numbers& numbers) {
  WrittenControls all = controls(numbers, Rational);
  return BezierFromRest(std::move(all.points), std::move(all.weights), End);
}

/// A kind of record, and what makes a curve of it.
struct CurveKind {
  std::string_view name;  // in the record
  std::size_t numbers;    // that it takes, or ...
  bool or_a_multiple;     // ... a multiple of it
  Curve (*make)(Numbers&);
};

// The names are part of the format of saved parts: a name that changed would not be read any more.
constexpr std::array<CurveKind, 11> kKinds = {{
    {"line", 4, false, line},
    {"arc", 5, false, arc},
    {"elliptic-arc", 8, false, elliptic_arc},
    {"cubic", 8, false, cubic},
    {"turning", 7, false, turning_span},
    {"bezier", 2, true, bezier<false>},
    {"rational-bezier", 3, true, bezier<true>},
    {"bezier-from-rest", 2, true, resting_bezier<false, Rest::start>},
    {"bezier-to-rest", 2, true, resting_bezier<false, Rest::end>},
    {"rational-bezier-from-rest", 3, true, resting_bezier<true, Rest::start>},
    {"rational-bezier-to-rest", 3, true, resting_bezier<true, Rest::end>},
}};

}  // namespace

/// Undoes one prefix and calls itself, or looks the kind up. The curves' own constructors check the numbers.
Curve curve_from(const CurveRecord& record) {
  if (record.kind.rfind(kReversedPrefix, 0) == 0) {
    return reversed(curve_from({record.kind.substr(kReversedPrefix.size()), record.numbers}));
  }
  if (record.kind.rfind(kScaledPrefix, 0) == 0) {
    // The prefix was put in front last, and its factor behind last: both are taken off first.
    if (record.numbers.empty() || !(record.numbers.back() > 0)) {
      throw InputError(fmt::format("a curve of kind '{}' ends with a factor above 0", record.kind));
    }
    return scaled(
        curve_from({record.kind.substr(kScaledPrefix.size()), {record.numbers.begin(), record.numbers.end() - 1}}),
        record.numbers.back());
  }
  // By the name in full: "bezier" is not taken for the start of "bezier-from-rest".
  const auto* const kind =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const CurveKind& one) { return one.name == record.kind; });
  if (kind == kKinds.end()) throw InputError(fmt::format("the curve kind '{}' is not known", record.kind));
  const std::size_t count = record.numbers.size();
  // Control points are as many as the record has numbers for.
  const bool fits = kind->or_a_multiple ? count % kind->numbers == 0 : count == kind->numbers;
  if (!fits) {
    throw InputError(fmt::format("a curve of kind '{}' takes {} numbers{}, found {}", record.kind, kind->numbers,
                                 kind->or_a_multiple ? " for each control point" : "", count));
  }
  Numbers numbers(record.numbers);
  return kind->make(numbers);
}

/// Refuses a line of no length, and one whose ends are not numbers.
Line::Line(const Vec2& from, const Vec2& to) : from_(from), to_(to), chord_(to - from) {
  if (!(chord_.squaredNorm() > 0)) {
    throw InputError(fmt::format("a line from ({}, {}) to ({}, {}) has no length; leave it out", from.x(), from.y(),
                                 to.x(), to.y()));
  }
}

namespace {

/// d/du of cos(u) start + sin(u) side ...
Vec2 turned_velocity(const Vec2& start, const Vec2& side, double u) {
  const Turn turn = turn_by(u);
  return turn.cosine * side - turn.sine * start;
}

/// ... and all of it, from the centre.
Jet turned_jet(const Vec2& centre, const Vec2& start, const Vec2& side, double u) {
  const Turn turn = turn_by(u);
  const Vec2 spoke = turn.cosine * start + turn.sine * side;
  const Vec2 first = turn.cosine * side - turn.sine * start;
  return {centre + spoke, first, -spoke, -first};
}

/// Throws InputError: a sweep of 0, beyond a full turn, or not a number; or a `from` that is not finite.
void require_sweep(const char* what, double from, double sweep) {
  const double angle = std::abs(sweep);
  if (angle > 0 && angle <= kFullTurn && std::isfinite(from)) return;
  throw InputError(fmt::format(
      "{} from angle {} with a sweep of {} rad: the sweep's size must be above 0 and at most 2 pi", what, from, sweep));
}

}  // namespace

/// The parameter is the angle turned so far: the curve is start and side turned by u; side is a right angle ahead of
/// start in the direction of travel.
Arc::Arc(const Vec2& centre, double radius, double from, double sweep)
    : centre_(centre),
      start_(radius * Vec2(std::cos(from), std::sin(from))),
      angle_(std::abs(sweep)),
      radius_(radius),
      from_(from),
      sweep_(sweep) {
  if (!(radius > 0) || !std::isfinite(radius)) {
    throw InputError(fmt::format("an arc of radius {}: the radius must be above 0", radius));
  }
  require_sweep("an arc", from, sweep);
  // Clockwise, side points to the other side.
  const double sign = sweep > 0 ? 1 : -1;
  side_ = sign * Vec2(-start_.y(), start_.x());
}

Vec2 Arc::velocity(double u) const { return turned_velocity(start_, side_, u); }

Jet Arc::jet(double u) const { return turned_jet(centre_, start_, side_, u); }

/// cos(from + u) major + sin(from + u) minor = cos(u) start + sin(u) side, with from - u for a sweep below 0. So start
/// and side are conjugate half axes.
EllipticArc::EllipticArc(const Vec2& centre, const Vec2& major, const Vec2& minor, double from, double sweep)
    : centre_(centre), angle_(std::abs(sweep)), major_(major), minor_(minor), from_(from), sweep_(sweep) {
  // The half axes' cross product is 0 where they are parallel or one has no length.
  const double area = std::abs(cross(major, minor));
  if (!centre.allFinite() || !(area > 0) || !std::isfinite(area)) {
    throw InputError(fmt::format("an ellipse with the half axes ({}, {}) and ({}, {}): they must not be parallel",
                                 major.x(), major.y(), minor.x(), minor.y()));
  }
  require_sweep("an elliptic arc", from, sweep);
  const double sign = sweep > 0 ? 1 : -1;
  start_ = std::cos(from) * major + std::sin(from) * minor;
  side_ = sign * (std::cos(from) * minor - std::sin(from) * major);
}

Vec2 EllipticArc::velocity(double u) const { return turned_velocity(start_, side_, u); }

Jet EllipticArc::jet(double u) const { return turned_jet(centre_, start_, side_, u); }

CurveRecord EllipticArc::record() const {
  return {"elliptic-arc", {centre_.x(), centre_.y(), major_.x(), major_.y(), minor_.x(), minor_.y(), from_, sweep_}};
}

namespace {

// For turns of at most one radian the error of 12 points is far below rounding.
using SpanQuadrature = boost::math::quadrature::gauss<double, 12>;

/// A span on which the sum of its terms' turns is a rounding error above the limit is taken.
constexpr double kSlack = 1e-9;

}  // namespace

/// The integral of |kappa| is at most that of |c1| + 2 |c2| s + 3 |c3| s^2.
double span_turn(const TurningSpan::Cubic& turning, double length) {
  return length * (std::abs(turning[1]) + length * (std::abs(turning[2]) + length * std::abs(turning[3])));
}

/// `turning`: c0 ... c3 of Theta(s), radians by powers of length.
TurningSpan::TurningSpan(const Vec2& start, const Cubic& turning, double length)
    : start_(start), turning_(turning), length_(length) {
  const bool is_finite =
      start.allFinite() && std::all_of(turning.begin(), turning.end(), [](double c) { return std::isfinite(c); });
  if (!is_finite || !std::isfinite(length) || !(length > 0)) {
    throw InputError(
        fmt::format("a span by its turning from ({}, {}), of length {}: expected finite numbers and a length above 0",
                    start.x(), start.y(), length));
  }
  if (!(span_turn(turning, length) <= kMostSpanTurn + kSlack)) {
    throw InputError(
        fmt::format("a span by its turning that may turn by {}: expected at most {} rad, cut it into several",
                    span_turn(turning, length), kMostSpanTurn));
  }
}

/// Of unit length, as the parameter is the arc length.
Vec2 TurningSpan::velocity(double s) const {
  const double theta = angle(s);
  return {std::cos(theta), std::sin(theta)};
}

/// The start plus the integral of the velocity over [0, s]; the rule's nodes come in pairs about the middle.
Vec2 TurningSpan::position(double s) const {
  const double half = 0.5 * s;
  const auto& nodes = SpanQuadrature::abscissa();
  const auto& weights = SpanQuadrature::weights();
  Vec2 sum = Vec2::Zero();
  // The table has the nodes above 0 only; each stands for itself and its mirror image.
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double reach = half * nodes[k];
    sum += weights[k] * (velocity(half + reach) + velocity(half - reach));
  }
  return start_ + half * sum;
}

/// With T the tangent and n its left normal: c'' = kappa n and c''' = kappa' n - kappa^2 T.
Jet TurningSpan::jet(double s) const {
  const Vec2 tangent = velocity(s);
  const Vec2 normal(-tangent.y(), tangent.x());
  // kappa = Theta' and kappa' = Theta''.
  const double curvature = turning_[1] + s * (2 * turning_[2] + s * 3 * turning_[3]);
  const double rate = 2 * turning_[2] + s * 6 * turning_[3];
  return {position(s), tangent, curvature * normal, rate * normal - (curvature * curvature) * tangent};
}

CurveRecord TurningSpan::record() const {
  return {"turning", {start_.x(), start_.y(), turning_[0], turning_[1], turning_[2], turning_[3], length_}};
}

}  // namespace rollfix
