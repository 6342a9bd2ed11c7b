#pragma once

#include <vector>

#include "rollfix/touch/touch.hpp"

namespace rollfix::touch {

/// `solve` of a valid problem, without looking for mistakes.
TouchAnswer solve_plain(const TouchProblem& problem);

/// The usual mistakes, each tried: those without which the touches fit, the likeliest first.
std::vector<TouchDiagnosis> mistakes(const TouchProblem& problem, const TouchAnswer& answer);

}  // namespace rollfix::touch
