#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/hold.hpp"

// A problem as all steps look at it: its logs by number, what of it is refused, and a part that lies face down as a
// mirror shows it.
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

/// The problem, and its aligned logs, as a mirror shows them: x has the other sign. A part that lies face down lies
/// face up there.
HoldProblem in_mirror(const HoldProblem& problem, std::vector<Log>& logs);
/// Its answer in the world as it is.
void out_of_mirror(HoldAnswer& answer);

/// Throws InputError unless the problem can be asked.
void require_valid(const HoldProblem& problem);

/// Throws InputError where angles may be wrapped or not. `logs`: of fingers and wheels, as they are measured.
void require_clear(const HoldProblem& problem, const std::vector<Log>& logs);

/// Wheels have x and y, and so do the fingers beside them: whether they are in one another does not depend on the part.
/// `logs`: aligned; of the fingers, then of the wheels. Throws InputError: in some row a finger and a wheel, or two
/// wheels, enter each other farther than they can be off.
void require_wheels_apart(const HoldProblem& problem, const std::vector<Log>& logs);

}  // namespace rollfix::hold
