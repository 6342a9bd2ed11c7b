#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "profile.hpp"
#include "rollfix/curve.hpp"

namespace rollfix {

/// The middles of equal cells of a part's boundary, in its frame, in single precision.
template <std::size_t N>
struct Middles {
  std::array<float, N> x;
  std::array<float, N> y;
};
struct CellPlaces {
  Middles<kCoarseCells> coarse;
  Middles<kCells> cells;
  Middles<kFineCells> fine;
};
CellPlaces places_of(const Part& part);

/// Where the centre of a round finger is while it touches a cell, and how the tangent points there.
struct CentreCell {
  Vec2 middle = Vec2::Zero();  // of a disc that holds the centres
  double radius = 0;
  double angle = 0;  // of the tangent, radians: at most half_turn from this
  double half_turn = 0;
};

/// Of each of N cells, by the tangent's angles in it and its middle. `radius`: the finger's; 0: a point.
template <std::size_t N>
std::vector<CentreCell> centre_cells(const Profile<N>& profile, const Middles<N>& middles, double perimeter,
                                     double radius);
extern template std::vector<CentreCell> centre_cells(const Profile<kCoarseCells>&, const Middles<kCoarseCells>&, double,
                                                     double);
extern template std::vector<CentreCell> centre_cells(const Profile<kCells>&, const Middles<kCells>&, double, double);
extern template std::vector<CentreCell> centre_cells(const Profile<kFineCells>&, const Middles<kFineCells>&, double,
                                                     double);

}  // namespace rollfix
