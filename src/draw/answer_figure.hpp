#pragma once

#include <cstddef>
#include <optional>

#include "rollfix/draw/answer_figure.hpp"

namespace rollfix::draw {

/// Throws InputError: no answer, or an index that is out of range.
void require_valid(const AnswerFigure& figure);

/// In pixels, as given or by the number of fingers.
double width_of(const AnswerFigure& figure);

/// Of a finger that is a disk and known.
std::optional<double> radius_of(const AnswerFigure& figure, std::size_t finger);

}  // namespace rollfix::draw
