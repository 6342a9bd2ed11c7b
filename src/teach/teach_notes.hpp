#pragma once

#include "teach/felt_roll.hpp"

namespace rollfix {

/// What was taught, for the user to read.
void add_notes(const FeltRoll& roll, Taught& taught);

}  // namespace rollfix
