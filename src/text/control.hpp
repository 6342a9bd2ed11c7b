#pragma once

#include <string_view>

namespace rollfix {

/// Whether a character of UTF-8 does something to a terminal: C0, DEL, C1, line ends, and marks of direction.
bool is_control(std::string_view character);

}  // namespace rollfix
