#include "text/number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include "rollfix/error.hpp"
#include "text/text.hpp"
#include "text/units.hpp"

namespace rollfix {
namespace {

constexpr double kRadiansOfDegree = std::numbers::pi / 180;
constexpr std::array<std::string_view, 2> kDegreeMarks = {"deg", "\xC2\xB0"};  // the second is the degree sign
constexpr int kMostPower = 1000;  // beyond it every double is 0 or infinite

/// 5 * 10^-(places + 1), half a unit in this decimal place. The powers that occur all the time come from a table.
double half_unit(int places) {
  static const std::array<double, 20> table = [] {
    std::array<double, 20> values{};
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = 0.5 * std::pow(10.0, -static_cast<double>(k));
    return values;
  }();
  const auto index = static_cast<std::size_t>(places);
  return index < table.size() ? table[index] : 0.5 * std::pow(10.0, -places);
}

}  // namespace

bool take_degrees(std::string_view& text) {
  for (const std::string_view mark : kDegreeMarks) {
    if (text.size() <= mark.size() || text.substr(text.size() - mark.size()) != mark) continue;
    text.remove_suffix(mark.size());
    while (text.size() > 1 && text.back() == ' ') text.remove_suffix(1);
    return true;
  }
  return false;
}

std::optional<double> parse_angle(std::string_view text) {
  const bool in_degrees = take_degrees(text);
  const std::optional<double> value = parse_number(text);
  if (!value || !in_degrees) return value;
  return *value * kRadiansOfDegree;
}

namespace {

/// "-0,5", "1,25e-3", ",5".
bool has_decimal_comma(std::string_view cell) {
  const std::size_t comma = cell.find(',');
  if (comma == std::string_view::npos || comma + 1 == cell.size()) return false;
  const char next = cell[comma + 1];
  if (next < '0' || next > '9') return false;
  std::string number(cell);
  number[comma] = '.';
  return parse_angle(number).has_value();
}

}  // namespace

std::optional<std::string> with_decimal_points(std::string_view row, std::optional<bool> decimal_comma) {
  if (row.find(',') == std::string_view::npos || decimal_comma == false) return std::nullopt;
  const bool has_semicolons = row.find(';') != std::string_view::npos;
  if (!has_semicolons && !decimal_comma) return std::nullopt;
  const char* const separators = has_semicolons ? ";" : " \t";
  std::string result(row);
  bool any = false;
  std::size_t start = 0;
  while (start <= result.size()) {
    const std::size_t end = std::min(result.find_first_of(separators, start), result.size());
    const std::string_view padded(result.data() + start, end - start);
    const std::size_t first = padded.find_first_not_of(" \t\r\"");
    if (first != std::string_view::npos) {
      const std::size_t last = padded.find_last_not_of(" \t\r\"");
      const std::string_view cell = padded.substr(first, last - first + 1);
      if (has_decimal_comma(cell)) {
        result[start + first + cell.find(',')] = '.';
        any = true;
      }
    }
    start = end + 1;
  }
  return any ? std::optional<std::string>(std::move(result)) : std::nullopt;
}

std::string decimal_comma_hint(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto digits_from = [&](std::size_t k) {
    const std::size_t start = k;
    while (k < text.size() && is_digit(text[k])) ++k;
    return k - start;
  };
  const std::size_t start = !text.empty() && (text.front() == '-' || text.front() == '+') ? 1 : 0;
  const std::size_t before = digits_from(start);
  const std::size_t comma = start + before;
  if (before == 0 || comma >= text.size() || text[comma] != ',') return "";
  const std::size_t after = digits_from(comma + 1);
  if (after == 0) return "";
  const std::string_view rest = text.substr(comma + 1 + after);
  const bool has_more = std::any_of(rest.begin(), rest.end(), [&](char c) { return is_digit(c) || c == ','; });
  if (has_more) return "";
  return "; numbers take a decimal point, as in " + std::string(text.substr(0, comma)) + "." +
         std::string(text.substr(comma + 1)) + ", not a comma";
}

double rounding_of(std::string_view number) {
  const double unit = take_degrees(number) ? kRadiansOfDegree : 1;
  bool after_point = false;
  bool is_zero = true;
  int places = 0;
  std::size_t k = 0;
  for (; k < number.size() && number[k] != 'e' && number[k] != 'E'; ++k) {
    const char c = number[k];
    if (c == '.') {
      after_point = true;
    } else if (c >= '0' && c <= '9') {
      if (c != '0') is_zero = false;
      if (after_point) ++places;
    }
  }
  if (k < number.size()) {
    const char* exponent = number.data() + k + 1;
    const char* const end = number.data() + number.size();
    if (exponent != end && *exponent == '+') ++exponent;
    int power = 0;
    std::from_chars(exponent, end, power);
    places -= std::clamp(power, -kMostPower, kMostPower);
  }
  if (is_zero || places <= 0) return 0;
  return unit * half_unit(places);
}

Length written_length(std::string_view text, const std::string& what) {
  const std::string_view shown = trimmed(text);
  const std::optional<Length> length = parse_length(shown);
  if (!length) {
    throw InputError(fmt::format("{}: '{}' is not a number, nor one with a unit of length as in 8mm ({}){}", what,
                                 shown, unit_names(Dimension::length), decimal_comma_hint(shown)));
  }
  if (!std::isfinite(length->value)) throw InputError(fmt::format("{}: '{}' is not a finite number", what, shown));
  return *length;
}

double written_angle(std::string_view text, const std::string& what) {
  const std::string_view shown = trimmed(text);
  const std::optional<double> angle = parse_angle(shown);
  if (!angle || !std::isfinite(*angle)) {
    throw InputError(fmt::format("{}: '{}' is not an angle, expected finite radians, or degrees as in 73deg{}", what,
                                 shown, decimal_comma_hint(shown)));
  }
  return *angle;
}

}  // namespace rollfix
