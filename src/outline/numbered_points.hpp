#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// Points with the lines of the file that they came from.
struct NumberedPoints {
  std::vector<Vec2> points;
  std::vector<std::size_t> lines;
  bool has_title = false;
};

}  // namespace rollfix
