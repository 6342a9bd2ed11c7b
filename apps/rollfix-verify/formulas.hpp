#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ball.hpp"

namespace rollfix_verify {

/// Two coordinates, as numbers or as series.
template <class Number>
struct Pair {
  Number x;
  Number y;
};
using Point = Pair<Ball>;

/// The highest power of a Motion's integrals that is right: two derivatives lose two terms.
inline constexpr slong kOrder = kTerms - 2;

/// How a curve runs on from a parameter u, by x = its parameter - u: ds/dx and d(tangent's angle)/dx. Where u is a wide
/// ball each coefficient holds those of all parameters in it.
struct Motion {
  Series speed;
  Series turning;
};

/// A curve by its own formula.
struct Formula {
  double lo = 0;  // its parameter runs from here to there
  double hi = 1;
  double work = 1;  // of an expansion, about as many as of an ellipse's
  std::function<Motion(const Ball&)> motion;
  std::function<Point(const Ball&)> position;
  std::function<Point(const Ball&)> velocity;  // or, where it is at rest, a direction: only that is asked for
};

/// The curve of this kind with these numbers: docs/certificates.md lists the kinds. Throws std::runtime_error.
Formula formula_of(const std::string& kind, const std::vector<double>& numbers);

}  // namespace rollfix_verify
