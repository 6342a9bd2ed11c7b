#include "rollfix/touch.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "log/header/log_header.hpp"
#include "log/log_table.hpp"
#include "rollfix/error.hpp"
#include "rollfix/units.hpp"
#include "text/number.hpp"
#include "text/text.hpp"
#include "touch_header.hpp"

// Notation:
//   x, y, normal     of a touch: MeasuredTouch; what is empty was not measured, NaN or none
//   contact          1: a touch, 0: a place on a way that was free; without the column all rows are touches
//   report           what a milling controller writes of its probe: ProbeReport
//   clear            straight ways from a row with contact 0 to the row after it
// Follows docs/touch.md, "What to give".
// Idea: a text is first looked at for a probe's report, which has no header. Else its first row is the header, which
// says which cell is what and in which unit (touch_header.hpp); below it each row is a touch or a free place.
namespace rollfix::touch {
namespace {

/// How a milling controller reports where its probe has touched.
enum class ProbeReport {
  grbl,       // lines "[PRB:12.300,4.500,-1.000:1]" among others; 1: it touched, 0: it did not
  linux_cnc,  // rows "x y z a b c u v w", between PROBEOPEN and PROBECLOSE
};

constexpr std::string_view kGrblStart = "[PRB:";
// x y z a b c u v w.
constexpr std::size_t kLinuxCncNumbers = 9;

/// Where a report of GRBL begins, in capitals or not, as senders that log in small letters write it.
std::size_t grbl_start(std::string_view text) {
  const auto alike = [](char one, char other) { return std::toupper(static_cast<unsigned char>(one)) == other; };
  const auto at = std::search(text.begin(), text.end(), kGrblStart.begin(), kGrblStart.end(), alike);
  return at == text.end() ? std::string_view::npos : static_cast<std::size_t>(at - text.begin());
}

/// Whether it is a row of that many plain numbers, with blanks between.
bool is_linux_cnc_row(std::string_view line) {
  std::size_t count = 0;
  for (std::string_view rest = trimmed(line); !rest.empty(); ++count) {
    const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
    if (!parse_number(rest.substr(0, end))) return false;
    rest = trimmed(rest.substr(end));
  }
  return count == kLinuxCncNumbers;
}

/// Throws InputError; `place`: file and line.
double finite_number(std::string_view text, const char* column, const std::string& place) {
  const std::optional<double> value = parse_number(trimmed(text));
  if (value && std::isfinite(*value)) return *value;
  throw InputError(fmt::format("{}: {}: expected a number, found '{}'", place, column, shown(text)));
}

/// The place in "[PRB:x,y,z:1]"; none where the probe did not touch.
std::optional<Vec2> grbl_place(std::string_view line, const std::string& place) {
  const std::string_view report = line.substr(grbl_start(line));
  const std::size_t end = report.find(']');
  const std::size_t colon = report.find(':', kGrblStart.size());
  // The flag stands between the colon and the closing bracket.
  const std::string_view flag = colon < end ? trimmed(report.substr(colon + 1, end - colon - 1)) : std::string_view();
  std::vector<std::string_view> numbers;
  if (flag == "0" || flag == "1") {
    numbers = split(report.substr(kGrblStart.size(), colon - kGrblStart.size()), ',');
  }
  if (end == std::string_view::npos || numbers.size() < 2) {
    throw InputError(fmt::format("{}: expected a probe's report, as in [PRB:12.300,4.500,-1.000:1], found '{}'", place,
                                 shown(report)));
  }
  const Vec2 at(finite_number(numbers[0], "x", place), finite_number(numbers[1], "y", place));
  return flag == "1" ? std::optional<Vec2>(at) : std::nullopt;
}

/// Reports among any other lines of a console. Coordinates are millimetres if the part's unit is known, else taken as
/// they are.
TouchTable parse_grbl(std::string_view text, const std::string& name, const TouchTableOptions& options) {
  const bool knows_unit = !options.unit.empty();
  const Conversion own = knows_unit ? length_conversion("mm", options.unit, name) : Conversion{};
  TouchTable table;
  std::size_t missed = 0;
  LogLines lines(text, name);
  std::string_view line;
  for (std::size_t number = 1; lines.next(line); ++number) {
    if (grbl_start(line) == std::string_view::npos) continue;
    const std::optional<Vec2> at = grbl_place(line, where(name, number));
    if (!at) {
      ++missed;
      continue;
    }
    table.touches.push_back({{own(at->x()), own(at->y())}});
    table.lines.push_back(number);
  }
  // What was taken for granted is told: the unit, and that z does not count.
  table.notes.push_back(fmt::format("{}: GRBL's probe reports, {}: machine coordinates, taken as {}; z is not used",
                                    name, counted(table.touches.size(), "touch", "touches"),
                                    knows_unit ? "mm, which they are unless $13=1" : "in the part's unit"));
  if (missed > 0) {
    table.notes.push_back(
        fmt::format("{}: {} left out: the probe did not touch (:0)", name, counted(missed, "report", "reports")));
  }
  return table;
}

/// All rows have nine numbers; x and y are in the machine's unit, which is taken as the part's.
TouchTable parse_linux_cnc(std::string_view text, const std::string& name) {
  TouchTable table;
  LogLines lines(text, name);
  TableCutter cutter(false);
  std::string_view line;
  TableRow row;
  for (std::size_t number = 1; lines.next(line); ++number) {
    if (!cutter.cut(line, number, row)) continue;
    if (row.cells.size() != kLinuxCncNumbers) {
      throw InputError(fmt::format("{}: expected {} numbers as in the rows above, found {}", where(name, number),
                                   kLinuxCncNumbers, row.cells.size()));
    }
    const std::string place = where(name, number);
    table.touches.push_back({{finite_number(row.cells[0], "x", place), finite_number(row.cells[1], "y", place)}});
    table.lines.push_back(number);
  }
  table.notes.push_back(
      fmt::format("{}: nine numbers in a row, as LinuxCNC's PROBEOPEN writes them: x and y are the first two", name));
  return table;
}

/// What of it a text is; none: something else.
/// GRBL by a report anywhere, LinuxCNC by the first row that is no comment.
std::optional<ProbeReport> probe_report(std::string_view text) {
  if (grbl_start(text) != std::string_view::npos) return ProbeReport::grbl;
  LogLines lines(text, "");
  std::string_view line;
  while (lines.next(line)) {
    const std::string_view data = trimmed(line.substr(0, line.find('#')));
    if (!data.empty()) return is_linux_cnc_row(data) ? std::optional(ProbeReport::linux_cnc) : std::nullopt;
  }
  return std::nullopt;
}

/// A touch for each place. Throws InputError, naming the line.
TouchTable parse_probe_report(ProbeReport report, std::string_view text, const std::string& name,
                              const TouchTableOptions& options) {
  if (!options.columns.empty()) {
    throw InputError(fmt::format("{}: is a probe's report, which has no header; leave `columns` out", name));
  }
  TouchTable table = report == ProbeReport::grbl ? parse_grbl(text, name, options) : parse_linux_cnc(text, name);
  if (!table.touches.empty() || options.may_be_empty) return table;
  throw InputError(fmt::format("{}: expected a touch, found only reports of a probe that did not touch (:0)", name));
}

}  // namespace

}  // namespace rollfix::touch

