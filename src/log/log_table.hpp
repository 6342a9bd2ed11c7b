#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "rollfix/log.hpp"
#include "text/table.hpp"
#include "text/units.hpp"

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

/// The columns that say how far a finger has rolled and how it is turned, by LogKind.
struct ColumnPair {
  Column place;
  Column angle;
};
inline constexpr std::array<ColumnPair, 3> kColumnPairs = {
    {{Column::u, Column::psi}, {Column::length, Column::turn}, {Column::distance, Column::dturn}}};

/// Which cell of a row holds which column of one finger.
struct Columns {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  std::array<std::size_t, kColumnCount> cell;       // kNone: the log does not have it
  std::array<Conversion, kColumnCount> conversion;  // of its numbers to radians, seconds, the part's unit
  std::array<ColumnSource, kColumnCount> source{};  // as the header has it; without a header names are empty
  std::size_t count = 0;                            // cells of a row
  LogKind kind = LogKind::contact;
  bool of_pin = false;                     // of a wheel without skin: x and y, and psi where it has an encoder
  std::string suffix;                      // of the finger's columns
  bool contact_is_shared = false;          // one column `contact` for both fingers
  std::optional<Dimension> u_dimension{};  // where the log says what u is in
  std::optional<bool> u_wrapped{};         // where somebody said whether it jumps back after a full turn
  std::optional<bool> psi_wrapped{};       // the same of psi
  std::string note{};                      // what else the header has that may have been meant

  Columns() { cell.fill(kNone); }
  bool has(Column column) const { return (*this)[column] != kNone; }
  std::size_t operator[](Column column) const { return cell[static_cast<std::size_t>(column)]; }
  const Conversion& conversion_of(Column column) const { return conversion[static_cast<std::size_t>(column)]; }
  /// The column's name in the header.
  std::string called(Column column) const {
    const bool is_common = column == Column::time || (column == Column::contact && contact_is_shared);
    return is_common ? name_of(column) : name_of(column) + suffix;
  }
};

/// Whether the row consists of numbers only: a log without a header.
bool is_data(const TableRow& row);

}  // namespace rollfix
