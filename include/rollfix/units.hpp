#pragma once

// Units as people write them.
//
//     parse_length("0.5 in")->value;                                  // 0.5
//     in_unit(*parse_length("0.5in"), "mm", "a radius");              // 12.7
//
// Degenerate cases: a length with a unit where the part's is not known is an InputError.

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rollfix {

/// What a unit is of.
enum class Dimension { angle, length, time };

/// A unit as people write it: behind a number, in a table's header, in a drawing.
struct Unit {
  std::string_view name;                   // as it is shown: "deg", "mm", "ms"
  Dimension dimension = Dimension::angle;  //
  double size = 1;                         // in radians, in 1e-10 m, in nanoseconds: whole where that can be
};

/// The unit that is called this: deg, degrees, rad, mm, millimetres, cm, m, in, inch, s, ms, us, ns, ... Nothing where
/// none is.
std::optional<Unit> unit_named(std::string_view name);

/// The names of a dimension's usual units, for messages: "mm, cm, m, in, ...".
std::string unit_names(Dimension dimension);

/// "an angle", "a length", "a time".
const char* name_of(Dimension dimension);

/// How a number in one unit becomes a number in another. Of two factors, so that 250 ms is 0.25 s to the bit.
struct Conversion {
  double times = 1;
  double over = 1;

  double operator()(double value) const { return value * times / over; }
  bool is_identity() const { return times == over; }
};

/// Both of the same dimension.
Conversion conversion(const Unit& from, const Unit& to);

/// To what numbers without a unit are in: radians, seconds.
Conversion conversion_to_plain(const Unit& from);

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

/// How lengths in the first of two named units become lengths in the second. Throws InputError, beginning with `what`,
/// where one of them is not known.
Conversion length_conversion(std::string_view from, std::string_view to, const std::string& what);

}  // namespace rollfix
