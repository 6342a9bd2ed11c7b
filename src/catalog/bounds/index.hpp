#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "cells.hpp"
#include "centre_cells.hpp"
#include "profile.hpp"
#include "rollfix/identify.hpp"

namespace rollfix {

/// What all parts of a catalog are asked first, side by side in memory: 660 bytes a part, and its name.
struct Catalog::Index {
  std::vector<Course> courses;
  std::vector<Profile<kCoarseCells>> coarse;
  std::vector<Profile<kCells>> cells;
  std::vector<std::uint8_t> measured;  // its outline is not exact: bounds on it say nothing certain
  /// Read from the file.
  std::function<std::vector<Profile<kFineCells>>(const std::vector<std::size_t>& parts)> fine;
  /// Of touches: of the part itself, when it is first asked for.
  std::function<CellPlaces(std::size_t part)> places;
};

}  // namespace rollfix
