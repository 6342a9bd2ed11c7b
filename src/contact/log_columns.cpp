#include "contact/log_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/contact/written_number.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix {

namespace {

struct Pair {
  Column first;
  Column second;
  LogKind kind;
};
constexpr std::array<Pair, 3> kPairs = {{{Column::u, Column::psi, LogKind::contact},
                                         {Column::length, Column::turn, LogKind::travelled},
                                         {Column::distance, Column::dturn, LogKind::increments}}};
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
  return std::any_of(kPairs.begin(), kPairs.end(),
                     [&](const Pair& pair) { return name == name_of(pair.first) || name == name_of(pair.second); });
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
  const Pair* found = nullptr;
  for (const Pair& pair : kPairs) {
    const bool has_first = columns.has(pair.first);
    const bool has_second = columns.has(pair.second);
    if (has_first != has_second) {
      throw InputError(fmt::format("{}: the header '{}' has a column '{}' but no '{}', expected both{}",
                                   where(log, header.line), shown(header.text),
                                   columns.called(has_first ? pair.first : pair.second),
                                   columns.called(has_first ? pair.second : pair.first), hint(header, columns)));
    }
    if (!has_first) continue;
    if (found != nullptr) {
      throw InputError(fmt::format(
          "{}: the header has '{}' and '{}' as well as '{}' and '{}', expected only one of these pairs; rename the "
          "columns that are not to be used",
          where(log, header.line), columns.called(found->first), columns.called(found->second),
          columns.called(pair.first), columns.called(pair.second)));
    }
    found = &pair;
  }
  if (found == nullptr) refuse_header(header, log, columns);
  return found->kind;
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
