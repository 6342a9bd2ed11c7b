#pragma once

#include <optional>

#include "files/svg/context.hpp"

namespace rollfix::svg {

/// A number with a unit.
struct Length {
  double number = 0;
  std::string_view unit;  // "", "px", "mm", "%", ...

  /// In a unit of the world: millimetres, not pixels.
  bool is_physical() const;
  /// In user units of 1/96 inch; `whole` is what 100% is. Nothing for a unit that depends on a font or a window.
  std::optional<double> in_user_units(double whole) const;
};

/// Nothing for "auto". Throws InputError with the place: not a number with or without a unit.
std::optional<Length> parse_length(const Value& value);

/// Millimetres in a user unit.
inline constexpr double kUserUnit = 25.4 / 96;

}  // namespace rollfix::svg
