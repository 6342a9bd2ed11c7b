#pragma once

#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix::draw {

/// A function of one variable at increasing places.
struct Samples {
  std::vector<double> at;
  std::vector<double> value;
};

/// The lines on which g(x) - h(y) = level, as polylines in (x, y); closed ones end where they begin. Marching squares
/// on the grid of the places: what is smaller than its cells is lost. Differences below 1e-12 are zero.
std::vector<std::vector<Vec2>> level_lines(const Samples& g, const Samples& h, double level);

}  // namespace rollfix::draw
