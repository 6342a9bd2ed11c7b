#pragma once

#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// Throws InputError as `solve` says.
void require_valid(const TouchProblem& problem);

/// The finger's; 0 of a point. REQUIRES a valid problem.
double radius_of(const TouchProblem& problem);

}  // namespace rollfix::touch
