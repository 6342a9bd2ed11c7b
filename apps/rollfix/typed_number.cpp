#include "rollfix/typed_number.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "rollfix/contact/written_number.hpp"
#include "rollfix/error.hpp"

namespace rollfix::app {
namespace {

std::string_view trimmed(std::string_view text) {
  const char* const blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

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

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  std::size_t start = 0;
  for (std::size_t stop = text.find(separator); stop != std::string_view::npos; stop = text.find(separator, start)) {
    pieces.push_back(trimmed(text.substr(start, stop - start)));
    start = stop + 1;
  }
  pieces.push_back(trimmed(text.substr(start)));
  return pieces;
}

}  // namespace rollfix::app
