#include "files/svg/length.hpp"

#include <array>
#include <string>
#include <utility>

#include "files/svg/scanner.hpp"

namespace rollfix::svg {

namespace {

/// User units, of 1/96 inch each, in the units of the world.
constexpr std::array<std::pair<std::string_view, double>, 6> kPhysical = {
    {{"mm", 96 / 25.4}, {"cm", 960 / 25.4}, {"in", 96}, {"pt", 96.0 / 72}, {"pc", 16}, {"Q", 24 / 25.4}}};

}  // namespace

bool Length::is_physical() const {
  for (const auto& [name, size] : kPhysical) {
    if (unit == name) return true;
  }
  return false;
}

std::optional<double> Length::in_user_units(double whole) const {
  if (unit.empty() || unit == "px") return number;
  if (unit == "%") return number / 100 * whole;
  for (const auto& [name, size] : kPhysical) {
    if (unit == name) return number * size;
  }
  return std::nullopt;
}

std::optional<Length> parse_length(const Value& value) {
  if (value.text == "auto") return std::nullopt;
  Scanner scan(value);
  scan.skip_spaces();
  Length length;
  length.number = scan.number("a length such as 12 or 12mm");
  const char* const unit = scan.cursor();
  if (!scan.at_end() && scan.peek() == '%') {
    scan.advance();
  } else {
    scan.word();
  }
  length.unit = {unit, static_cast<std::size_t>(scan.cursor() - unit)};
  scan.skip_spaces();
  if (!scan.at_end()) scan.refuse("expected a length such as 12 or 12mm");
  return length;
}

}  // namespace rollfix::svg
