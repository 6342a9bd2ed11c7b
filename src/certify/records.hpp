#pragma once

#include <vector>

#include "rollfix/outline/outline.hpp"

namespace rollfix {

/// The formulas of an outline's curves by name and numbers, those of the gallery included. Throws InputError: a curve
/// that has none.
std::vector<CurveRecord> formulas_of(const Outline& outline);

/// The formula's parameter where the curve's own is u.
double formula_parameter(const Curve& curve, double u);

}  // namespace rollfix
