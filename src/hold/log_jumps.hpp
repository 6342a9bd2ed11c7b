#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rollfix/hold.hpp"

namespace rollfix::hold {

/// These rows of a log of one finger, in order.
Log with_rows(const Log& log, const std::vector<std::size_t>& rows);

/// Leaves rows out of all logs in which a finger jumps farther than is physical, and comes back. Which they were, as in
/// "b.csv, line 17". `logs`: aligned.
std::vector<std::string> leave_out_jumps(const HoldProblem& problem, std::vector<Log>& logs);

}  // namespace rollfix::hold
