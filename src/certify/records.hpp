#pragma once

#include <vector>

#include "rollfix/outline.hpp"

namespace rollfix {

/// The formulas of an outline's curves by name and numbers, those of the gallery included. Throws InputError: a curve
/// that has none.
std::vector<CurveRecord> formulas_of(const Outline& outline);

}  // namespace rollfix
