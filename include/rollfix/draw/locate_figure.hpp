#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/draw/svg.hpp"
#include "rollfix/locate/locate.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// What a figure of a one-finger search shows. Placement i is an arc beside the boundary from its start a_i to its
/// contact at the last reading, b_i (one reading), c_i (two) and so on; arcs that would overlap are stacked outward.
/// A translucent band is a placement's extent, where that is wide enough to see: every start in it fits.
struct LocateFigure {
  const Part* part = nullptr;  // not owned; required
  std::vector<Reading> readings;
  Search found;
  std::optional<double> finger_radius;   // of a disk, drawn at the start and the end of a placement
  std::optional<std::size_t> highlight;  // index into found.placements: drawn stronger, with the finger
  std::vector<std::size_t> numbers;      // of the placements, in labels and colours; empty: 0, 1, 2, ...
  std::string title;                     // empty: the part's name
  std::string verdict;                   // empty: the search's own
  double width = 640;                    // pixels
};

/// The paper's Figure 7 for any part. Labels up to 20 placements, a legend up to 12; beyond 120 only the starts.
/// Throws InputError: no part, or an index that is out of range.
Svg draw_placements(const LocateFigure& figure);

/// Several such figures in a row, to one scale when they are of the same part.
Svg side_by_side(const std::vector<LocateFigure>& figures);

/// For placements that are left after rolling on: which of the earlier ones each continues, by the nearest start.
/// Give it to the later figure as `numbers`, so that a placement keeps its label and its colour.
std::vector<std::size_t> numbers_of(const Search& later, const Search& earlier, const Part& part);

}  // namespace rollfix
