#include "rollfix/arguments/arguments.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include "outline/turn.hpp"
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

double read_length(std::string_view text, const std::string& what, const std::string& part_unit) {
  return in_unit(written_length(text, what), part_unit, what);
}

std::vector<std::string_view> fields_of(std::string_view text, const std::string& what, std::size_t least,
                                        std::size_t most, const char* expected) {
  std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() >= least && fields.size() <= most) return fields;
  const std::string found = counted(fields.size(), "number", "numbers");
  throw InputError(fmt::format("{}: {}", what, fmt::format(fmt::runtime(expected), found)));
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

namespace {

/// What an angle is divided by: as it is written, and how many seconds, or square roots of seconds, that is.
struct Per {
  std::string_view written;
  double seconds;
};
constexpr std::array<Per, 3> kRates = {{{"s", 1}, {"min", 60}, {"h", 3600}}};
const std::array<Per, 6> kWalks = {{{"sqrt(s)", 1},
                                    {"sqrt(min)", std::sqrt(60.0)},
                                    {"sqrt(h)", 60},
                                    {"s/sqrt(hz)", 1},
                                    {"min/sqrt(hz)", 60},
                                    {"h/sqrt(hz)", 3600}}};

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

template <class Table>
double read_per(std::string_view text, const std::string& what, const Table& table, const char* examples) {
  const std::string_view shown = trimmed(text);
  const std::size_t slash = shown.find('/');
  if (slash == std::string_view::npos && shown.find("deg") == std::string_view::npos) return read_number(shown, what);
  const std::string per = slash == std::string_view::npos ? "" : lower(trimmed(shown.substr(slash + 1)));
  const auto unit = std::find_if(table.begin(), table.end(), [&](const Per& one) { return one.written == per; });
  if (unit == table.end()) throw InputError(fmt::format("{}: '{}' is none of {}", what, shown, examples));
  std::string_view angle = trimmed(shown.substr(0, slash));
  if (angle.size() > 3 && angle.substr(angle.size() - 3) == "rad") angle.remove_suffix(3);
  return written_angle(angle, what) / unit->seconds;
}

}  // namespace

double read_rate(std::string_view text, const std::string& what) {
  return read_per(text, what, kRates, "10deg/h, 5deg/min, 0.01deg/s, or radians per second");
}

double read_walk(std::string_view text, const std::string& what) {
  return read_per(text, what, kWalks,
                  "0.3deg/sqrt(h), 0.005deg/sqrt(s), 0.005deg/s/sqrt(Hz), or radians per square root of a second");
}

Interval read_travel(const std::string& text, const std::string& unit) {
  const std::vector<std::string_view> fields = split(text, ',');
  const std::string what = "--travel " + text;
  if (fields.size() == 1) {
    const double most = read_length(fields[0], what, unit);
    if (!(most > 0)) throw InputError(what + ": expected a length above 0, or BACK,FORWARD as in -0.5,1.2");
    return {-most, most};
  }
  if (fields.size() != 2) {
    throw InputError(what + ": expected one length, or BACK,FORWARD as in -0.5,1.2; are there decimal commas in it?");
  }
  const Interval travel{read_length(fields[0], what, unit), read_length(fields[1], what, unit)};
  if (!(travel.lo <= 0 && travel.hi >= 0 && travel.width() > 0)) {
    throw InputError(what + ": expected a length of at most 0, backwards, and one of at least 0, forwards, not both 0");
  }
  return travel;
}

namespace {

bool in_degrees(std::string_view angle) { return take_degrees(angle); }

/// Half a unit of the last decimal, whatever the unit is.
double half_unit(std::string_view number) {
  take_degrees(number);
  return rounding_of(number);
}

// A turn of more than this, and of as much again for each lap that was rolled, radians, was hardly meant as radians.
constexpr double kHardlyRadians = 4 * std::numbers::pi;

/// Where a turn that was typed without a unit was likely meant in degrees; else empty.
std::string degrees_hint(const std::string& typed, const Reading& reading, const Part& part) {
  const std::string_view turn = trimmed(split(typed, ',').back());
  double laps = 0;
  for (const double length : reading.length) laps += std::abs(length) / part.perimeter();
  if (in_degrees(turn) || std::abs(reading.turn) <= kHardlyRadians * (1 + laps)) return "";
  return fmt::format("--reading {}: a turn of {} rad is {:.3g} turns; did you mean {}deg?", typed, turn,
                     std::abs(reading.turn) / (2 * std::numbers::pi), turn);
}

}  // namespace

double half_unit_of_angle(const std::string& angle) { return half_unit(angle) * (in_degrees(angle) ? kDegree : 1); }

Measurements read_readings(const std::vector<std::string>& readings, const Part& part,
                           std::vector<std::string>& notes) {
  Measurement of_roll = rollfix::typed(readings, part.unit());
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const std::string hint = degrees_hint(readings[k], of_roll.readings[k], part);
    if (!hint.empty()) notes.push_back(hint);
  }
  Measurements measured;
  measured.readings = std::move(of_roll.readings);
  measured.roundings = std::move(of_roll.roundings);
  return measured;
}

}  // namespace rollfix::app
