#include "column_cure.hpp"

#include <algorithm>
#include <string_view>

namespace rollfix {
namespace {

constexpr std::string_view kDegrees = "deg";

/// Without what stands behind it of two fingers: "u" of u_a.
std::string_view base_of(const ColumnSource& source) {
  const std::string_view column = source.column;
  return column.substr(0, column.find('_'));
}

bool is_in_degrees(std::string_view column, Cause cause) {
  if (column == "u") return cause == Cause::u_degrees || cause == Cause::angles_degrees;
  if (column == "psi") return cause == Cause::psi_degrees || cause == Cause::angles_degrees;
  return cause == Cause::turn_degrees && (column == "turn" || column == "dturn");
}

bool is_in_radians(std::string_view column, Cause cause) {
  if (column == "u") return cause == Cause::u_radians || cause == Cause::angles_radians;
  if (column == "psi") return cause == Cause::psi_radians || cause == Cause::angles_radians;
  return cause == Cause::turn_radians && (column == "turn" || column == "dturn");
}

/// "deg:unwrapped" with another unit before what it says of whole turns.
std::string with_unit(const std::string& unit, const char* now) {
  return unit.starts_with(kDegrees) ? now + unit.substr(kDegrees.size()) : now;
}

ColumnSource without(Cause cause, const ColumnSource& source, const FingerRows& rows) {
  ColumnSource mended = source;
  const std::string_view column = base_of(source);
  if (is_in_degrees(column, cause)) mended.unit = "deg";
  if (is_in_radians(column, cause)) mended.unit = with_unit(source.unit, "rad");
  if (cause != Cause::u_psi_swapped || (column != "u" && column != "psi")) return mended;
  const std::string_view other = column == "u" ? "psi" : "u";
  const auto found = std::find_if(rows.columns.begin(), rows.columns.end(),
                                  [&](const ColumnSource& one) { return base_of(one) == other; });
  mended.name = found->name;
  mended.unit = found->unit;
  return mended;
}

}  // namespace

bool says_degrees(const std::vector<FingerRows>& fingers, std::string_view column) {
  const auto is_said = [&](const ColumnSource& source) {
    return base_of(source) == column && source.unit.starts_with(kDegrees);
  };
  return std::any_of(fingers.begin(), fingers.end(), [&](const FingerRows& rows) {
    return std::any_of(rows.columns.begin(), rows.columns.end(), is_said);
  });
}

std::vector<ColumnSource> columns_without(Cause cause, const Log& log) {
  std::vector<ColumnSource> columns;
  bool any_changes = false;
  for (const FingerRows& rows : log.fingers) {
    for (const ColumnSource& source : rows.columns) {
      const ColumnSource mended = without(cause, source, rows);
      const bool changes = mended.name != source.name || mended.unit != source.unit;
      const bool is_found_anyway = !changes && source.name == source.column && source.unit.empty();
      const bool is_known = std::any_of(columns.begin(), columns.end(),
                                        [&](const ColumnSource& one) { return one.column == mended.column; });
      any_changes = any_changes || changes;
      if (!is_found_anyway && !is_known) columns.push_back(mended);
    }
  }
  return any_changes ? columns : std::vector<ColumnSource>{};
}

}  // namespace rollfix
