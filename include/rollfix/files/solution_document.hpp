#pragma once

#include <string>

#include "rollfix/files/documents.hpp"
#include "rollfix/question/solution.hpp"

namespace rollfix {

/// "rollfix/locate/1" of whichever kind: docs/json.md lists its fields. `explain`: of one roll, with what the fingers
/// can't do.
std::string format_solution(const Solution& solution, Layout layout = Layout::lines, bool explain = false);

}  // namespace rollfix