namespace rollfix {

namespace touch {
namespace {

/// Calls `row` with each row of the table.
template <class Row>
void each_row(std::string_view text, const std::string& name, std::optional<bool> decimal_comma, const Row& row) {
  LogLines lines(text, name);
  TableCutter cutter(decimal_comma);
  std::string_view line;
  TableRow cut;
  for (std::size_t number = 1; lines.next(line); ++number) {
    // `row` says whether it wants more.
    if (cutter.cut(line, number, cut) && !row(cut)) return;
  }
}

/// Reads rows below a header.
class TouchReader {
 public:
  /// `row`: the header. `name` outlives this.
  TouchReader(const TableRow& row, const std::string& name, const TouchTableOptions& options)
      : header_(row, name, options), name_(name) {}

  const TouchHeader& header() const { return header_; }

  /// Throws InputError where the row has not as many cells as the header.
  void require_whole(const TableRow& row) const {
    if (row.cells.size() == header_.count()) return;
    throw InputError(fmt::format("{}: expected {} as in the header, found {}", where(name_, row.line),
                                 counted(header_.count(), "cell", "cells"), row.cells.size()));
  }

  /// A place that was not measured is NaN.
  MeasuredTouch read(const TableRow& row) const {
    MeasuredTouch touch;
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    touch.at = {number(row, TouchColumn::x).value_or(kUnknown), number(row, TouchColumn::y).value_or(kUnknown)};
    touch.normal = number(row, TouchColumn::normal);
    touch.position_sd = number(row, TouchColumn::position_sd);
    touch.normal_sd = number(row, TouchColumn::normal_sd);
    if (!touch.has_place()) require_normal_alone(row, touch);
    return touch;
  }

