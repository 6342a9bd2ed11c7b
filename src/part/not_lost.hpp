#pragma once

#include <string>

#include "rollfix/part.hpp"

namespace rollfix {

/// Throws InputError for a length below what arc lengths on the part are accurate to. `what` was expected, such as "a
/// disk with a radius"; `cure` ends the message.
void require_not_lost(const Part& part, double length, const std::string& what, const std::string& cure);

}  // namespace rollfix
