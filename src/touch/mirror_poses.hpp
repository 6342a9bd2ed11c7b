#pragma once

#include "rollfix/touch.hpp"

// A part that lies face down: seen in the mirror x = -x it does not.
namespace rollfix::touch {

TouchProblem in_mirror(const TouchProblem& problem);
/// Its first contact; readings are along the outline as it is.
RollSearched in_mirror(RollSearched roll);

/// Back into the world: poses, and what rolls say.
void out_of_mirror(TouchAnswer& answer);

}  // namespace rollfix::touch
