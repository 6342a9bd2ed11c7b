#pragma once

#include <vector>

#include "measured.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// An explanation fits where chi-square is no less likely than this.
inline constexpr double kExplains = 0.01;

/// `solve` of a valid problem, without looking for mistakes.
TouchAnswer solve_plain(const TouchProblem& problem);

/// The usual mistakes, each tried: those without which the touches fit, the likeliest first.
std::vector<TouchDiagnosis> mistakes(const TouchProblem& problem);

}  // namespace rollfix::touch
