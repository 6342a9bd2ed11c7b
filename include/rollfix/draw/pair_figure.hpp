#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/draw/svg.hpp"
#include "rollfix/locate/locate_pair.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// What a figure of a two-finger search shows. At the left the part with one placement's rolls as arcs beside the
/// boundary, finger a's from s_0 over s_1 to s_2 and finger b's from t_0 over t_1 to t_2, and the first contacts of the
/// other placements as numbered dots. At the right all pairs (s, t) as a square: a line for each equation, f_k(s, t) =
/// 0, and the placements, by the same numbers, where the lines meet. A stretch is a broad line there.
struct PairFigure {
  const Part* part = nullptr;  // not owned; required
  std::vector<PairReading> readings;
  PairSearch found;
  std::optional<double> facing;                        // as in PairOptions: another line
  std::array<std::optional<double>, 2> finger_radius;  // of disks, drawn at the ends of the rolls
  std::optional<std::size_t> highlight;                // whose rolls are drawn; none: those of the first placement
  std::string title;                                   // empty: the part's name
  std::string verdict;                                 // empty: the search's own
  double width = 960;                                  // pixels
};

/// The paper's Figure 8 for any part. Numbers up to 20 placements.
/// Throws InputError: no part, or a highlight that is out of range.
Svg draw_pairs(const PairFigure& figure);

}  // namespace rollfix
