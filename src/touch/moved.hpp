#pragma once

#include <vector>

#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// Whether the part was moved between two rolls: those before fit together, those after do, and not all of them.
/// REQUIRES a problem with rolls, and its answer.
std::vector<TouchDiagnosis> moved(const TouchProblem& problem, const TouchAnswer& answer);

}  // namespace rollfix::touch
