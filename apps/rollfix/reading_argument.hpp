#pragma once

#include <string>

#include "rollfix/locate/reading.hpp"
#include "rollfix/tolerance.hpp"

namespace rollfix::app {

/// A reading as somebody typed it.
struct WrittenReading {
  Reading reading;
  Rounding rounding;
};

/// "LENGTH,TURN" as in 0.5,1.2 or 0.5,73deg. Trailing zeros are often left off, so both numbers are taken to be
/// rounded to the decimals of the one that has more. Throws InputError saying what was found.
WrittenReading read_reading(const std::string& text);

}  // namespace rollfix::app
