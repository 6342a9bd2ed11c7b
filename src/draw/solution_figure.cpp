#include "rollfix/draw.hpp"

#include <optional>

namespace rollfix {
namespace {

/// With the roll in the world, without its stray rows; a part face down is not drawn there.
Svg draw_roll(const SolutionFigure& asked, const Answer& answer) {
  AnswerFigure figure{&answer};
  figure.others = asked.others;
  figure.title = asked.title;
  const Problem problem = roll_problem(*asked.question);
  std::optional<Log> log = problem.felt.log;
  if (!answer.strays.empty()) log = without_strays(*log, problem.part, problem.fingers, *problem.noise);
  if (log && !answer.mirrored) figure.log = &*log;
  return draw_answer(figure);
}

}  // namespace

Svg draw_solution(const SolutionFigure& figure) {
  const Solution& solution = *figure.solution;
  if (const TouchAnswer* const answer = solution.at_rest()) {
    TouchFigure of_touches{answer};
    of_touches.others = figure.others;
    of_touches.title = figure.title;
    return draw_touches(of_touches);
  }
  if (const HoldAnswer* const answer = solution.moving()) {
    HoldFigure of_hold{answer};
    of_hold.others = figure.others;
    of_hold.title = figure.title;
    return draw_hold(of_hold);
  }
  return draw_roll(figure, *solution.roll());
}

}  // namespace rollfix
