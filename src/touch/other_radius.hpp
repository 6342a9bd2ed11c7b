#pragma once

#include <vector>

#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// Radii of the finger with which touches fit that do not fit with the stated one, or with none stated. It is one
/// unknown more, so the touches have to say more than the pose takes. REQUIRES noise.
std::vector<TouchDiagnosis> other_radii(const TouchProblem& problem);

}  // namespace rollfix::touch
