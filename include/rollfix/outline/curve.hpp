#pragma once

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rollfix {

/// A point or a vector of the plane, in the outline's own unit.
using Vec2 = Eigen::Vector2d;

/// A 2 by 2 matrix that is laid out alike in every program: Eigen's own is aligned by the vector instructions that a
/// program is compiled for, and so would be all that holds it.
using Mat2 = Eigen::Matrix<double, 2, 2, Eigen::DontAlign>;

/// z component of the cross product: positive where b is to the left of a.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A closed interval of reals.
struct Interval {
  double lo = 0;
  double hi = 0;

  double width() const { return hi - lo; }
  double middle() const { return lo + 0.5 * (hi - lo); }
  bool contains(double value) const { return lo <= value && value <= hi; }
};

/// A curve's position and its exact derivatives by its own parameter, up to the third.
struct Jet {
  Vec2 position;
  Vec2 first;
  Vec2 second;
  Vec2 third;
};

/// Signed curvature (positive where the curve turns left) of a curve with these derivatives.
double curvature(const Jet& jet);

/// d(curvature)/d(parameter).
double curvature_rate(const Jet& jet);

/// What a curve was made of, so that a saved part can make it again to the bit: see curve_from.
struct CurveRecord {
  std::string kind;             // "line", "arc", ...
  std::vector<double> numbers;  // as its constructor took them
};

/// A smooth (analytic on its domain, ends included) regular curve: what a user's own type must offer
/// to become a part of an outline.
///   domain()    the parameter's interval, lo < hi
///   jet(u)      position and derivatives at u
/// A `velocity(u)` (the first derivative alone) is used where it exists, because arc length needs no more,
/// and a `record()` (a CurveRecord) so that a part made of it can be saved.
template <class C>
concept ParametricCurve = std::copy_constructible<C> && requires(const C& curve, double u) {
  { curve.domain() } -> std::convertible_to<Interval>;
  { curve.jet(u) } -> std::convertible_to<Jet>;
};

/// Any parametric curve, held by value: copies share the immutable original.
class Curve {
 public:
  // `same_as` first: whether a Curve can be copied must not be asked of this constructor.
  template <class C>
  requires(!std::same_as<C, Curve> && ParametricCurve<C>) Curve(C curve)
      : model_(std::make_shared<Model<C>>(std::move(curve))) {}  // NOLINT(google-explicit-constructor)

  Interval domain() const { return model_->domain(); }
  Jet jet(double u) const { return model_->jet(u); }
  Vec2 velocity(double u) const { return model_->velocity(u); }
  Vec2 position(double u) const { return model_->jet(u).position; }
  Vec2 front() const { return position(domain().lo); }
  Vec2 back() const { return position(domain().hi); }
  /// The size of the numbers that the parameters of this range are rounded as. The range's own, for a curve type that
  /// does not tell.
  double parameter_size(const Interval& range) const { return model_->parameter_size(range); }
  /// Nothing for a curve type that does not offer it.
  std::optional<CurveRecord> record() const { return model_->record(); }
  /// The same curve by the formula that certificates know it by, with the parameter that it has there where this one's
  /// is u: the record, for a curve type that has no other.
  std::optional<CurveRecord> formula() const { return model_->formula(); }
  double formula_parameter(double u) const { return model_->formula_parameter(u); }

 private:
  struct Interface {
    virtual ~Interface() = default;
    virtual Interval domain() const = 0;
    virtual Jet jet(double u) const = 0;
    virtual Vec2 velocity(double u) const = 0;
    virtual double parameter_size(const Interval& range) const = 0;
    virtual std::optional<CurveRecord> record() const = 0;
    virtual std::optional<CurveRecord> formula() const = 0;
    virtual double formula_parameter(double u) const = 0;
  };

  template <class C>
  struct Model final : Interface {
    explicit Model(C own) : curve(std::move(own)) {}
    Interval domain() const override { return curve.domain(); }
    Jet jet(double u) const override { return curve.jet(u); }
    Vec2 velocity(double u) const override {
      if constexpr (requires { curve.velocity(u); }) {
        return curve.velocity(u);
      } else {
        return curve.jet(u).first;
      }
    }
    double parameter_size(const Interval& range) const override {
      if constexpr (requires { curve.parameter_size(range); }) {
        return curve.parameter_size(range);
      } else {
        return std::max(std::abs(range.lo), std::abs(range.hi));
      }
    }
    std::optional<CurveRecord> record() const override {
      if constexpr (requires { curve.record(); }) {
        return curve.record();
      } else {
        return std::nullopt;
      }
    }
    std::optional<CurveRecord> formula() const override {
      if constexpr (requires { curve.formula(); }) {
        return curve.formula();
      } else {
        return record();
      }
    }
    double formula_parameter(double u) const override {
      if constexpr (requires { curve.formula_parameter(u); }) {
        return curve.formula_parameter(u);
      } else {
        return u;
      }
    }
    C curve;
  };

  std::shared_ptr<const Interface> model_;
};

/// The same points in the opposite direction; the parameter runs over the same interval.
Curve reversed(const Curve& curve);

/// The same curve with all lengths so many times as long, seen from the origin; factor above 0.
Curve scaled(const Curve& curve, double factor);

/// The curve that has this record, to the bit. Throws InputError: a kind that is not known, another number of numbers
/// than it takes, or numbers that its constructor refuses.
Curve curve_from(const CurveRecord& record);

}  // namespace rollfix
