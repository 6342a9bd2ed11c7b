#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix {

/// Points with the lines of the file that they came from.
struct NumberedPoints {
  std::vector<Vec2> points;          // in the file's order and unit
  std::vector<std::size_t> lines;    // of each point, counted from 1
  bool has_title = false;            // a line of words or a header stands in front
  std::string unit{};                // that a header states, as in "x [mm],y [mm]"; empty: none
  std::vector<std::string> notes{};  // what of the file's beginning was passed over
};

/// The table of points that a text is, in one pass: titles, a header or none, and a point in each line. Throws
/// InputError naming the line.
NumberedPoints read_point_table(std::string_view text, const std::string& name, std::optional<bool> decimal_comma);

}  // namespace rollfix
