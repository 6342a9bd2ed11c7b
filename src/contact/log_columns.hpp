#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "contact/log_table.hpp"
#include "rollfix/contact/log.hpp"

namespace rollfix {

/// The columns that a finger's log may have.
enum class Column : std::size_t { time, u, psi, x, y, contact, length, turn, distance, dturn };
inline constexpr std::size_t kColumnCount = 10;
inline constexpr std::array<const char*, kColumnCount> kColumnNames = {
    "time", "u", "psi", "x", "y", "contact", "length", "turn", "distance", "dturn"};

/// What stands behind the names of two fingers' columns: u_a, u_b. The time is common to both.
inline constexpr std::array<const char*, 2> kFingerSuffixes = {"_a", "_b"};

inline const char* name_of(Column column) { return kColumnNames[static_cast<std::size_t>(column)]; }
inline bool is_angle(Column column) {
  return column == Column::u || column == Column::psi || column == Column::turn || column == Column::dturn;
}

/// Which cell of a row holds which column of one finger.
struct Columns {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  std::array<std::size_t, kColumnCount> cell;  // kNone: the log does not have it
  std::size_t count = 0;                       // cells of a row
  LogKind kind = LogKind::contact;
  std::string suffix;              // of the finger's columns
  bool contact_is_shared = false;  // one column `contact` for both fingers

  Columns() { cell.fill(kNone); }
  bool has(Column column) const { return (*this)[column] != kNone; }
  std::size_t operator[](Column column) const { return cell[static_cast<std::size_t>(column)]; }
  /// The column's name in the header.
  std::string called(Column column) const {
    const bool is_common = column == Column::time || (column == Column::contact && contact_is_shared);
    return is_common ? name_of(column) : name_of(column) + suffix;
  }
};

/// Whether the row consists of numbers only: a log without a header.
bool is_data(const TableRow& row);

/// The columns of a log with this header, of one finger or of two. Throws InputError: no known column, half of a pair,
/// two kinds of log at once, only one of two fingers, or the same column twice. `log`: its name, for messages.
std::vector<Columns> columns_of(const TableRow& header, const std::string& log);

/// The columns of a log without a header. Throws InputError unless there are two.
Columns bare_columns(const TableRow& row, const std::string& log);

}  // namespace rollfix
