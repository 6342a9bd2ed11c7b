#pragma once

// Lengths with units, as people write them.
//
//     parse_length("0.5 in")->value;                                  // 0.5
//     in_unit(*parse_length("0.5in"), "mm", "a radius");              // 12.7
//
// Degenerate cases: a length with a unit where the part's is not known is an InputError.

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace rollfix {

/// What a unit is of.
enum class Dimension { angle, length, time };

/// A length as it was given: in the part's own unit, or in one that is named.
struct Length {
  double value = 0;
  std::string unit{};  // empty: the part's

  Length() = default;
  Length(double own) : value(own) {}  // NOLINT(google-explicit-constructor): a number is a length
  Length(double number, std::string in) : value(number), unit(std::move(in)) {}
};

/// "8mm", "0.3 in", "1.5": a number, and a unit of length behind it or none. Nothing where it is neither.
std::optional<Length> parse_length(std::string_view text);

/// The length in a part's unit, which is empty where it is not known. `what` begins an error. Throws InputError: a unit
/// that is not one of length, or the part's is not known, or is none that can be converted ("px").
double in_unit(const Length& length, std::string_view part_unit, const std::string& what);

}  // namespace rollfix
