#include "rollfix/draw/answer_figure.hpp"

#include <fmt/format.h>

#include "answer_figure.hpp"
#include "arcs_plan.hpp"
#include "pair_plan.hpp"
#include "rollfix/error.hpp"

namespace rollfix {
namespace draw {

double width_of(const AnswerFigure& figure) {
  if (figure.width > 0) return figure.width;
  return figure.answer->finger_count() == 1 ? 640 : 960;
}

std::optional<double> radius_of(const AnswerFigure& figure, std::size_t finger) {
  const std::vector<Finger>& fingers = figure.answer->fingers;
  if (fingers.empty()) return std::nullopt;
  const Finger& own = finger == 0 ? fingers.front() : fingers.back();
  return own.is_disk() ? std::optional(own.disk()->radius) : std::nullopt;
}

void require_valid(const AnswerFigure& figure) {
  if (figure.answer == nullptr) throw InputError("a figure needs an answer, found none: set AnswerFigure::answer");
  const std::size_t count = figure.answer->placements.size();
  if (figure.highlight && *figure.highlight >= count) {
    throw InputError(fmt::format("a figure's highlight must be the index of one of its {} placements, found {}", count,
                                 *figure.highlight));
  }
  if (!figure.numbers.empty() && figure.numbers.size() != count) {
    throw InputError(
        fmt::format("a figure needs a number for each of its {} placements, found {}", count, figure.numbers.size()));
  }
}

}  // namespace draw

Svg draw_answer(const AnswerFigure& figure) {
  draw::require_valid(figure);
  return figure.answer->finger_count() == 1 ? draw::draw_arcs(figure) : draw::draw_pairs(figure);
}

}  // namespace rollfix
