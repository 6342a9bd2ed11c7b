#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "log/header/log_header.hpp"
#include "log/log_table.hpp"
#include "rollfix/touch.hpp"
#include "rollfix/units.hpp"

namespace rollfix::touch {

/// In the order of kTouchColumns.
enum class TouchColumn : std::size_t { x, y, normal, position_sd, normal_sd, contact };
inline constexpr std::size_t kTouchColumnCount = 6;
inline constexpr std::array<const char*, kTouchColumnCount> kTouchColumns = {"x",           "y",         "normal",
                                                                             "position_sd", "normal_sd", "contact"};

inline const char* name_of(TouchColumn column) { return kTouchColumns[static_cast<std::size_t>(column)]; }
/// Else it is a length, or `contact`, which has no unit.
inline bool is_of_angle(TouchColumn column) {
  return column == TouchColumn::normal || column == TouchColumn::normal_sd;
}
inline Dimension dimension_of(TouchColumn column) { return is_of_angle(column) ? Dimension::angle : Dimension::length; }

/// What a name in a header, or in `columns`, stands for.
struct KnownColumn {
  TouchColumn column = TouchColumn::x;
  std::string unit{};  // of the header: "x [mm]", "x_mm"; empty: it names none
};
/// None: no column of touches has this name.
std::optional<KnownColumn> touch_column(const HeaderName& header);

/// Which cell of a row holds which column, and in what.
class TouchHeader {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Throws InputError: no x or y, a column twice, one of `columns` that is not there, a unit that is not the column's.
  TouchHeader(const TableRow& row, const std::string& name, const TouchTableOptions& options);

  /// Of cells in the header.
  std::size_t count() const { return count_; }
  bool has(TouchColumn column) const { return cell(column) != kNone; }
  /// kNone: the table does not have it.
  std::size_t cell(TouchColumn column) const { return cell_[static_cast<std::size_t>(column)]; }
  /// To the part's unit, or to radians.
  const Conversion& conversion(TouchColumn column) const { return conversion_[static_cast<std::size_t>(column)]; }
  /// The names of columns that are not used.
  const std::vector<std::string>& ignored() const { return ignored_; }

 private:
  // The steps of the constructor; `set` throws, as it does.
  void add_named(const std::vector<HeaderName>& names, const TouchTableOptions& options);
  void add_known(const std::vector<HeaderName>& names, const std::string& part_unit);
  void set(TouchColumn column, std::size_t cell, const std::string& unit, const std::string& part_unit);
  std::size_t find(const std::vector<HeaderName>& names, const ColumnSource& source) const;

  std::string start_;  // of messages
  std::size_t count_ = 0;
  std::array<std::size_t, kTouchColumnCount> cell_{};
  std::array<Conversion, kTouchColumnCount> conversion_{};
  std::vector<std::string> ignored_;
};

}  // namespace rollfix::touch
