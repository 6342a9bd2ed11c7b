#include "rollfix/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "outline/turning_span.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

double curvature(const Jet& jet) {
  const double speed_squared = jet.first.squaredNorm();
  return cross(jet.first, jet.second) / (speed_squared * std::sqrt(speed_squared));
}

double curvature_rate(const Jet& jet) {
  const double speed_squared = jet.first.squaredNorm();
  const double turning = cross(jet.first, jet.second);
  const double turning_rate = cross(jet.first, jet.third);
  const double stretching = jet.first.dot(jet.second);
  return (turning_rate - 3 * turning * stretching / speed_squared) / (speed_squared * std::sqrt(speed_squared));
}

namespace {

/// What the record of a reversed curve has before its kind.
constexpr std::string_view kReversedPrefix = "reversed ";

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
  std::optional<CurveRecord> record() const { return backwards(original.record()); }
  std::optional<CurveRecord> formula() const { return backwards(original.formula()); }
  /// Every formula runs over the same range as the curve.
  double formula_parameter(double u) const { return mirror(original.formula_parameter(mirror(u))); }

  static std::optional<CurveRecord> backwards(std::optional<CurveRecord> forwards) {
    if (forwards) forwards->kind.insert(0, kReversedPrefix);
    return forwards;
  }
};

/// What the record of a scaled curve has before its kind; the factor is its last number.
constexpr std::string_view kScaledPrefix = "scaled ";

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

  bool left() const { return next_ < all_.size(); }
  double number() { return all_[next_++]; }
  Vec2 point() { return Vec2{number(), number()}; }

 private:
  const std::vector<double>& all_;
  std::size_t next_ = 0;
};

struct WrittenControls {
  std::vector<Vec2> points;
  std::vector<double> weights;
};

WrittenControls controls(Numbers& numbers, bool rational) {
  WrittenControls result;
  while (numbers.left()) {
    result.points.push_back(numbers.point());
    if (rational) result.weights.push_back(numbers.number());
  }
  return result;
}

// Braces take the numbers from left to right.

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

struct Kind {
  std::string_view name;
  std::size_t numbers;  // that it takes, or ...
  bool or_a_multiple;   // ... a multiple of it
  Curve (*make)(Numbers&);
};

constexpr std::array<Kind, 11> kKinds = {{
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

Curve curve_from(const CurveRecord& record) {
  if (record.kind.rfind(kReversedPrefix, 0) == 0) {
    return reversed(curve_from({record.kind.substr(kReversedPrefix.size()), record.numbers}));
  }
  if (record.kind.rfind(kScaledPrefix, 0) == 0) {
    if (record.numbers.empty() || !(record.numbers.back() > 0)) {
      throw InputError(fmt::format("a curve of kind '{}' ends with a factor above 0", record.kind));
    }
    return scaled(
        curve_from({record.kind.substr(kScaledPrefix.size()), {record.numbers.begin(), record.numbers.end() - 1}}),
        record.numbers.back());
  }
  const auto* const kind =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& one) { return one.name == record.kind; });
  if (kind == kKinds.end()) throw InputError(fmt::format("the curve kind '{}' is not known", record.kind));
  const std::size_t count = record.numbers.size();
  const bool fits = kind->or_a_multiple ? count % kind->numbers == 0 : count == kind->numbers;
  if (!fits) {
    throw InputError(fmt::format("a curve of kind '{}' takes {} numbers{}, found {}", record.kind, kind->numbers,
                                 kind->or_a_multiple ? " for each control point" : "", count));
  }
  Numbers numbers(record.numbers);
  return kind->make(numbers);
}

}  // namespace rollfix