  /// Without the column each row is a touch.
  bool has_contact(const TableRow& row) const {
    if (!header_.has(TouchColumn::contact)) return true;
    const std::string_view cell = row.cells[header_.cell(TouchColumn::contact)];
    const std::optional<double> value = parse_number(cell);
    if (value == 0.0 || value == 1.0) return value == 1.0;
    throw InputError(
        fmt::format("{}: column contact: expected 0 or 1, found '{}'", where(name_, row.line), shown(cell)));
  }

 private:
  /// Without a place only a measured normal of a touch says something; half a place says nothing.
  void require_normal_alone(const TableRow& row, const MeasuredTouch& touch) const {
    const bool is_half = !std::isnan(touch.at.x()) || !std::isnan(touch.at.y());
    if (!is_half && touch.normal && has_contact(row)) return;
    throw InputError(fmt::format("{}: column {}: expected a number, found ''{}", where(name_, row.line),
                                 touch::name_of(std::isnan(touch.at.x()) ? TouchColumn::x : TouchColumn::y),
                                 is_half ? "" : "; a touch whose normal alone was measured has a normal"));
  }

  /// None: no such column, or an empty cell. Bare numbers are in the header's unit, an angle with its own unit is in
  /// radians already.
  std::optional<double> number(const TableRow& row, TouchColumn column) const {
    if (!header_.has(column)) return std::nullopt;
    const std::string_view cell = row.cells[header_.cell(column)];
    if (cell.empty()) return std::nullopt;
    const std::optional<double> plain = parse_number(cell);
    const std::optional<double> value = plain || !is_of_angle(column) ? plain : parse_angle(cell);
    if (!value || !std::isfinite(*value)) {
      throw InputError(fmt::format("{}: column {}: expected a number, found '{}'{}", where(name_, row.line),
                                   touch::name_of(column), shown(cell), decimal_comma_hint(cell)));
    }
    return plain ? header_.conversion(column)(*value) : *value;
  }

