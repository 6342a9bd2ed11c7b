#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "rollfix/outline/curve.hpp"

namespace rollfix::march {

/// A point of an outline, as its curves are parametrized.
struct Site {
  std::size_t curve = 0;  // index into Outline::curves
  double u = 0;           // that curve's own parameter
  const Jet& jet;         // position and derivatives there
};

/// What is integrated along the boundary: a function of the place, per unit of arc length. Analytic on each curve of
/// the outline; it may jump where two curves meet.
using DensityFunction = std::function<double(const Site&)>;

/// A density g together with what its zeros are called. The march knows nothing else of the problem: it looks for the
/// segments of length L over which the integral of g equals C.
///
///   problem                          g        C       sign changes of g
///   section 2, eqs. (4) and (5)      kappa    theta   inflections
///   stationary points of phi, eq. (6) kappa'  0       vertices
///   section 5                        f        C       sign changes of f
struct Density {
  enum class Kind { curvature, curvature_rate, other };

  Kind kind = Kind::other;
  std::string name;       // for messages: "the curvature"
  std::string zero_name;  // for messages: "inflection"
  DensityFunction per_length;
};

/// kappa: its integral over [s, t] is the total curvature Phi(s, t).
Density curvature_density();

/// kappa' = d kappa / ds: its integral over [s, t] is kappa(t) - kappa(s).
Density curvature_rate_density();

/// Any f of section 5. `f` is per unit of arc length: to integrate by a curve's own parameter, divide by the speed.
Density density(DensityFunction f, std::string name = "f");

}  // namespace rollfix::march
