#pragma once

#include <vector>

#include "rollfix/hold.hpp"

namespace rollfix::hold {

/// Throws InputError unless the problem can be asked.
void require_valid(const HoldProblem& problem);

/// Throws InputError where angles may be wrapped or not. `logs`: of fingers and wheels, as they are measured.
void require_clear(const HoldProblem& problem, const std::vector<Log>& logs);

}  // namespace rollfix::hold
