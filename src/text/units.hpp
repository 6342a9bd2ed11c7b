#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "rollfix/units.hpp"

namespace rollfix {

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

/// How lengths in the first of two named units become lengths in the second. Throws InputError, beginning with `what`,
/// where one of them is not known.
Conversion length_conversion(std::string_view from, std::string_view to, const std::string& what);

}  // namespace rollfix
