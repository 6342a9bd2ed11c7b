#include "contact/log_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/contact/written_number.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline/names.hpp"

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

std::vector<std::string> known_columns() { return {kColumnNames.begin(), kColumnNames.end()}; }

/// The likely typo: a name that is not known but near to one that is missing.
std::string hint(const TableRow& header, const Columns& columns) {
  std::vector<std::string> missing;
  for (std::size_t k = 0; k < kColumnCount; ++k) {
    if (columns.cell[k] == Columns::kNone) missing.emplace_back(kColumnNames[k]);
  }
  const std::vector<std::string> known = known_columns();
  for (const std::string_view cell : header.cells) {
    const std::string name(cell);
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string nearest = nearest_name(name, missing);
    if (!nearest.empty()) return fmt::format("; did you mean '{}' by '{}'?", nearest, shown(name));
  }
  return "";
}

[[noreturn]] void refuse_header(const TableRow& header, const TableReader& reader, const Columns& columns) {
  const auto has = [&](const char* name) {
    return std::find(header.cells.begin(), header.cells.end(), name) != header.cells.end();
  };
  if (has("u_a") || has("psi_a")) {
    throw InputError(fmt::format("{}: this log is of two fingers, expected one with columns 'u' and 'psi'",
                                 reader.where(header.line)));
  }
  throw InputError(fmt::format("{}: the header '{}' does not say what the columns are, expected {}{} Known are: {}",
                               reader.where(header.line), shown(header.text), kExpected, hint(header, columns),
                               fmt::join(kColumnNames, ", ")));
}

/// Which of the pairs the log has: exactly one of them, and whole.
LogKind kind_of(const Columns& columns, const TableRow& header, const TableReader& reader) {
  const Pair* found = nullptr;
  for (const Pair& pair : kPairs) {
    const bool has_first = columns.has(pair.first);
    const bool has_second = columns.has(pair.second);
    if (has_first != has_second) {
      throw InputError(fmt::format("{}: the header '{}' has a column '{}' but no '{}', expected both{}",
                                   reader.where(header.line), shown(header.text),
                                   name_of(has_first ? pair.first : pair.second),
                                   name_of(has_first ? pair.second : pair.first), hint(header, columns)));
    }
    if (!has_first) continue;
    if (found != nullptr) {
      throw InputError(fmt::format(
          "{}: the header has '{}' and '{}' as well as '{}' and '{}', expected only one of these pairs; rename the "
          "columns that are not to be used",
          reader.where(header.line), name_of(found->first), name_of(found->second), name_of(pair.first),
          name_of(pair.second)));
    }
    found = &pair;
  }
  if (found == nullptr) refuse_header(header, reader, columns);
  return found->kind;
}

}  // namespace

bool is_data(const TableRow& row) {
  return std::all_of(row.cells.begin(), row.cells.end(),
                     [](std::string_view cell) { return cell.empty() || parse_angle(cell).has_value(); });
}

Columns columns_of(const TableRow& header, const TableReader& reader) {
  Columns columns;
  columns.count = header.cells.size();
  for (std::size_t k = 0; k < header.cells.size(); ++k) {
    const auto* const name = std::find(kColumnNames.begin(), kColumnNames.end(), header.cells[k]);
    if (name == kColumnNames.end()) continue;
    std::size_t& cell = columns.cell[static_cast<std::size_t>(name - kColumnNames.begin())];
    if (cell != Columns::kNone) {
      throw InputError(fmt::format("{}: the column '{}' occurs twice, as number {} and {}; rename one of them",
                                   reader.where(header.line), *name, cell + 1, k + 1));
    }
    cell = k;
  }
  columns.kind = kind_of(columns, header, reader);
  if (columns.has(Column::x) != columns.has(Column::y)) {
    throw InputError(fmt::format("{}: the header has a column '{}' but no '{}', expected both or neither",
                                 reader.where(header.line), columns.has(Column::x) ? "x" : "y",
                                 columns.has(Column::x) ? "y" : "x"));
  }
  return columns;
}

Columns bare_columns(const TableRow& row, const TableReader& reader) {
  if (row.cells.size() != 2) {
    throw InputError(fmt::format(
        "{}: the log starts with '{}', {} numbers without a header: expected a header that names {}, or exactly two "
        "columns, distance and dturn. Known are: {}",
        reader.where(row.line), shown(row.text), row.cells.size(), kExpected, fmt::join(kColumnNames, ", ")));
  }
  Columns columns;
  columns.count = 2;
  columns.kind = LogKind::increments;
  columns.cell[static_cast<std::size_t>(Column::distance)] = 0;
  columns.cell[static_cast<std::size_t>(Column::dturn)] = 1;
  return columns;
}

}  // namespace rollfix
