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
/// Of two fingers, Figure 8: at the left the part with one placement's rolls as arcs beside the boundary, finger a's
/// from s_0 over s_1 to s_2 and finger b's from t_0 over t_1 to t_2, and the first contacts of the other placements as
/// numbered dots. At the right all pairs (s, t) as a square: a line for each equation, f_k(s, t) = 0, and the
/// placements, by the same numbers, where the lines meet. A stretch is a broad line there. Numbers up to 20 placements.
struct AnswerFigure {
  const Answer* answer = nullptr;          // not owned; required
  std::optional<std::size_t> highlight{};  // of one finger the placement drawn stronger, with the finger; of two the
                                           // one whose rolls are drawn, none: the first
  std::vector<std::size_t> numbers{};      // of the placements, in labels and colours; empty: 0, 1, 2, ...
  std::string title{};                     // empty: the part's name
  double width = 0;                        // pixels; 0: 640 of one finger, 960 of two
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
