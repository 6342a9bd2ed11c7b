#pragma once

#include <vector>

#include "rollfix/hold.hpp"

namespace rollfix::hold {

/// Throws InputError unless the problem can be asked.
void require_valid(const HoldProblem& problem);

/// Throws InputError where angles may be wrapped or not. `logs`: of fingers and wheels, as they are measured.
void require_clear(const HoldProblem& problem, const std::vector<Log>& logs);

/// Wheels have x and y, and so do the fingers beside them: whether they are in one another does not depend on the part.
/// `logs`: aligned; of the fingers, then of the wheels. Throws InputError: in some row a finger and a wheel, or two
/// wheels, enter each other farther than they can be off.
void require_wheels_apart(const HoldProblem& problem, const std::vector<Log>& logs);

}  // namespace rollfix::hold
