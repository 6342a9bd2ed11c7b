#pragma once

#include <fast_float/fast_float.h>

#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "rollfix/units.hpp"

namespace rollfix {

/// Reads one number at `cursor` and moves it past the number; false (and the cursor stays) when there is none.
/// A leading plus is accepted; nan and inf are numbers here, for the caller to refuse.
inline bool scan_number(const char*& cursor, const char* end, double& value) {
  const char* digits = cursor;
  if (digits != end && *digits == '+') {
    ++digits;
    if (digits != end && *digits == '-') return false;
  }
  const auto result = fast_float::from_chars(digits, end, value);
  if (result.ec == std::errc::invalid_argument) return false;
  cursor = result.ptr;
  return true;
}

/// The whole text as a number, or nothing.
inline std::optional<double> parse_number(std::string_view text) {
  const char* cursor = text.data();
  const char* const end = text.data() + text.size();
  double value = 0;
  if (!scan_number(cursor, end, value) || cursor != end) return std::nullopt;
  return value;
}

/// An angle as a user writes it, in radians: "1.27" is radians, "73deg" degrees. Nothing when it is neither.
/// "nan" and "inf" are numbers here, for the caller to refuse.
std::optional<double> parse_angle(std::string_view text);

/// Takes the mark of degrees off an angle's end, "deg" or the degree sign, and blanks before it; whether there was one.
bool take_degrees(std::string_view& text);

/// The row with points for the decimal commas of its numbers, "0.5;1.25" of "0,5;1,25"; nothing where semicolons
/// separate no such number. Between them a comma can be nothing else.
std::optional<std::string> with_decimal_points(std::string_view row, std::optional<bool> decimal_comma = {});

/// "; numbers take a decimal point, as in 0.5, not a comma" of a number with a decimal comma, such as "0,5",
/// "-12,25deg" or "8,5mm": the end of a message that refuses it. Empty of all else.
std::string decimal_comma_hint(std::string_view text);

/// How far rounding can have moved a number that is written like this: half a unit of its last digit, so 0.005 for
/// "1.20", 5e-7 for "1.5e-6", in radians for "73.5deg". 0 for what is taken as exact: a whole number without decimals
/// ("3", "-20deg", "15e3") and zero ("0", "0.00").
double rounding_of(std::string_view number);

/// A finite length as written: bare, or with a unit as in 8mm. `what` begins an error. Throws InputError.
Length written_length(std::string_view text, const std::string& what);

/// A finite angle as written, in radians: bare radians, or degrees as in 73deg. Throws InputError.
double written_angle(std::string_view text, const std::string& what);

}  // namespace rollfix
