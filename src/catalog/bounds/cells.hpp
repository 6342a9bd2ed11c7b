#pragma once

#include <bitset>
#include <cstddef>

#include "clue.hpp"
#include "profile.hpp"

namespace rollfix {

/// Some of N equal cells of the boundary.
template <std::size_t N>
using Cells = std::bitset<N>;

/// What bounds need to know of a part besides its profile.
struct Course {
  float perimeter = 0;
  float period_turn = 0;
  float most_curvature = 0;
  bool closed = true;
};

/// The cells in which the roll can have started, of those within these larger ones. None is left out in which all the
/// readings fit within their slack, with one tangent at the start. Of two fingers: in which finger a can have.
template <std::size_t N>
Cells<N> cells_left(const Profile<N>& profile, const Course& course, const Clues& clues, const Cells<N / 4>& within);

extern template Cells<kCoarseCells> cells_left(const Profile<kCoarseCells>&, const Course&, const Clues&,
                                               const Cells<kCoarseCells / 4>&);
extern template Cells<kCells> cells_left(const Profile<kCells>&, const Course&, const Clues&,
                                         const Cells<kCoarseCells>&);
extern template Cells<kFineCells> cells_left(const Profile<kFineCells>&, const Course&, const Clues&,
                                             const Cells<kCells>&);

}  // namespace rollfix
