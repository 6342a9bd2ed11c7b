#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "rollfix/units.hpp"

namespace rollfix::app {

// Numbers on the command line. `what` begins an error: "--start 5x". All throw InputError.

/// A finite number.
double read_number(std::string_view text, const std::string& what);

/// A finite length, in the part's unit: bare, or with a unit as in 8mm, where the part's (empty: not known) is known.
double read_length(std::string_view text, const std::string& what, const std::string& part_unit);

/// The same as it was given, for the library to convert.
Length read_given_length(std::string_view text, const std::string& what);

/// A finite angle in radians: bare radians, or degrees as in 73deg.
double read_angle(std::string_view text, const std::string& what);

/// A whole number of at least `least`.
std::size_t read_count(std::string_view text, const std::string& what, std::size_t least);

}  // namespace rollfix::app
