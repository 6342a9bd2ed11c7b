#pragma once

#include <vector>

#include "rollfix/locate_outcome.hpp"
#include "rollfix/locate_request.hpp"

namespace rollfix::app {

/// All that is found of one finger; notes go to the report. Throws InputError.
LocateOutcome solve_one(const LocateArguments& arguments, const std::vector<Log>& logs, Report& report);

}  // namespace rollfix::app
