#include "log/log_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "log/roll_rows.hpp"
#include "log/wrapping.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "text/number.hpp"

// A log as a table, and whether a row is one of numbers.
// Follows docs/rolling.md, "Logs".
namespace rollfix {

/// A header has at least one cell that is no number; empty cells can be of either.
bool is_data(const TableRow& row) {
  return std::all_of(row.cells.begin(), row.cells.end(),
                     [](std::string_view cell) { return cell.empty() || parse_angle(cell).has_value(); });
}

namespace {

/// A column of a table that is to be written.
using NamedColumn = std::pair<std::string, std::vector<double>>;

/// Of the log of a wheel without skin, which has no u, there are as many as times.
std::size_t rows_in(const Log& log) { return log.rows() > 0 ? log.rows() : log.time.size(); }

/// The columns that a log has. Throws InputError when one is shorter or longer than the others.
std::vector<NamedColumn> columns_of(const Log& log) {
  std::vector<NamedColumn> present;
  const auto add = [&](const std::string& name, std::vector<double> column) {
    // The log does not have it.
    if (column.empty()) return;
    if (column.size() != rows_in(log)) {
      throw InputError(
          fmt::format("{}: expected {} values in column '{}', found {}", log.name, rows_in(log), name, column.size()));
    }
    present.emplace_back(name, std::move(column));
  };
  add(name_of(Column::time), log.time);
  for (std::size_t k = 0; k < log.fingers.size(); ++k) {
    const FingerRows& rows = log.fingers[k];
    const std::string suffix = log.fingers.size() == 1 ? "" : kFingerSuffixes[k];
    // As increments again: a log keeps its kind when it is written and read.
    if (log.kind == LogKind::increments) {
      Increments increments = increments_of(rows);
      add(name_of(Column::distance) + suffix, std::move(increments.distance));
      add(name_of(Column::dturn) + suffix, std::move(increments.dturn));
    } else {
      add(name_of(Column::u) + suffix, rows.u);
      add(name_of(Column::psi) + suffix, rows.psi);
      add(name_of(Column::length) + suffix, rows.length);
      add(name_of(Column::turn) + suffix, rows.turn);
    }
    add(name_of(Column::x) + suffix, rows.x);
    add(name_of(Column::y) + suffix, rows.y);
  }
  return present;
}

/// The table, 17 significant digits each.
std::string format_table(const std::vector<NamedColumn>& columns, std::size_t rows) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (std::size_t k = 0; k < columns.size(); ++k) fmt::format_to(out, "{}{}", k == 0 ? "" : ",", columns[k].first);
  text.push_back('\n');
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      // With trailing zeros: they say how precise the number is.
      fmt::format_to(out, "{}{:#.17g}", k == 0 ? "" : ",", columns[k].second[row]);
    }
    text.push_back('\n');
  }
  return fmt::to_string(text);
}

/// Writes a text to a file, "-" for standard output. Throws InputError when it can't be written.
void write_text(const std::string& path, const std::string& text) {
  if (path == "-") {
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
    throw InputError(fmt::format("standard output: can't be written: {}", std::strerror(errno)));
  }
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"), &std::fclose);
  // Closing can fail as well, where the last bytes are written.
  const bool is_written = file && std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  const bool is_closed = file && std::fclose(file.release()) == 0;
  if (!is_written || !is_closed) throw InputError(fmt::format("{}: can't be written: {}", path, std::strerror(errno)));
}

}  // namespace

std::string format_log(const Log& log) {
  const std::vector<NamedColumn> columns = columns_of(log);
  // Rather no file than one that reads otherwise.
  for (const FingerRows& rows : log.fingers) require_readable(rows, log.name);
  return format_table(columns, rows_in(log));
}

void write_log(const std::string& path, const Log& log) { write_text(path, format_log(log)); }

}  // namespace rollfix
