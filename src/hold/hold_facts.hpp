#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/hold.hpp"

namespace rollfix::hold {

/// The finger of a log: one may hold for all.
const Finger& finger_of_log(const HoldProblem& problem, std::size_t log);

/// The same of fingers and wheels. What a wheel's log is mirrored and measured as: a disk.
Finger shape_of(const HoldProblem& problem, std::size_t number);

/// The logs of the fingers, then of the wheels.
std::size_t count_of_logs(const HoldProblem& problem);
const Log& log_of(const HoldProblem& problem, std::size_t number);
Log& log_of(HoldProblem& problem, std::size_t number);

/// What an answer says of a log, but for how far its contact travelled.
HoldRoll roll_of(const HoldProblem& problem, const Log& log, std::size_t number);

/// The problem, and its aligned logs, as a mirror shows them: x has the other sign.
HoldProblem in_mirror(const HoldProblem& problem, std::vector<Log>& logs);
/// Its answer in the world as it is.
void out_of_mirror(HoldAnswer& answer);

}  // namespace rollfix::hold
