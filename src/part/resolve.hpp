#pragma once

#include <functional>

#include "chebyshev.hpp"
#include "rollfix/curve.hpp"

namespace rollfix {

/// A stretch of one curve, short enough that arc length and curvature are polynomials on it.
/// All series are by powers of x in [-1, 1], which is arc length: s = length * (1 + x) / 2 from the panel's start.
struct ResolvedPanel {
  double length = 0;
  chebyshev::Series curvature;  // kappa(x)
  chebyshev::Series turn;       // the tangent's turn since the panel's start, radians
  chebyshev::Series parameter;  // the curve's own parameter u(x)
  Vec2 tangent_at_start;        // not normalized
  Vec2 tangent_at_end;
};

/// Cuts a curve into panels, in order. `size` is the outline's length or so: errors far below it don't count.
/// `spent`: attempts so far, of all curves of the outline. Throws InputError where the curve has no tangent (a cusp),
/// or too many attempts were made, with the place.
void resolve(const Curve& curve, double size, std::size_t& spent,
             const std::function<void(const ResolvedPanel&)>& sink);

}  // namespace rollfix
