#pragma once

#include <vector>

#include "outline/shapes/parameters.hpp"
#include "rollfix/outline/curve.hpp"

/// The gallery's shapes, each from its checked parameters.
namespace rollfix::shapes {

using Curves = std::vector<Curve>;

// round.cpp
Curves circle(const Parameters& parameters);
Curves ellipse(const Parameters& parameters);
Curves superellipse(const Parameters& parameters);

// polar.cpp
Curves limacon(const Parameters& parameters);
Curves cam(const Parameters& parameters);
Curves gear(const Parameters& parameters);

// naca.cpp
Curves naca(const Parameters& parameters);

// drafted.cpp: lines and arcs, and a spline
Curves reuleaux(const Parameters& parameters);
Curves stadium(const Parameters& parameters);
Curves rounded_rectangle(const Parameters& parameters);
Curves polygon(const Parameters& parameters);
Curves spline(const Parameters& parameters);

// open.cpp
Curves log_spiral(const Parameters& parameters);
Curves exponential(const Parameters& parameters);

}  // namespace rollfix::shapes
