#include "rollfix/arguments/typed_number.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix::app {
double read_number(std::string_view text, const std::string& what) {
  const std::string_view shown = trimmed(text);
  std::string_view digits = shown;
  if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = fast_float::from_chars(digits.data(), end, value);
  if (error != std::errc() || stop != end) {
    throw InputError(fmt::format("{}: '{}' is not a number{}", what, shown, decimal_comma_hint(shown)));
  }
  if (!std::isfinite(value)) throw InputError(fmt::format("{}: '{}' is not a finite number", what, shown));
  return value;
}

Length read_given_length(std::string_view text, const std::string& what) {
  const std::string_view shown = trimmed(text);
  const std::optional<Length> length = parse_length(shown);
  if (!length) {
    throw InputError(fmt::format("{}: '{}' is not a number, nor one with a unit of length as in 8mm ({}){}", what,
                                 shown, unit_names(Dimension::length), decimal_comma_hint(shown)));
  }
  if (!std::isfinite(length->value)) throw InputError(fmt::format("{}: '{}' is not a finite number", what, shown));
  return *length;
}

double read_length(std::string_view text, const std::string& what, const std::string& part_unit) {
  return in_unit(read_given_length(text, what), part_unit, what);
}

double read_angle(std::string_view text, const std::string& what) {
  const std::string_view shown = trimmed(text);
  const std::optional<double> angle = parse_angle(shown);
  if (!angle || !std::isfinite(*angle)) {
    throw InputError(fmt::format("{}: '{}' is not an angle, expected finite radians, or degrees as in 73deg{}", what,
                                 shown, decimal_comma_hint(shown)));
  }
  return *angle;
}

std::size_t read_count(std::string_view text, const std::string& what, std::size_t least) {
  const std::string_view digits = trimmed(text);
  std::size_t count = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  if (error != std::errc() || stop != digits.data() + digits.size() || count < least) {
    throw InputError(fmt::format("{}: '{}' is not a whole number of at least {}", what, digits, least));
  }
  return count;
}

}  // namespace rollfix::app
