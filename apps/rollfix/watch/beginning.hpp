#pragma once

#include <cstddef>
#include <string_view>

namespace rollfix::app {

/// What a line is that may be heard from its middle on, or before a device has found its rate.
struct FirstLine {
  enum class Kind { empty, garbage, numbers, words };  // words: a header
  Kind kind = Kind::empty;
  std::size_t cells = 0;  // of numbers
};

FirstLine first_line(std::string_view line);

/// Without the bytes in front of it that are no text.
std::string_view from_its_text(std::string_view line);

}  // namespace rollfix::app
