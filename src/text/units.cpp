#include "text/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <vector>

#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace {

constexpr Dimension kAngle = Dimension::angle;
constexpr Dimension kLength = Dimension::length;
constexpr Dimension kTime = Dimension::time;

// A survey foot is 1200/3937 m.
constexpr double kSurveyFoot = 1e10 * 1200 / 3937;

/// The first of each size is the name that is shown. Lengths in 1e-10 m, times in nanoseconds.
constexpr std::array kKnownUnits = {
    Unit{"rad", kAngle, 1},
    Unit{"deg", kAngle, std::numbers::pi / 180},
    Unit{"mm", kLength, 1e7},
    Unit{"cm", kLength, 1e8},
    Unit{"m", kLength, 1e10},
    Unit{"in", kLength, 254e6},
    Unit{"um", kLength, 1e4},
    Unit{"nm", kLength, 10},
    Unit{"angstrom", kLength, 1},
    Unit{"dm", kLength, 1e9},
    Unit{"dam", kLength, 1e11},
    Unit{"hm", kLength, 1e12},
    Unit{"km", kLength, 1e13},
    Unit{"Gm", kLength, 1e19},
    Unit{"ft", kLength, 3048e6},
    Unit{"yd", kLength, 9144e6},
    Unit{"mi", kLength, 1609344e7},
    Unit{"mil", kLength, 254e3},
    Unit{"uin", kLength, 254},
    Unit{"us-ft", kLength, kSurveyFoot},
    Unit{"us-in", kLength, kSurveyFoot / 12},
    Unit{"us-yd", kLength, 3 * kSurveyFoot},
    Unit{"us-mi", kLength, 5280 * kSurveyFoot},
    Unit{"s", kTime, 1e9},
    Unit{"ms", kTime, 1e6},
    Unit{"us", kTime, 1e3},
    Unit{"ns", kTime, 1},
};

struct Alias {
  std::string_view written;
  std::string_view name;
};

constexpr std::array kAliases = {
    Alias{"radian", "rad"},     Alias{"radians", "rad"},   Alias{"degree", "deg"},     Alias{"degrees", "deg"},
    Alias{"\u00b0", "deg"},     Alias{"millimetre", "mm"}, Alias{"millimetres", "mm"}, Alias{"millimeter", "mm"},
    Alias{"millimeters", "mm"}, Alias{"centimetre", "cm"}, Alias{"centimetres", "cm"}, Alias{"centimeter", "cm"},
    Alias{"centimeters", "cm"}, Alias{"metre", "m"},       Alias{"metres", "m"},       Alias{"meter", "m"},
    Alias{"meters", "m"},       Alias{"inch", "in"},       Alias{"inches", "in"},      Alias{"\u00b5m", "um"},
    Alias{"\u03bcm", "um"},     Alias{"sec", "s"},         Alias{"second", "s"},       Alias{"seconds", "s"},
    Alias{"msec", "ms"},        Alias{"\u00b5s", "us"},    Alias{"\u03bcs", "us"},     Alias{"usec", "us"},
    Alias{"nsec", "ns"},
};

/// The units that messages name.
constexpr std::array<std::string_view, 8> kUsualLengths = {"mm", "cm", "m", "in", "ft", "um", "km", "mil"};

std::optional<Unit> unit_of_length(std::string_view name) {
  const std::optional<Unit> unit = unit_named(name);
  return unit && unit->dimension == kLength ? unit : std::nullopt;
}

}  // namespace

std::optional<Unit> unit_named(std::string_view name) {
  const auto* const alias =
      std::find_if(kAliases.begin(), kAliases.end(), [&](const Alias& one) { return one.written == name; });
  if (alias != kAliases.end()) name = alias->name;
  const auto* const unit =
      std::find_if(kKnownUnits.begin(), kKnownUnits.end(), [&](const Unit& one) { return one.name == name; });
  return unit == kKnownUnits.end() ? std::nullopt : std::optional<Unit>(*unit);
}

std::string unit_names(Dimension dimension) {
  if (dimension == kLength) return fmt::format("{}", fmt::join(kUsualLengths, ", "));
  std::vector<std::string_view> names;
  for (const Unit& unit : kKnownUnits) {
    if (unit.dimension == dimension) names.push_back(unit.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

const char* name_of(Dimension dimension) {
  return dimension == kAngle ? "an angle" : dimension == kLength ? "a length" : "a time";
}

Conversion conversion(const Unit& from, const Unit& to) {
  if (from.size == to.size) return {};
  return from.size > to.size ? Conversion{from.size / to.size, 1} : Conversion{1, to.size / from.size};
}

Conversion conversion_to_plain(const Unit& from) {
  // An angle's size is in radians already, and a number in degrees is read as 73deg is: to the same bits.
  if (from.dimension == kAngle) return {from.size, 1};
  return conversion(from, *unit_named(from.dimension == kTime ? "s" : "m"));
}

std::optional<Length> parse_length(std::string_view text) {
  text = trimmed(text);
  const char* cursor = text.data();
  const char* const end = text.data() + text.size();
  Length result;
  if (!scan_number(cursor, end, result.value)) return std::nullopt;
  const std::string_view unit = trimmed({cursor, static_cast<std::size_t>(end - cursor)});
  if (unit.empty()) return result;
  const std::optional<Unit> known = unit_of_length(unit);
  if (!known) return std::nullopt;
  result.unit = known->name;
  return result;
}

double in_unit(const Length& length, std::string_view part_unit, const std::string& what) {
  if (length.unit.empty() || length.unit == part_unit) return length.value;
  if (part_unit.empty()) {
    throw InputError(fmt::format(
        "{}: the part's file states no unit, so that '{}' can't be converted; state it, as in `unit` {}, or give a "
        "plain number in the part's own unit",
        what, length.unit, length.unit));
  }
  return length_conversion(length.unit, part_unit, what)(length.value);
}

Conversion length_conversion(std::string_view from, std::string_view to, const std::string& what) {
  const std::optional<Unit> from_unit = unit_of_length(from);
  const std::optional<Unit> to_unit = unit_of_length(to);
  if (from_unit && to_unit) return conversion(*from_unit, *to_unit);
  throw InputError(fmt::format(
      "{}: {} can't be converted to {}, because '{}' is no unit of length that is known (they are {}, ...); state the "
      "part's with `unit`",
      what, from, to, from_unit ? to : from, unit_names(kLength)));
}

}  // namespace rollfix
