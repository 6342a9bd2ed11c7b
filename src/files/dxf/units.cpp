#include "files/dxf/units.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>

namespace rollfix::dxf {

namespace {

/// By the number that $INSUNITS has; 0 is no unit.
constexpr std::array<const char*, 25> kUnits = {"",    "in", "ft",       "mi",    "mm",    "cm",    "m",    "km", "uin",
                                                "mil", "yd", "angstrom", "nm",    "um",    "dm",    "dam",  "hm", "Gm",
                                                "au",  "ly", "pc",       "us-ft", "us-in", "us-yd", "us-mi"};

}  // namespace

void set_unit(const Model& model, Drawing& drawing) {
  const std::int64_t number = model.units.value_or(0);
  if (number > 0 && number < static_cast<std::int64_t>(kUnits.size())) {
    drawing.unit = kUnits[static_cast<std::size_t>(number)];
    return;
  }
  if (number != 0) {
    drawing.notes.push_back(
        fmt::format("the header's unit ($INSUNITS) is {}, which means nothing: none is taken", number));
    return;
  }
  if (!model.measurement || *model.measurement < 0 || *model.measurement > 1) return;
  drawing.unit = *model.measurement == 1 ? "mm" : "in";
  drawing.notes.push_back(fmt::format("the header names no unit, but says {} ($MEASUREMENT): taken as {}",
                                      *model.measurement == 1 ? "metric" : "English", drawing.unit));
}

}  // namespace rollfix::dxf
