#pragma once

#include <string>

namespace rollfix::app {

/// A points file of an airfoil section as a designer would hand it over: NACA 2412, chord 200, computed by the
/// gallery, from the trailing edge over the top, with four decimals.
std::string wing_points();

/// A DXF drawing of a plate, 70 x 40 mm, three of its corners rounded, with a round hole.
std::string plate_drawing();

}  // namespace rollfix::app
