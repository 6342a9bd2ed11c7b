#pragma once

#include <string>
#include <vector>

#include "rollfix/locate/pair_reading.hpp"
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

/// The same of two fingers. The rounding's length is of both lengths together.
struct WrittenPairReading {
  PairReading reading;
  Rounding rounding;
};

/// "LENGTH_A,LENGTH_B,TURN" as in 0.5,-0.3,73deg. Throws InputError saying what was found.
WrittenPairReading read_pair_reading(const std::string& text);

/// An angle as typed for an option, with the rounding of its digits.
struct WrittenAngle {
  double angle = 0;     // radians
  double rounding = 0;  // radians
};
WrittenAngle read_written_angle(const std::string& text, const std::string& option);

/// Have all readings three numbers? Throws InputError when only some have.
bool are_of_two_fingers(const std::vector<std::string>& texts);

}  // namespace rollfix::app
