#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/march/march.hpp"
#include "rollfix/outline/outline.hpp"

namespace rollfix::march {

/// What is summed up along the boundary.
struct Span {
  double length = 0;    // integral of |alpha'| du, eq. (4)
  double integral = 0;  // integral of g |alpha'| du, eq. (5) when g is the curvature

  Span operator+(const Span& other) const { return {length + other.length, integral + other.integral}; }
  Span operator-(const Span& other) const { return {length - other.length, integral - other.integral}; }
  Span operator*(double factor) const { return {length * factor, integral * factor}; }
};

/// The integrands at one point.
struct Local {
  double speed = 0;    // |alpha'|
  double density = 0;  // g, per unit of arc length

  /// Both per unit of the parameter.
  Span spans() const { return {speed, speed * density}; }
};

/// An outline cut into steps of its parameter, with the quadrature rule that integrates over them. All that the march
/// knows of lengths and integrals comes from here: no closed form, no table.
class Path {
 public:
  /// `step` 0: on each curve the largest, of a halving sequence, that integrates each step to rounding.
  /// Throws Refusal (unresolved) for a curve on which the sequence ends before that, near a cusp for example.
  Path(Outline outline, Density density, double step);

  const Outline& outline() const { return outline_; }
  const Density& density() const { return density_; }
  bool closed() const { return outline_.closed; }
  std::size_t curves() const { return outline_.curves.size(); }
  std::size_t steps(std::size_t curve) const { return steps_[curve]; }

  std::size_t steps_per_loop() const { return steps_per_loop_; }  // T/h
  double parameter_range() const { return parameter_range_; }     // T
  std::size_t choosing_steps() const { return choosing_steps_; }

  /// By how much halving every step would change the sums of one loop, summed without regard to sign.
  const Span& loop_error() const { return loop_error_; }

  /// The part of a curve's parameter that its step number `index` covers.
  Interval step(std::size_t curve, std::size_t index) const;

  Local at(std::size_t curve, double u) const;

  /// Both integrals over a part of one step.
  Span integrate(std::size_t curve, double from, double to) const;

 private:
  /// What a curve's sums come to in `count` steps, and how far to trust them.
  struct Trial {
    Span sum;    // of the length, and of the integral's absolute values
    Span error;  // against steps of half the size, likewise
  };
  Trial try_steps(std::size_t curve, std::size_t count);
  std::size_t choose_steps(std::size_t curve);

  Outline outline_;
  Density density_;
  std::vector<Interval> domains_;
  std::vector<std::size_t> steps_;
  std::size_t steps_per_loop_ = 0;
  double parameter_range_ = 0;
  std::size_t choosing_steps_ = 0;
  Span loop_error_;
};

}  // namespace rollfix::march
