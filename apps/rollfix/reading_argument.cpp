#include "rollfix/reading_argument.hpp"

#include <fmt/format.h>

#include <vector>

#include "outline/turn.hpp"
#include "rollfix/contact/written_number.hpp"
#include "rollfix/error.hpp"
#include "rollfix/typed_number.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr std::string_view kDegreeMark = "deg";

std::string cause_of(std::size_t count) {
  if (count == 1) return "1 number";
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

/// All numbers are rounded alike: to the decimals of the one that shows most of them. Of a turn in degrees.
Rounding common_rounding(const std::vector<std::string_view>& fields) {
  double finest = 0;
  for (const std::string_view field : fields) {
    const double one = half_unit(field);
    if (one > 0 && (finest == 0 || one < finest)) finest = one;
  }
  const auto lengths = static_cast<double>(fields.size() - 1);
  return {lengths * finest, finest * (in_degrees(fields.back()) ? kDegree : 1)};
}

}  // namespace

WrittenReading read_reading(const std::string& text) {
  const std::string what = fmt::format("--reading {}", text);
  const std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() != 2) {
    throw InputError(
        fmt::format("{}: expected LENGTH,TURN as in 0.5,73deg, or of two fingers LENGTH_A,LENGTH_B,TURN, found {}",
                    what, cause_of(fields.size())));
  }
  const Reading reading{read_number(fields[0], what), read_angle(fields[1], what)};
  return {reading, common_rounding(fields)};
}

WrittenPairReading read_pair_reading(const std::string& text) {
  const std::string what = fmt::format("--reading {}", text);
  const std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() != 3) {
    throw InputError(fmt::format("{}: expected LENGTH_A,LENGTH_B,TURN as in 0.5,-0.3,73deg, found {}", what,
                                 cause_of(fields.size())));
  }
  const PairReading reading{read_number(fields[0], what), read_number(fields[1], what), read_angle(fields[2], what)};
  return {reading, common_rounding(fields)};
}

WrittenAngle read_written_angle(const std::string& text, const std::string& option) {
  return {read_angle(text, option), half_unit(text) * (in_degrees(text) ? kDegree : 1)};
}

bool are_of_two_fingers(const std::vector<std::string>& texts) {
  std::size_t of_two = 0;
  for (const std::string& text : texts) of_two += split(text, ',').size() == 3 ? 1 : 0;
  if (of_two == 0) return false;
  for (const std::string& text : texts) static_cast<void>(read_pair_reading(text));  // the odd one is named
  return true;
}

}  // namespace rollfix::app
