#include "rollfix/arguments/typed_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "outline/turn.hpp"
#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

bool in_degrees(std::string_view angle) { return take_degrees(angle); }

/// Half a unit of the last decimal, whatever the unit is.
double half_unit(std::string_view number) {
  take_degrees(number);
  return rounding_of(number);
}

/// Trailing zeros are often left off, so all numbers are taken to be rounded alike: to the decimals of the one that
/// shows most of them, each in its own unit. `lengths`: as typed.
Rounding common_rounding(const std::vector<std::string_view>& fields, const std::vector<Length>& lengths,
                         const std::string& unit) {
  double finest = 0;
  for (const std::string_view field : fields) {
    const double one = half_unit(field);
    if (one > 0 && (finest == 0 || one < finest)) finest = one;
  }
  double length = 0;
  for (const Length& one : lengths) length += in_unit({finest, one.unit}, unit, "");
  return {length, finest * (in_degrees(fields.back()) ? kDegree : 1)};
}

std::string found_instead(std::size_t count) {
  if (count == 1) return "1 number";
  return fmt::format("{} numbers; are there decimal commas among them?", count);
}

/// LENGTH,TURN of one finger, or LENGTH_A,LENGTH_B,TURN of two.
void read_reading(const std::string& text, bool of_two, const std::string& unit, Measurements& measured) {
  const std::string what = fmt::format("--reading {}", text);
  const std::vector<std::string_view> fields = split(text, ',');
  if (of_two && fields.size() != 3) {
    throw InputError(fmt::format("{}: expected LENGTH_A,LENGTH_B,TURN as in 0.5,-0.3,73deg, found {}", what,
                                 found_instead(fields.size())));
  }
  if (!of_two && fields.size() != 2) {
    throw InputError(
        fmt::format("{}: expected LENGTH,TURN as in 0.5,73deg, or of two fingers LENGTH_A,LENGTH_B,TURN, found {}",
                    what, found_instead(fields.size())));
  }
  std::vector<Length> lengths;
  for (std::size_t k = 0; k + 1 < fields.size(); ++k) lengths.push_back(read_given_length(fields[k], what));
  const auto length = [&](std::size_t k) { return in_unit(lengths[k], unit, what); };
  const double turn = read_angle(fields.back(), what);
  measured.readings.push_back(of_two ? Reading(length(0), length(1), turn) : Reading(length(0), turn));
  measured.roundings.push_back(common_rounding(fields, lengths, unit));
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
  Measurements measured;
  const bool of_two = std::any_of(readings.begin(), readings.end(),
                                  [](const std::string& text) { return split(text, ',').size() == 3; });
  for (const std::string& text : readings) {
    read_reading(text, of_two, part.unit(), measured);
    const std::string hint = degrees_hint(text, measured.readings.back(), part);
    if (!hint.empty()) notes.push_back(hint);
  }
  return measured;
}

}  // namespace rollfix::app
