#pragma once

#include <optional>
#include <string_view>

namespace rollfix {

/// An angle as a user writes it, in radians: "1.27" is radians, "73deg" degrees. Nothing when it is neither.
/// "nan" and "inf" are numbers here, for the caller to refuse.
std::optional<double> parse_angle(std::string_view text);

/// How far rounding can have moved a number that is written like this: half a unit of its last digit, so 0.005 for
/// "1.20", 5e-7 for "1.5e-6", in radians for "73.5deg". 0 for what is taken as exact: a whole number without decimals
/// ("3", "-20deg", "15e3") and zero ("0", "0.00").
double rounding_of(std::string_view number);

}  // namespace rollfix
