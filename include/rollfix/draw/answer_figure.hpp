#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/answer/answer.hpp"
#include "rollfix/draw/svg.hpp"

namespace rollfix {

/// What a figure of an answer shows.
///
/// Of one finger, the paper's Figure 7 for any part: placement i is an arc beside the boundary from its start a_i to
/// its contact at the last reading, b_i (one reading), c_i (two) and so on; arcs that would overlap are stacked
/// outward. A translucent band is a placement's extent, where that is wide enough to see: every start in it fits.
/// Labels up to 20 placements, a legend up to 12; beyond 120 only the starts.
///
/// With noise the extents make way for what is probable: areas outside of the boundary are as high as the first contact
/// is dense there, bands hold 95 % of each placement, and the legend has the probabilities. Below lie the density over
/// s, and up to four narrow placements of it enlarged.
///
/// With `log`, where it tells of the fingers' places, the part and the fingers as they were in the world; with noise
/// also the ellipse and the fan that hold 95 % of the part's place and heading, and its outline at the ends of its
/// pose's spread. What would be too small to see is drawn larger, and the figure says how many times.
///
/// Of two fingers, Figure 8: at the left the part with one placement's rolls as arcs beside the boundary, finger a's
/// from s_0 over s_1 to s_2 and finger b's from t_0 over t_1 to t_2, and the first contacts of the other placements as
/// numbered dots. At the right all pairs (s, t) as a square: a line for each equation, f_k(s, t) = 0, and the
/// placements, by the same numbers, where the lines meet. A stretch is a broad line there. Numbers up to 20 placements.
/// With noise an ellipse holds 95 % of each pair; the likeliest are enlarged below, with the ellipse that holds a half,
/// and what each finger has by itself at the sides.
///
/// What is left out where there is too much of it, the figure says.
struct AnswerFigure {
  const Answer* answer = nullptr;          // not owned; required
  std::optional<std::size_t> highlight{};  // of one finger the placement drawn stronger, with the finger; of two the
                                           // one whose rolls are drawn, none: the first
  std::vector<std::size_t> numbers{};      // of the placements, in labels and colours; empty: 0, 1, 2, ...
  std::string title{};                     // empty: the part's name
  double width = 0;                        // pixels; 0: 640 of one finger, 960 of two or with the world
  const Log* log = nullptr;                // of the roll, not owned: draws the part and the fingers in the world
  std::vector<Outline> others{};           // of a drawing: its other loops, drawn thin
};

/// Throws InputError: no answer, or an index that is out of range.
Svg draw_answer(const AnswerFigure& figure);
inline Svg draw_answer(const Answer& answer) { return draw_answer(AnswerFigure{&answer}); }

/// Several figures of one finger in a row, to one scale when they are of the same part.
Svg side_by_side(const std::vector<AnswerFigure>& figures);

/// For placements that are left after rolling on: which of the earlier ones each continues, by the nearest start.
/// Give it to the later figure as `numbers`, so that a placement keeps its label and its colour.
std::vector<std::size_t> numbers_of(const Answer& later, const Answer& earlier);

}  // namespace rollfix
