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
  if (error != std::errc() || stop != end) throw InputError(fmt::format("{}: '{}' is not a number", what, shown));
  if (!std::isfinite(value)) throw InputError(fmt::format("{}: '{}' is not a finite number", what, shown));
  return value;
}

double read_angle(std::string_view text, const std::string& what) {
  const std::string_view shown = trimmed(text);
  const std::optional<double> angle = parse_angle(shown);
  if (!angle || !std::isfinite(*angle)) {
    throw InputError(
        fmt::format("{}: '{}' is not an angle, expected finite radians, or degrees as in 73deg", what, shown));
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
