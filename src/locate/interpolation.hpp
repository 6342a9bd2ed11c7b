#pragma once

#include <cmath>

#include "root_search.hpp"

// Polynomials through samples of f, with their slopes.
namespace rollfix {

/// Where the cubic through two samples has the value `level`: from where their chord has it, by Newton's method.
inline double cubic_root(const ResidualSample& one, const ResidualSample& other, double level) {
  // So many steps leave less of the cubic's root than the cubic is off by.
  constexpr int kSteps = 2;
  const double width = other.s - one.s;
  const double rise = other.value - one.value;
  const double linear = one.slope() * width;
  const double square = 3 * rise - 2 * linear - other.slope() * width;
  const double cube = rise - linear - square;
  double x = (level - one.value) / rise;
  for (int step = 0; step < kSteps; ++step) {
    x -= (one.value - level + x * (linear + x * (square + x * cube))) / (linear + x * (2 * square + x * 3 * cube));
  }
  return one.s + x * width;
}

/// Where the polynomial through three samples has a value.
struct QuinticRoot {
  double step = 0;  // from the first sample
  double rest = 0;  // what f is there at the most, about: as if by the cubic through the first two
};

/// Divided differences of three samples, each taken twice. What needs no value of the first is there before it is.
class Quintic {
 public:
  /// `at` is the place of the first, where f is still to be evaluated.
  Quintic(double at, const ResidualSample& last, const ResidualSample& third)
      : last_(last), to_last_(last.s - at), to_third_(third.s - at) {
    per_last_ = 1 / to_last_;
    per_third_ = 1 / to_third_;
    const double per_both = 1 / (third.s - last.s);
    const double secant = (third.value - last.value) * per_both;
    last_last_third_ = (secant - last.slope()) * per_both;
    const double last_third_third = (third.slope() - secant) * per_both;
    both_twice_ = (last_third_third - last_last_third_) * per_both;
  }

  /// Where it has the value `level`: one step of Halley's method, one of Newton's.
  QuinticRoot root(const ResidualSample& at, double level) const {
    const double value = at.value - level;
    const double slope = at.slope();
    const double secant = (last_.value - at.value) * per_last_;
    const double c2 = (secant - slope) * per_last_;  // of steps twice from the first, ...
    const double first_last_last = (last_.slope() - secant) * per_last_;
    const double c3 = (first_last_last - c2) * per_last_;  // ... then twice from the last, ...
    const double first_last_last_third = (last_last_third_ - first_last_last) * per_third_;
    const double c4 = (first_last_last_third - c3) * per_third_;
    const double c5 =
        ((both_twice_ - first_last_last_third) * per_third_ - c4) * per_third_;  // ... then from the third
    const double near = -value * slope / (slope * slope - value * c2);
    const double bend = c2 + (near - to_last_) * (c3 + (near - to_last_) * (c4 + (near - to_third_) * c5));
    const double step = near - (value + near * (slope + near * bend)) / (slope + 2 * near * bend);
    const double product = step * (step - to_last_);
    const double of_cubic = product * product * (std::abs(c4) + std::abs((step - to_third_) * c5));
    const double of_newton = std::abs(bend) * (step - near) * (step - near);
    return {step, of_cubic + of_newton};
  }

 private:
  ResidualSample last_;
  double to_last_;
  double to_third_;
  double per_last_ = 0;
  double per_third_ = 0;
  double last_last_third_ = 0;
  double both_twice_ = 0;
};

/// A sample close to another: its curvatures by those of a third one as well, its value by the slopes at both.
inline ResidualSample beside(const ResidualSample& at, const ResidualSample& third, double s) {
  const double share = third.s == at.s ? 0 : (s - at.s) / (third.s - at.s);
  ResidualSample sample{s, at.value, at.start_curvature + share * (third.start_curvature - at.start_curvature),
                        at.end_curvature + share * (third.end_curvature - at.end_curvature)};
  sample.value += 0.5 * (at.slope() + sample.slope()) * (s - at.s);
  return sample;
}

}  // namespace rollfix
