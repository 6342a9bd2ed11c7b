#pragma once

#include <string>
#include <vector>

#include "rollfix/outline/accuracy.hpp"
#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// The boundary as drawn: smooth curves, each starting where the one before ends.
/// A closed outline's last curve ends where the first begins. s = 0 is the start of the first curve.
struct Outline {
  std::string name;           // what the user called it: "gallery:ellipse", "wing.dat"
  std::vector<Curve> curves;  // each analytic on its domain; where two meet is a joint or a corner
  bool closed = true;         // false: an open curve with two ends
  bool reversed = false;      // true: the user gave it in the opposite direction
  bool hole = false;          // closed, and the material is outside: stored clockwise
  std::string gallery{};      // the gallery's specification that gives these curves again; empty: not from there
  std::string unit{};         // of its lengths: "mm", "in", ...; empty where nobody said
  double gap = 0;             // curves may start this far from where the one before ends: a drawing's rounded digits
  Accuracy accuracy{};        // of an outline that was measured, by a roll around it; else exact
};

/// The same boundary in the opposite direction with the same first point; `reversed` is toggled.
Outline reversed(const Outline& outline);

/// The same outline with all lengths so many times as long, in another unit.
Outline scaled(const Outline& outline, double factor, const std::string& unit);

/// What is wrong with an outline, in words that a user can act on; empty when nothing is.
///  * derivatives: each order against differences of the order below it, at `samples` points per curve
///  * closure: each curve starts where the one before ends
///  * regularity: the first derivative vanishes nowhere on the samples
/// For the author of a curve type of their own; the library's curves pass it in the tests.
std::vector<std::string> check(const Outline& outline, int samples = 64);

}  // namespace rollfix
