#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "log/log_table.hpp"
#include "rollfix/log.hpp"

namespace rollfix {

// What columns are called, and what may be said of one: "u_a", "psi=yaw:deg:unwrapped".

bool is_known(std::string_view name);
/// Also with a finger's suffix behind it: "u", "u_a".
bool is_known_of_any(std::string_view name);

/// Whether one of the pairs has a column of this name.
bool says_where(std::string_view name);
bool says_where_of_one_of_two(std::string_view name);

/// The column of this name, for a finger whose columns end in this.
std::optional<Column> column_named(std::string_view name, const std::string& suffix);

/// What is said of a column besides its unit, "wrapped" or "unwrapped", taken off the end of "deg:unwrapped".
std::optional<bool> take_wrapping(std::string_view& unit);

/// Whether the unit can be one of the column.
bool takes(Column column, Dimension dimension);
/// "an angle: rad, deg", "an angle or a length: ...".
std::string what_it_takes(Column column);

// What stands over the columns of a log, and how it is taken.

/// What stands in a header over one column.
struct HeaderName {
  std::string_view text;  // "u [deg]"
  std::string_view name;  // "u"
  std::string_view unit;  // "deg", or whatever stands in the brackets; empty: none
  std::string known{};    // the column that a log may have by this name: "u", "psi_a"; empty: none
};

/// What stands over the columns. Where blanks separate, a unit behind a name is cut off it: they are put together
/// again. Names are known by capitals too, "U" and "Psi", unless the header also has the name in small letters.
std::vector<HeaderName> names_in(const TableRow& header);

/// The columns of a log with this header, of one finger or of two. Throws InputError: no known column, half of a pair,
/// two kinds of log at once, only one of two fingers, the same column twice, a column of the options that is not there,
/// a unit that is not known or not one of the column's, one of length where the part's is not known. `log`: its name,
/// for messages.
std::vector<Columns> columns_of(const TableRow& header, const std::string& log, const LogOptions& options = {});

/// The columns of the log of a wheel without skin. Throws InputError likewise, and where it has a skin's, where it does
/// not say where the pin is, or is of two fingers.
Columns pin_columns_of(const TableRow& header, const std::string& log, const LogOptions& options = {});

/// The columns of a log without a header. Throws InputError unless there are two.
Columns bare_columns(const TableRow& row, const std::string& log, const LogOptions& options = {});

/// Where the columns of one finger were taken and the header has another's as well: what stands there, and how both are
/// taken; else empty.
std::string other_finger_note(const std::vector<HeaderName>& header, const Columns& found);

/// The unit that a name ends in, where it would change the column's numbers: "deg" of yaw_deg, "ms" of stamp_ms, "mm"
/// of dist_mm. Empty where there is none.
std::string unit_in_name(std::string_view name, Column column, const std::string& part_unit);

/// Whether any name may be that of a column of this finger: not that of the other one, and like one that is needed.
bool holds_columns_of(const std::vector<HeaderName>& header, std::size_t finger);

/// What to write for the columns that a log of this kind needs and the header does not have, by what its names sound
/// like: "u=contact_deg:deg,psi=yaw_deg:deg". Only for people to read and judge: nothing is read by it.
std::string suggested_columns(const std::vector<HeaderName>& header, const Columns& found);

/// As `columns` is typed, "u=pad:deg,psi=wrist:deg", fit for a shell.
std::string written(const std::vector<ColumnSource>& columns);

}  // namespace rollfix
