#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/locate/march/path.hpp"

namespace rollfix::march {

/// The density's value at a point of a curve.
struct Sample {
  double u = 0;
  double density = 0;
};

/// The density along each curve, at a few points per step, both ends of the curve included.
struct Samples {
  std::vector<std::vector<Sample>> curves;
  double scale = 0;  // largest |g| over the outline
};

Samples sample(const Path& path);

}  // namespace rollfix::march
