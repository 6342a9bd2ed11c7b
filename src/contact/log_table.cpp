#include "contact/log_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix {

namespace {

constexpr std::size_t kLogBuffer = 1 << 16;  // bytes; it grows only for a line that is longer

std::string_view bare(std::string_view cell) {
  cell = trimmed(cell);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') return trimmed(cell.substr(1, cell.size() - 2));
  return cell;
}

char separator_of(std::string_view row) {
  for (const char mark : {',', ';', '\t'}) {
    if (row.find(mark) != std::string_view::npos) return mark;
  }
  return ' ';
}

constexpr const char* kExpected = "'u' and 'psi', or 'length' and 'turn', or 'distance' and 'dturn'";

bool is_known(std::string_view name) {
  return std::find(kColumnNames.begin(), kColumnNames.end(), name) != kColumnNames.end();
}

/// The name without this end; nothing where it has another.
std::optional<std::string_view> stem_of(std::string_view name, std::string_view suffix) {
  if (name.size() <= suffix.size() || name.substr(name.size() - suffix.size()) != suffix) return std::nullopt;
  return name.substr(0, name.size() - suffix.size());
}

/// Whether one of the pairs has a column of this name.
bool says_where(std::string_view name) {
  return std::any_of(kColumnPairs.begin(), kColumnPairs.end(), [&](const ColumnPair& pair) {
    return name == name_of(pair.place) || name == name_of(pair.angle);
  });
}

bool says_where_of_one_of_two(std::string_view name) {
  return std::any_of(kFingerSuffixes.begin(), kFingerSuffixes.end(), [&](const char* suffix) {
    const auto stem = stem_of(name, suffix);
    return stem && says_where(*stem);
  });
}

bool is_of_two(const TableRow& header) {
  return std::none_of(header.cells.begin(), header.cells.end(), says_where) &&
         std::any_of(header.cells.begin(), header.cells.end(), says_where_of_one_of_two);
}

/// The likely typo: a name that is not known but near to one that is missing.
std::string hint(const TableRow& header, const Columns& columns) {
  std::vector<std::string> missing;
  for (std::size_t k = 0; k < kColumnCount; ++k) {
    if (columns.cell[k] == Columns::kNone) missing.push_back(columns.called(static_cast<Column>(k)));
  }
  for (const std::string_view cell : header.cells) {
    if (is_known(cell) || (!columns.suffix.empty() && says_where_of_one_of_two(cell))) continue;
    const std::string nearest = nearest_name(std::string(cell), missing);
    if (!nearest.empty()) return fmt::format("; did you mean '{}' by '{}'?", nearest, shown(cell));
  }
  return "";
}

[[noreturn]] void refuse_header(const TableRow& header, const std::string& log, const Columns& columns) {
  if (!columns.suffix.empty()) {
    const bool is_a = columns.suffix == kFingerSuffixes[0];
    throw InputError(fmt::format(
        "{}: the header '{}' has columns of finger {} but none of finger {}, expected the same of both, such as 'u_a', "
        "'psi_a', 'u_b' and 'psi_b'{}",
        where(log, header.line), shown(header.text), is_a ? 'b' : 'a', is_a ? 'a' : 'b', hint(header, columns)));
  }
  throw InputError(fmt::format(
      "{}: the header '{}' does not say what the columns are, expected {}{} Known are: {}; of two fingers with _a and "
      "_b behind them",
      where(log, header.line), shown(header.text), kExpected, hint(header, columns), fmt::join(kColumnNames, ", ")));
}

/// Which of the pairs the log has: exactly one of them, and whole.
LogKind kind_of(const Columns& columns, const TableRow& header, const std::string& log) {
  const ColumnPair* found = nullptr;
  for (const ColumnPair& pair : kColumnPairs) {
    const bool has_place = columns.has(pair.place);
    if (has_place != columns.has(pair.angle)) {
      throw InputError(fmt::format("{}: the header '{}' has a column '{}' but no '{}', expected both{}",
                                   where(log, header.line), shown(header.text),
                                   columns.called(has_place ? pair.place : pair.angle),
                                   columns.called(has_place ? pair.angle : pair.place), hint(header, columns)));
    }
    if (!has_place) continue;
    if (found != nullptr) {
      throw InputError(fmt::format(
          "{}: the header has '{}' and '{}' as well as '{}' and '{}', expected only one of these pairs; rename the "
          "columns that are not to be used",
          where(log, header.line), columns.called(found->place), columns.called(found->angle),
          columns.called(pair.place), columns.called(pair.angle)));
    }
    found = &pair;
  }
  if (found == nullptr) refuse_header(header, log, columns);
  return static_cast<LogKind>(found - kColumnPairs.data());
}

/// The column that a header's cell names, for a finger whose columns end in this.
std::optional<Column> column_named(std::string_view cell, const std::string& suffix) {
  for (std::size_t k = 0; k < kColumnCount; ++k) {
    const auto column = static_cast<Column>(k);
    const bool is_common = column == Column::time || column == Column::contact;
    if (cell == kColumnNames[k] + suffix && (suffix.empty() || column != Column::time)) return column;
    if (is_common && cell == kColumnNames[k]) return column;
  }
  return std::nullopt;
}

/// The columns of the finger whose columns end in this.
Columns finger_columns(const TableRow& header, const std::string& log, const std::string& suffix) {
  Columns columns;
  columns.count = header.cells.size();
  columns.suffix = suffix;
  for (std::size_t k = 0; k < header.cells.size(); ++k) {
    const auto column = column_named(header.cells[k], suffix);
    if (!column) continue;
    std::size_t& cell = columns.cell[static_cast<std::size_t>(*column)];
    if (cell != Columns::kNone) {
      const std::string_view before = header.cells[cell];
      throw InputError(fmt::format("{}: the column '{}' occurs twice, as number {}{} and {}; rename one of them",
                                   where(log, header.line), shown(header.cells[k]), cell + 1,
                                   before == header.cells[k] ? "" : fmt::format(" ('{}')", shown(before)), k + 1));
    }
    cell = k;
    if (*column == Column::contact) columns.contact_is_shared = header.cells[k] == name_of(Column::contact);
  }
  columns.kind = kind_of(columns, header, log);
  if (columns.has(Column::x) != columns.has(Column::y)) {
    throw InputError(fmt::format("{}: the header has a column '{}' but no '{}', expected both or neither",
                                 where(log, header.line),
                                 columns.called(columns.has(Column::x) ? Column::x : Column::y),
                                 columns.called(columns.has(Column::x) ? Column::y : Column::x)));
  }
  return columns;
}

}  // namespace

