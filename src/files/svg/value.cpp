#include "files/svg/value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "rollfix/error.hpp"

namespace rollfix::svg {

Text::Text(std::string_view text, std::string name) : name_(std::move(name)), size_(text.size()) {
  for (std::size_t k = text.find('\n'); k != std::string_view::npos; k = text.find('\n', k + 1)) newlines_.push_back(k);
}

std::size_t Text::line_at(std::size_t offset) const {
  const auto before = std::lower_bound(newlines_.begin(), newlines_.end(), std::min(offset, size_));
  return static_cast<std::size_t>(before - newlines_.begin()) + 1;
}

void Text::refuse(std::size_t offset, const std::string& message) const {
  throw InputError(fmt::format("{}:{}: {}", name_, line_at(offset), message));
}

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