  TouchHeader header_;
  const std::string& name_;
};

/// Whether a name stands for what only a roll has; of two fingers with _a or _b behind it.
bool is_of_roll(std::string name) {
  for (const char* suffix : kFingerSuffixes) {
    if (name.size() > 2 && name.ends_with(suffix)) name.resize(name.size() - 2);
  }
  const auto same = [&](const ColumnPair& pair) {
    return name == rollfix::name_of(pair.place) || name == rollfix::name_of(pair.angle);
  };
  return std::any_of(kColumnPairs.begin(), kColumnPairs.end(), same);
}

/// Whether a header is one of touches; `columns`: what the options say of it.
/// x and y, and nothing of a roll. An unknown name that sounds like a roll's is let pass where the options name
/// columns, or where a column of touches alone is there.
bool is_touch_header(const TableRow& row, const std::vector<ColumnSource>& columns) {
  const auto is_said = [&](const char* name) {
    return std::any_of(columns.begin(), columns.end(), [&](const ColumnSource& one) { return one.column == name; });
  };
  bool has_x = is_said("x"), has_y = is_said("y"), has_roll = false, has_more = !columns.empty();
  std::vector<HeaderName> unknown;
  for (const HeaderName& header : names_in(row)) {
    const std::optional<KnownColumn> known = touch_column(header);
    has_x = has_x || (known && known->column == TouchColumn::x);
    has_y = has_y || (known && known->column == TouchColumn::y);
    has_roll = has_roll || is_of_roll(lower_case(header.name));
    // normal, position_sd and normal_sd: a log of a roll has none of them.
    has_more = has_more || (known && known->column >= TouchColumn::normal && known->column != TouchColumn::contact);
    if (!known && lower_case(header.name) != rollfix::name_of(rollfix::Column::time)) unknown.push_back(header);
  }
  const bool may_be_of_roll = holds_columns_of(unknown, 0) || holds_columns_of(unknown, 1);
  return has_x && has_y && !has_roll && (has_more || !may_be_of_roll);
}

/// Which columns were not used, and how many rows are free space.
void add_notes(TouchTable& table, const TouchHeader& header, std::size_t free_rows, const std::string& name) {
  const std::vector<std::string>& ignored = header.ignored();
  if (!ignored.empty()) {
    table.notes.push_back(fmt::format("{}: {} not used: {}; known are {}", name,
                                      ignored.size() == 1 ? "this column is" : "these columns are",
                                      fmt::join(ignored, ", "), fmt::join(kTouchColumns, ", ")));
  }
  if (free_rows == 0) return;
  table.notes.push_back(fmt::format("{}: {} with contact 0 {}; `clear` rows takes {} as free space", name,
                                    counted(free_rows, "row", "rows"),
                                    free_rows == 1 ? "is no touch" : "are no touches", free_rows == 1 ? "it" : "them"));
}

}  // namespace
}  // namespace touch

bool is_touch_table(std::string_view text, const TouchTableOptions& options) {
  bool is_one = false;
  try {
    if (touch::probe_report(text)) return true;
    touch::each_row(text, "", options.decimal_comma, [&](const TableRow& row) {
      is_one = touch::is_touch_header(row, options.columns);
      return false;  // the header is enough
    });
  } catch (const InputError&) {
    return false;  // it is no table at all: whoever reads it says so
  }
  return is_one;
}

TouchTable parse_touches(std::string_view text, const std::string& name, const TouchTableOptions& options) {
  if (const auto report = touch::probe_report(text)) {
    return touch::parse_probe_report(*report, text, name, options);
  }
  TouchTable table;
  std::optional<std::string> header_text;
  std::optional<touch::TouchReader> reader;
  std::size_t free_rows = 0;
  // Of the row before: its place, and whether it has contact.
  std::optional<Vec2> last;
  bool last_has_contact = false;
  touch::each_row(text, name, options.decimal_comma, [&](const TableRow& row) {
    // The first row is the header.
    if (!reader) {
      reader.emplace(row, name, options);
      return true;
    }
    reader->require_whole(row);
    const MeasuredTouch touch = reader->read(row);
    const bool has_contact = reader->has_contact(row);
    // The way from a row without contact to the next row, contact or not; the way back from a touch is no path, nor is
    // one to a touch whose place is unknown.
    if (last && !last_has_contact && touch.has_place()) table.clear.push_back({*last, touch.at});
    last = touch.at;
    last_has_contact = has_contact;
    if (!has_contact) {
      ++free_rows;
      return true;
    }
    table.touches.push_back(touch);
    table.lines.push_back(row.line);
    return true;
  });
  if (table.touches.empty() && !options.may_be_empty) {
    throw InputError(
        fmt::format("{}: expected a touch in each row, found no row{}", name, free_rows > 0 ? " with contact 1" : ""));
  }
  // An empty table that may be empty.
  if (!reader) return table;
  touch::add_notes(table, reader->header(), free_rows, name);
  return table;
}

}  // namespace rollfix
