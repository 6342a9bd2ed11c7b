#include "rollfix/reading_argument.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "rollfix/contact/written_number.hpp"
#include "rollfix/error.hpp"
#include "rollfix/typed_number.hpp"

namespace rollfix::app {
namespace {

constexpr std::string_view kDegreeMark = "deg";

std::string cause_of(std::size_t count) {
  if (count == 1) return "1 number";
  if (count == 3) return "3 numbers, which is two fingers: not there yet";
  return fmt::format("{} numbers; are there decimal commas among them?", count);
}

bool in_degrees(std::string_view angle) {
  return angle.size() > kDegreeMark.size() && angle.substr(angle.size() - kDegreeMark.size()) == kDegreeMark;
}

/// Half a unit of the last decimal, whatever the unit is.
double half_unit(std::string_view number) {
  if (in_degrees(number)) number.remove_suffix(kDegreeMark.size());
  return rounding_of(number);
}

/// Both numbers are rounded alike: to the decimals of the one that shows more of them.
Rounding rounding_of_both(std::string_view length, std::string_view turn) {
  const double one = half_unit(length);
  const double two = half_unit(turn);
  const double finer = one > 0 && two > 0 ? std::min(one, two) : std::max(one, two);
  return {finer, finer * (in_degrees(turn) ? std::numbers::pi / 180 : 1)};
}

}  // namespace

WrittenReading read_reading(const std::string& text) {
  const std::string what = fmt::format("--reading {}", text);
  const std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() != 2) {
    throw InputError(
        fmt::format("{}: expected LENGTH,TURN as in 0.5,1.2 or 0.5,73deg, found {}", what, cause_of(fields.size())));
  }
  const Reading reading{read_number(fields[0], what), read_angle(fields[1], what)};
  return {reading, rounding_of_both(fields[0], fields[1])};
}

}  // namespace rollfix::app
