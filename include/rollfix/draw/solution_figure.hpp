#pragma once

#include <string>
#include <vector>

#include "rollfix/draw/svg.hpp"
#include "rollfix/outline/outline.hpp"
#include "rollfix/question/question.hpp"

namespace rollfix {

/// The figure of a solution of whichever kind: see AnswerFigure, TouchFigure, HoldFigure.
struct SolutionFigure {
  const Question* question = nullptr;  // not owned; required: of one roll its log is drawn
  const Solution* solution = nullptr;  // to it; not owned; required
  std::vector<Outline> others{};       // of a drawing: its other loops, drawn thin
  std::string title{};                 // empty: the part's name
};

/// Throws InputError as the figure of its kind does.
Svg draw_solution(const SolutionFigure& figure);

}  // namespace rollfix
