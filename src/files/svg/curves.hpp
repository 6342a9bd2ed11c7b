#pragma once

#include <cstddef>
#include <vector>

#include "files/svg/segment.hpp"
#include "files/svg/value.hpp"
#include "rollfix/outline/loops.hpp"

namespace rollfix::svg {

/// A subpath in the drawing's own frame, and where it comes from.
struct PlacedSubpath {
  Subpath path;
  Origin origin;
  std::size_t offset = 0;  // of its element in the file
};

struct Curves {
  std::vector<DrawnCurve> curves;
  std::size_t without_length = 0;  // segments that were left out
};

/// The subpaths as curves. What is shorter than 1e-9 of the drawing is left out, and what ends that close to the start
/// of a closed subpath ends there. Throws InputError with the place: coordinates too large to work with.
Curves to_curves(std::vector<PlacedSubpath> subpaths, const Text& file);

}  // namespace rollfix::svg
