#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/units.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

// Readings as people write them. Notation
//   LENGTH,TURN  or  LENGTH_A,LENGTH_B,TURN   the fields of a text; a length may have a unit, a turn may be in degrees
//   half unit    half of a field's last decimal, in the field's own unit: so far its rounding can have moved it
// Idea: trailing zeros are often left off, so all fields of a reading count as rounded alike, to the decimals of the
// one that shows most of them.

namespace rollfix {

namespace {

/// In the field's own unit.
double half_unit(std::string_view field) {
  take_degrees(field);
  return rollfix::rounding_of(field);
}

/// Half a unit of the finest decimal of all fields, as a length (of two fingers the sum of both) and as an angle. 0 for
/// whole numbers, which are exact.
Rounding common_rounding(const std::vector<std::string_view>& fields, const std::vector<Length>& lengths,
                         const std::string& unit) {
  double finest = 0;
  for (const std::string_view field : fields) {
    const double one = half_unit(field);
    if (one > 0 && (finest == 0 || one < finest)) finest = one;
  }
  double length = 0;
  for (const Length& one : lengths) length += in_unit({finest, one.unit}, unit, "");
  std::string_view turn = fields.back();
  return {length, finest * (take_degrees(turn) ? kDegree : 1)};
}

/// For the message: decimal commas give more numbers than were meant.
std::string found_instead(std::size_t count, std::size_t expected) {
  if (count == 1) return "1 number";
  return fmt::format("{} numbers{}", count, count > expected ? "; are there decimal commas among them?" : "");
}

/// Throws InputError: not three fields where the readings are of two fingers, else not two.
void require_fields(std::size_t count, bool of_two, const std::string& what) {
  if (of_two && count != 3) {
    throw InputError(
        fmt::format("{}: expected LENGTH_A,LENGTH_B,TURN as in 0.5,-0.3,73deg, for another reading has "
                    "three numbers, found {}",
                    what, found_instead(count, 3)));
  }
  if (!of_two && count != 2) {
    throw InputError(
        fmt::format("{}: expected LENGTH,TURN as in 0.5,73deg, or of two fingers LENGTH_A,LENGTH_B,TURN, found {}",
                    what, found_instead(count, 2)));
  }
}

}  // namespace

Measurement typed(const std::vector<std::string>& readings, const std::string& unit) {
  Measurement measured(std::vector<Reading>{});
  // One text of three fields makes all of them readings of two fingers.
  const bool of_two = std::any_of(readings.begin(), readings.end(),
                                  [](const std::string& text) { return split(text, ',').size() == 3; });
  for (const std::string& text : readings) {
    const std::string what = fmt::format("`reading` {}", text);
    const std::vector<std::string_view> fields = split(text, ',');
    require_fields(fields.size(), of_two, what);
    std::vector<Length> lengths;
    for (std::size_t k = 0; k + 1 < fields.size(); ++k) lengths.push_back(written_length(fields[k], what));
    const auto length = [&](std::size_t k) { return in_unit(lengths[k], unit, what); };
    const double turn = written_angle(fields.back(), what);
    measured.readings.push_back(of_two ? Reading(length(0), length(1), turn) : Reading(length(0), turn));
    measured.roundings.push_back(common_rounding(fields, lengths, unit));
  }
  return measured;
}

}  // namespace rollfix
