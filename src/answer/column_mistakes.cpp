#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "outline/turn.hpp"
#include "steps.hpp"

// Mistakes in how the columns of a log are read: units, signs, names.
// Notation:
//   column          what Rollfix needs, "u", "psi", "turn" ...; `name` what the header calls it, `unit` what was stated
//   mend            undoes the mistake in the rows that were read: angles times pi / 180, other signs, a swap
//   stretch         log of the factor by which mending multiplies the numbers of a row: `log_stretch`
// Follows docs/belief.md, "What may be wrong".
// Idea: each mistake is a function of the rows, which the diagnosis applies before it weighs them, and a change of the
// column's unit or name, which is what the user is to type.
namespace rollfix::answer {
namespace {

constexpr std::string_view kDegrees = "deg";

/// Without what stands behind it of two fingers: "u" of u_a.
std::string_view base_of(const ColumnSource& source) {
  const std::string_view column = source.column;
  return column.substr(0, column.find('_'));
}

/// Whether this cause is that the column is in degrees and was read as radians.
bool is_in_degrees(std::string_view column, Cause cause) {
  if (column == "u") return cause == Cause::u_degrees || cause == Cause::angles_degrees;
  if (column == "psi") return cause == Cause::psi_degrees || cause == Cause::angles_degrees;
  return cause == Cause::turn_degrees && (column == "turn" || column == "dturn");
}

/// Whether this cause is that the column is in radians and was read as degrees.
bool is_in_radians(std::string_view column, Cause cause) {
  if (column == "u") return cause == Cause::u_radians || cause == Cause::angles_radians;
  if (column == "psi") return cause == Cause::psi_radians || cause == Cause::angles_radians;
  return cause == Cause::turn_radians && (column == "turn" || column == "dturn");
}

/// "deg:unwrapped" with another unit before what it says of whole turns.
std::string with_unit(const std::string& unit, const char* now) {
  return unit.starts_with(kDegrees) ? now + unit.substr(kDegrees.size()) : now;
}

/// How a column is to be read if that is the mistake; the same as it is where the cause is another column's.
ColumnSource without(Cause cause, const ColumnSource& source, const FingerRows& rows) {
  ColumnSource mended = source;
  const std::string_view column = base_of(source);
  if (is_in_degrees(column, cause)) mended.unit = "deg";
  if (is_in_radians(column, cause)) mended.unit = with_unit(source.unit, "rad");
  if (cause != Cause::u_psi_swapped || (column != "u" && column != "psi")) return mended;
  const std::string_view other = column == "u" ? "psi" : "u";
  // A log of contacts has both columns, so that the other one is found.
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

/// Columns of both fingers are stated once, by their common name.
std::vector<ColumnSource> columns_without(Cause cause, const Log& log) {
  std::vector<ColumnSource> columns;
  bool any_changes = false;
  for (const FingerRows& rows : log.fingers) {
    for (const ColumnSource& source : rows.columns) {
      const ColumnSource mended = without(cause, source, rows);
      const bool changes = mended.name != source.name || mended.unit != source.unit;
      // A column that has its own name and no unit needs no mention.
      const bool is_found_anyway = !changes && source.name == source.column && source.unit.empty();
      const bool is_known = std::any_of(columns.begin(), columns.end(),
                                        [&](const ColumnSource& one) { return one.column == mended.column; });
      any_changes = any_changes || changes;
      // Columns that are read right are listed as well, so that the option can be pasted as it is.
      if (!is_found_anyway && !is_known) columns.push_back(mended);
    }
  }
  return any_changes ? columns : std::vector<ColumnSource>{};
}

namespace {

/// `power`: 1 for degrees that were taken for radians, -1 for radians that were taken for degrees.
ColumnMistake in_other_angles(Cause cause, int power, const std::vector<RowColumn>& columns) {
  // What the numbers have to be multiplied by.
  const double factor = power > 0 ? kDegree : 1 / kDegree;
  const auto mend = [factor, columns](FingerRows& rows) { multiply(rows, columns, factor); };
  return {cause, mend, static_cast<double>(columns.size()) * std::log(factor)};
}

/// Degrees that were read as radians. Mending shortens the roll 57 times: `left_of_roll` is what is left, the largest
/// range of any of the columns.
ColumnMistake in_degrees(Cause cause, const std::vector<RowColumn>& columns, const std::vector<FingerRows>& fingers) {
  ColumnMistake mistake = in_other_angles(cause, 1, columns);
  // Readings: nothing says how far the columns go.
  if (fingers.empty()) return mistake;
  mistake.left_of_roll = 0;
  for (const FingerRows& rows : fingers) {
    for (const RowColumn column : columns) {
      mistake.left_of_roll = std::max(mistake.left_of_roll, kDegree * range_of(rows.*column));
    }
  }
  return mistake;
}
/// Radians that were read as degrees.
ColumnMistake in_radians(Cause cause, const std::vector<RowColumn>& columns) {
  return in_other_angles(cause, -1, columns);
}

/// Other signs; the density of the numbers stays.
ColumnMistake the_other_way(Cause cause, const std::vector<RowColumn>& columns) {
  return {cause, [columns](FingerRows& rows) { multiply(rows, columns, -1); }};
}

/// The mistakes in a log of u and psi, the more common ones first. Radians are only tried where degrees were stated.
std::vector<ColumnMistake> mistakes_in_contacts(const std::vector<FingerRows>& fingers) {
  constexpr RowColumn u = &FingerRows::u;
  constexpr RowColumn psi = &FingerRows::psi;
  std::vector<ColumnMistake> mistakes = {{Cause::u_psi_swapped, swap_u_and_psi},
                                         the_other_way(Cause::both_clockwise, {u, psi}),
                                         the_other_way(Cause::u_clockwise, {u}),
                                         the_other_way(Cause::psi_clockwise, {psi}),
                                         in_degrees(Cause::u_degrees, {u}, fingers),
                                         in_degrees(Cause::psi_degrees, {psi}, fingers),
                                         in_degrees(Cause::angles_degrees, {u, psi}, fingers)};
  const bool u_may_be = says_degrees(fingers, "u");
  const bool psi_may_be = says_degrees(fingers, "psi");
  if (u_may_be) mistakes.push_back(in_radians(Cause::u_radians, {u}));
  if (psi_may_be) mistakes.push_back(in_radians(Cause::psi_radians, {psi}));
  if (u_may_be && psi_may_be) mistakes.push_back(in_radians(Cause::angles_radians, {u, psi}));
  return mistakes;
}

/// The mistakes in lengths and turns, of a log or of readings.
std::vector<ColumnMistake> mistakes_in_courses(const std::vector<FingerRows>& fingers) {
  constexpr RowColumn length = &FingerRows::length;
  constexpr RowColumn turn = &FingerRows::turn;
  std::vector<ColumnMistake> mistakes = {
      the_other_way(Cause::both_clockwise, {length, turn}), the_other_way(Cause::length_backwards, {length}),
      the_other_way(Cause::turn_clockwise, {turn}), in_degrees(Cause::turn_degrees, {turn}, fingers)};
  if (says_degrees(fingers, "turn") || says_degrees(fingers, "dturn")) {
    mistakes.push_back(in_radians(Cause::turn_radians, {turn}));
  }
  return mistakes;
}

/// A reading as one row: so the same function mends logs and readings.
void mend(const ColumnMistake& mistake, Reading& reading) {
  FingerRows rows;
  rows.length = {reading.length.begin(), reading.length.end()};
  rows.turn = {reading.turn};
  mistake.mend(rows);
  std::copy(rows.length.begin(), rows.length.end(), reading.length.begin());
  reading.turn = rows.turn.front();
}

}  // namespace

std::vector<ColumnMistake> column_mistakes(const Measurement& measured) {
  if (!measured.is_log()) return mistakes_in_courses({});
  return measured.log->kind == LogKind::contact ? mistakes_in_contacts(measured.log->fingers)
                                                : mistakes_in_courses(measured.log->fingers);
}

/// A copy with all rows, or all readings, mended.
Problem without(const ColumnMistake& mistake, const Problem& problem) {
  Problem mended = problem;
  if (mended.measured.is_log()) {
    for (FingerRows& rows : mended.measured.log->fingers) mistake.mend(rows);
  } else {
    for (Reading& reading : mended.measured.readings) mend(mistake, reading);
  }
  return mended;
}

}  // namespace rollfix::answer

namespace rollfix {

void multiply(FingerRows& rows, const std::vector<RowColumn>& columns, double factor) {
  for (const RowColumn column : columns) {
    for (double& value : rows.*column) value *= factor;
  }
}

void swap_u_and_psi(FingerRows& rows) {
  std::swap(rows.u, rows.psi);
  std::swap(rows.place_rounding, rows.angle_rounding);
}

double range_of(const std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least;
}

}  // namespace rollfix
