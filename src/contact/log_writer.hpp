#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "rollfix/contact/log.hpp"

namespace rollfix {

/// A column of a table that is to be written.
using NamedColumn = std::pair<std::string, const std::vector<double>*>;

/// The columns that the log has, with this behind their names except the time's.
/// Throws InputError when one is shorter or longer than the others.
std::vector<NamedColumn> columns_of(const Log& log, const std::string& suffix = "");

/// The table, 17 significant digits each.
std::string format_table(const std::vector<NamedColumn>& columns, std::size_t rows);

/// Writes a text to a file, "-" for standard output. Throws InputError when it can't be written.
void write_text(const std::string& path, const std::string& text);

}  // namespace rollfix