std::string_view plain_beginning(std::string_view text, const std::string& name) {
  const std::string_view mark = text.substr(0, 2);
  if (mark == "\xFF\xFE" || mark == "\xFE\xFF") {
    throw InputError(fmt::format("{}: is UTF-16 text, expected plain text; save it as UTF-8", name));
  }
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

LogLines::LogLines(std::FILE* file, std::string name) : name_(std::move(name)), file_(file), buffer_(kLogBuffer, '\0') {
  cursor_ = end_ = buffer_.data();
  refill();
  const auto size = static_cast<std::size_t>(end_ - cursor_);
  cursor_ = plain_beginning({cursor_, size}, name_).data();
}

/// Moves what is left to the front and reads on behind it; false at the end.
bool LogLines::refill() {
  if (file_ == nullptr) return false;
  const auto left = static_cast<std::size_t>(end_ - cursor_);
  std::memmove(buffer_.data(), cursor_, left);
  if (left == buffer_.size()) buffer_.resize(2 * buffer_.size());
  const std::size_t count = std::fread(buffer_.data() + left, 1, buffer_.size() - left, file_);
  if (std::ferror(file_) != 0) throw InputError(fmt::format("{}: can't be read: {}", name_, std::strerror(errno)));
  cursor_ = buffer_.data();
  end_ = cursor_ + left + count;
  return count > 0;
}

bool LogLines::next(std::string_view& line) {
  std::size_t seen = 0;  // of the line, without an end
  while (true) {
    const auto rest = static_cast<std::size_t>(end_ - cursor_);
    const void* const found = rest > seen ? std::memchr(cursor_ + seen, '\n', rest - seen) : nullptr;
    if (found != nullptr) {
      const auto* const newline = static_cast<const char*>(found);
      line = {cursor_, static_cast<std::size_t>(newline - cursor_)};
      cursor_ = newline + 1;
      return true;
    }
    seen = rest;
    if (refill()) continue;
    line = {cursor_, static_cast<std::size_t>(end_ - cursor_)};
    cursor_ = end_;
    return !line.empty();
  }
}

bool TableCutter::cut(std::string_view line, std::size_t number, TableRow& row) {
  const std::string_view bare_line = line.substr(0, line.find('#'));
  const std::string_view data = trimmed(bare_line);
  if (data.empty()) return false;
  if (separator_ == '\0') separator_ = separator_of(data);
  row.line = number;
  row.text = line;
  split(separator_ == '\t' ? bare_line : data, row.cells);
  return true;
}

void TableCutter::split(std::string_view data, std::vector<std::string_view>& cells) const {
  cells.clear();
  while (true) {
    const std::size_t mark = separator_ == ' ' ? data.find_first_of(" \t") : data.find(separator_);
    cells.push_back(bare(data.substr(0, mark)));
    if (mark == std::string_view::npos) return;
    data.remove_prefix(mark + 1);
    if (separator_ == ' ') data = trimmed(data);
  }
}

std::string where(const std::string& name, std::size_t line) { return fmt::format("{}:{}", name, line); }

bool is_data(const TableRow& row) {
  return std::all_of(row.cells.begin(), row.cells.end(),
                     [](std::string_view cell) { return cell.empty() || parse_angle(cell).has_value(); });
}

std::vector<Columns> columns_of(const TableRow& header, const std::string& log) {
  std::vector<Columns> fingers;
  if (!is_of_two(header)) {
    fingers.push_back(finger_columns(header, log, ""));
    return fingers;
  }
  for (const char* suffix : kFingerSuffixes) fingers.push_back(finger_columns(header, log, suffix));
  const Columns& a = fingers[0];
  const Columns& b = fingers[1];
  if (a.kind != b.kind) {
    throw InputError(
        fmt::format("{}: the header '{}' has other columns of finger a than of finger b, expected the same of both",
                    where(log, header.line), shown(header.text)));
  }
  return fingers;
}

Columns bare_columns(const TableRow& row, const std::string& log) {
  if (row.cells.size() != 2) {
    throw InputError(fmt::format(
        "{}: the log starts with '{}', {} numbers without a header: expected a header that names {}, or exactly two "
        "columns, distance and dturn. Known are: {}",
        where(log, row.line), shown(row.text), row.cells.size(), kExpected, fmt::join(kColumnNames, ", ")));
  }
  Columns columns;
  columns.count = 2;
  columns.kind = LogKind::increments;
  columns.cell[static_cast<std::size_t>(Column::distance)] = 0;
  columns.cell[static_cast<std::size_t>(Column::dturn)] = 1;
  return columns;
}

}  // namespace rollfix
