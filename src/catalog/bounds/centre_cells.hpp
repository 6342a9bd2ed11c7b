#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "profile.hpp"
#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// The middle of each of 256 equal cells of a part's boundary, in its frame, in single precision.
struct CellPlaces {
  std::array<float, kFineCells> x;
  std::array<float, kFineCells> y;
};
CellPlaces places_of(const Part& part);

/// Where the centre of a round finger is while it touches a cell, and how the tangent points there.
struct CentreCell {
  Vec2 middle = Vec2::Zero();  // of a disc that holds the centres
  double radius = 0;
  double angle = 0;  // of the tangent, radians: at most half_turn from this
  double half_turn = 0;
};

/// Of each of 16 cells, of each of 64, and of each of 256, by the tangent's angles and the middles of cells. `radius`:
/// the finger's; 0: a point.
using CentreCells = std::array<std::vector<CentreCell>, 3>;
CentreCells centre_cells(const Profile<kFineCells>& profile, const CellPlaces& places, double perimeter, double radius);

}  // namespace rollfix
