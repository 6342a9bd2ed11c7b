#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/touch/touch.hpp"

namespace rollfix {

/// How to read a table of touches.
struct TouchTableOptions {
  std::string unit{};  // the part's: columns with a unit of length are converted to it; empty: not known
  std::optional<bool> decimal_comma{};  // as of a log
};

/// Touches from a file, with the lines that they stand in.
struct TouchTable {
  std::vector<MeasuredTouch> touches;
  std::vector<std::size_t> lines;
};

/// Whether a text is a table of touches: its header has x and y, and nothing of a roll (u, psi, length, turn, ...).
/// Where it has columns by names that are not known it must have another one of touches as well, such as normal.
bool is_touch_table(std::string_view text, const TouchTableOptions& options = {});

/// A touch in each row: columns x and y, and if there normal, position_sd and normal_sd, in any order; others are
/// ignored. Bare angles are radians, "73deg" degrees; a header may name a unit, as in "x [mm]" or "normal [deg]". An
/// empty normal or sd: not measured, not known. `name`: of the file, for messages. Throws InputError, naming the line:
/// no such columns, a cell that is no number, no row.
TouchTable parse_touches(std::string_view text, const std::string& name, const TouchTableOptions& options = {});

}  // namespace rollfix
