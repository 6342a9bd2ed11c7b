#pragma once

#include <string_view>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/log.hpp"

namespace rollfix {

/// How the log's columns are to be read where that is the mistake: those that change, and those that are not found by
/// their own names. None where no column changes, or no header is known.
std::vector<ColumnSource> columns_without(Cause cause, const Log& log);

/// Whether it was said of a finger's column, "u", "psi", "turn" or "dturn", that it is in degrees.
bool says_degrees(const std::vector<FingerRows>& fingers, std::string_view column);

}  // namespace rollfix
