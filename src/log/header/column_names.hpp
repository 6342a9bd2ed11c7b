#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "log/log_table.hpp"
#include "rollfix/log.hpp"

// What columns are called, and what may be said of one: "u_a", "psi=yaw:deg:unwrapped".
namespace rollfix {

bool is_known(std::string_view name);

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

}  // namespace rollfix
