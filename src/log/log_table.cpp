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
#include "rollfix/pulse.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

// Text to cells and back: a file through a buffer, lines, cells, and a log as a table.
//   line            up to the next '\n', without it; valid until the next one is asked for
//   cell            between two separators, without blanks and quotes around it; the first row shows the separator
// Follows docs/rolling.md, "Logs". Reading needs memory for one line, however long the file is.
namespace rollfix {
namespace {

constexpr std::size_t kLogBuffer = 1 << 16;  // bytes; it grows only for a line that is longer

/// A cell without blanks and without quotes around it.
std::string_view bare(std::string_view cell) {
  cell = trimmed(cell);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') return trimmed(cell.substr(1, cell.size() - 2));
  return cell;
}

/// What separates the cells of this row: a comma, a semicolon or a tab if it has one, in this order, else blanks.
char separator_of(std::string_view row) {
  for (const char mark : {',', ';', '\t'}) {
    if (row.find(mark) != std::string_view::npos) return mark;
  }
  return ' ';
}

}  // namespace

/// Refuses what is no table of text, each with its cure: UTF-16, gzip, old line ends, zero bytes.
std::string_view plain_beginning(std::string_view text, const std::string& name) {
  const std::string_view mark = text.substr(0, 2);
  if (mark == "\xFF\xFE" || mark == "\xFE\xFF") {
    throw InputError(fmt::format("{}: is UTF-16 text, expected plain text; save it as UTF-8", name));
  }
  if (is_gzip(text)) throw InputError(fmt::format("{}: is compressed, expected plain text: gunzip -k {}", name, name));
  if (has_only_returns(text)) throw InputError(about_only_returns(name));
  if (text.substr(0, 1024).find('\0') != std::string_view::npos) {
    throw InputError(fmt::format("{}: is not a text file, expected a log with one row per line", name));
  }
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  return text;
}

LogLines::LogLines(std::string_view text, std::string name) : name_(std::move(name)) {
  text = plain_beginning(text, name_);
  cursor_ = text.data();
  end_ = text.data() + text.size();
}

LogLines::LogLines(std::FILE* file, std::string name, const std::string& first)
    : name_(std::move(name)), file_(file), buffer_(first) {
  buffer_.resize(std::max(kLogBuffer, first.size()));
  cursor_ = buffer_.data();
  end_ = cursor_ + first.size();
  // Something to judge by has to be there: the beginning, read now or before.
  if (first.empty()) refill();
  const auto size = static_cast<std::size_t>(end_ - cursor_);
  cursor_ = plain_beginning({cursor_, size}, name_).data();
}

/// Moves what is left to the front and reads on behind it; false at the end.
bool LogLines::refill() {
  if (file_ == nullptr) return false;
  const auto left = static_cast<std::size_t>(end_ - cursor_);
  // Invariant: [cursor_, end_) is what was read and not given out. It moves to the front; the buffer grows only if one
  // line fills it.
  std::memmove(buffer_.data(), cursor_, left);
  if (left == buffer_.size()) buffer_.resize(2 * buffer_.size());
  const std::size_t count = std::fread(buffer_.data() + left, 1, buffer_.size() - left, file_);
  if (std::ferror(file_) != 0) throw InputError(fmt::format("{}: can't be read: {}", name_, std::strerror(errno)));
  cursor_ = buffer_.data();
  end_ = cursor_ + left + count;
  return count > 0;
}

bool LogLines::next(std::string_view& line) {
  beat();
  std::size_t seen = 0;  // of the line, without an end
  while (true) {
    // Only what was not searched yet is searched, so that a long line takes linear time.
    const auto rest = static_cast<std::size_t>(end_ - cursor_);
    const void* const found = rest > seen ? std::memchr(cursor_ + seen, '\n', rest - seen) : nullptr;
    if (found != nullptr) {
      const auto* const newline = static_cast<const char*>(found);
      line = {cursor_, static_cast<std::size_t>(newline - cursor_)};
      cursor_ = newline + 1;
      return true;
    }
    seen = rest;
    // No end in what was read: read on. At the end of the file the rest is the last line.
    if (refill()) continue;
    line = {cursor_, static_cast<std::size_t>(end_ - cursor_)};
    cursor_ = end_;
    return !line.empty();
  }
}

bool TableCutter::cut(std::string_view line, std::size_t number, TableRow& row) {
  // A comment goes to the end of its line.
  const std::string_view bare_line = line.substr(0, line.find('#'));
  const std::string_view data = trimmed(bare_line);
  if (data.empty()) return false;
  row.line = number;
  row.text = line;
  // Decimal commas are possible between semicolons, or where the options say so; between commas 0,5 is two cells.
  const bool may_have_commas = separator_ == '\0' || separator_ == ';' || decimal_comma_ == true;
  std::optional<std::string> converted;
  if (may_have_commas) converted = with_decimal_points(bare_line, decimal_comma_);
  if (converted) with_points_ = std::move(*converted);
  const std::string_view untrimmed = converted ? std::string_view(with_points_) : bare_line;
  // After the commas became points only semicolons can separate, if there are any.
  const bool has_semicolons = converted && untrimmed.find(';') != std::string_view::npos;
  // The first row decides for all.
  if (separator_ == '\0') separator_ = has_semicolons ? ';' : separator_of(trimmed(untrimmed));
  // Between tabs a cell at either end may be empty: blanks there are not trimmed off.
  split(separator_ == '\t' ? untrimmed : trimmed(untrimmed), row.cells);
  return true;
}

/// The cells of a row. Several blanks are one separator; of other marks each one is.
void TableCutter::split(std::string_view data, std::vector<std::string_view>& cells) const {
  cells.clear();
  while (true) {
    const std::size_t mark = separator_ == ' ' ? data.find_first_of(" \t") : data.find(separator_);
    cells.push_back(bare(data.substr(0, mark)));
    if (mark == std::string_view::npos) return;
    data.remove_prefix(mark + 1);
    // Blanks in a row are one separator.
    if (separator_ == ' ') data = trimmed(data);
  }
}

std::string where(const std::string& name, std::size_t line) { return fmt::format("{}:{}", name, line); }

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
