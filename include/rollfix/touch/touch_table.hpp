#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/contact/log_options.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix {

/// How to read a table of touches.
struct TouchTableOptions {
  /// What the header calls columns that it does not have under their known names; of parse_touch_columns.
  std::vector<ColumnSource> columns{};
  std::string unit{};  // the part's: columns with a unit of length are converted to it; empty: not known
  std::optional<bool> decimal_comma{};  // as of a log
  bool may_be_empty = false;            // a table that grows: there may be no touch in it yet
};

/// Touches from a file, with the lines that they stand in.
struct TouchTable {
  std::vector<MeasuredTouch> touches;
  std::vector<std::size_t> lines;
  std::vector<Clear> clear{};        // between rows of which at least one has contact 0
  std::vector<std::string> notes{};  // what was left out, or taken for granted
};

/// "x=px:mm,y=py:mm,normal=n:deg": COLUMN=NAME or COLUMN=NAME:UNIT, any number of them. Throws InputError: not of this
/// form, a column that is not known or there twice, a unit that is not the column's.
std::vector<ColumnSource> parse_touch_columns(std::string_view text);

/// Whether "COLUMN=NAME,..." names a column that only touches have, such as normal.
bool names_touch_columns(std::string_view text);

/// Whether a text, or its beginning, is a table of touches: a probe's report, see parse_touches; or a header with x and
/// y, nothing of a roll (u, psi, length, turn, ...), and no name that sounds like it, unless there is another one of
/// touches as well, such as normal.
bool is_touch_table(std::string_view text, const TouchTableOptions& options = {});

/// A touch in each row: columns x and y, and if there normal, position_sd, normal_sd and contact (0: not a touch), in
/// any order, in capitals or not; others are ignored. Bare angles are radians, "73deg" degrees; a header may name a
/// unit, as in "x [mm]", "x_mm" or "normal [deg]". An empty normal or sd: not measured, not known.
/// Also the places that a probe leaves: lines with GRBL's [PRB:x,y,z:1], and rows of nine numbers without a header, as
/// LinuxCNC writes them between PROBEOPEN and PROBECLOSE.
/// `name`: of the file, for messages. Throws InputError, naming the line: no such columns, a cell that is no number, no
/// row.
TouchTable parse_touches(std::string_view text, const std::string& name, const TouchTableOptions& options = {});

}  // namespace rollfix
