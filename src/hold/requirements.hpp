#pragma once

#include "rollfix/hold/hold.hpp"

namespace rollfix::hold {

/// Throws InputError unless the problem can be asked.
void require_valid(const HoldProblem& problem);

}  // namespace rollfix::hold
