#include "log/header/log_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

// A header to columns. In this order: names and units in the header; one finger or two; columns that the options name;
// columns of known names; then which of the three pairs the log has. All errors name the header's line.
// Follows docs/rolling.md, "Logs".
namespace rollfix {

namespace {

// The end of a message about missing columns where x and y are there: it may be a wheel's log.
constexpr const char* kOfWheel = "; a wheel without skin has no more, it is a finger wheel,r=R beside one with skin";
// The three pairs, for messages.
constexpr const char* kExpected = "'u' and 'psi', or 'length' and 'turn', or 'distance' and 'dturn'";

/// Name and unit of a header's cell: "u [deg]", "u(deg)". Without brackets at its end all of it is the name.
HeaderName header_name(std::string_view text) {
  HeaderName result{text, text, {}, {}};
  if (text.empty()) return result;
  const char open = text.back() == ']' ? '[' : text.back() == ')' ? '(' : '\0';
  const std::size_t start = open == '\0' ? std::string_view::npos : text.rfind(open);
  if (start == std::string_view::npos || start == 0) return result;
  result.name = trimmed(text.substr(0, start));
  result.unit = trimmed(text.substr(start + 1, text.size() - start - 2));
  return result;
}

/// "[deg]", "(mm)", with something in it.
bool is_in_brackets(std::string_view text) {
  return text.size() > 2 &&
         ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')'));
}

}  // namespace

/// Cells point into one line of text: two that are put together are the text from the first one's start to the second
/// one's end.
std::vector<HeaderName> names_in(const TableRow& header) {
  std::vector<std::string_view> cells;
  for (const std::string_view cell : header.cells) {
    // Blanks separate: "psi [deg]" came as two cells. They are one where only blanks stand between them.
    const bool is_unit = !cells.empty() && !cells.back().empty() && is_in_brackets(cell);
    if (is_unit) {
      const char* const last_end = cells.back().data() + cells.back().size();
      const std::string_view between(last_end, static_cast<std::size_t>(cell.data() - last_end));
      if (trimmed(between).empty()) {
        cells.back() = {cells.back().data(), cells.back().size() + between.size() + cell.size()};
        continue;
      }
    }
    cells.push_back(cell);
  }
  std::vector<HeaderName> names;
  for (const std::string_view cell : cells) names.push_back(header_name(cell));
  const auto has = [&](const std::string& name) {
    return std::any_of(names.begin(), names.end(), [&](const HeaderName& one) { return one.name == name; });
  };
  for (HeaderName& one : names) {
    const std::string small = lower_case(one.name);
    if (is_known_of_any(small) && (one.name == small || !has(small))) one.known = small;
  }
  return names;
}

namespace {

/// Reads one header.
class HeaderReader {
 public:
  HeaderReader(const TableRow& row, const std::string& log, const LogOptions& options)
      : row_(row), names_(names_in(row)), log_(log), options_(options) {}

  /// Of a wheel without skin: no pair is asked for, but the pin's place.
  Columns pin_columns() const {
    Columns columns;
    columns.count = names_.size();
    columns.of_pin = true;
    std::vector<bool> taken(names_.size(), false);
    add_named(columns, taken);
    add_known(columns, taken);
    require_pin(columns);
    if (!columns.psi_wrapped) columns.psi_wrapped = options_.wrapped;
    return columns;
  }

  /// Of one finger, or of both. Throws InputError: fingers with different kinds of columns.
  std::vector<Columns> columns() const {
    if (!is_of_two()) {
      Columns one = finger_columns("");
      one.note = other_finger_note(names_, one);
      return {one};
    }
    std::vector<Columns> fingers;
    for (const char* suffix : kFingerSuffixes) fingers.push_back(finger_columns(suffix));
    if (fingers[0].kind == fingers[1].kind) return fingers;
    throw InputError(
        fmt::format("{} has other columns of finger a than of finger b, expected the same of both", start()));
  }

 private:
  /// Beginning of a message: "run.csv:1: the header 'a,b'".
  std::string start() const { return fmt::format("{}: the header '{}'", where(log_, row_.line), shown(row_.text)); }

  /// Whether the log is of two fingers: the options say it by the columns that they name, else the header does, by
  /// names that end in _a or _b and none without.
  bool is_of_two() const {
    const auto& sources = options_.columns;
    const auto is_two = [](const ColumnSource& source) { return says_where_of_one_of_two(source.column); };
    const auto is_one = [](const ColumnSource& source) { return says_where(source.column); };
    if (std::any_of(sources.begin(), sources.end(), is_two)) return true;
    if (std::any_of(sources.begin(), sources.end(), is_one)) return false;
    return std::none_of(names_.begin(), names_.end(), [](const HeaderName& one) { return says_where(one.known); }) &&
           std::any_of(names_.begin(), names_.end(),
                       [](const HeaderName& one) { return says_where_of_one_of_two(one.known); });
  }

  // Steps of the above, see each below.
  Columns finger_columns(const std::string& suffix) const;
  void require_pin(const Columns& columns) const;
  void add_named(Columns& columns, std::vector<bool>& taken) const;
  void add_known(Columns& columns, const std::vector<bool>& taken) const;
  void set(Columns& columns, Column column, std::size_t k) const;
  void set_unit(Columns& columns, Column column, const HeaderName& header, const std::string& stated) const;
  std::size_t find(const ColumnSource& source) const;
  LogKind kind_of(const Columns& columns) const;
  std::string hint(const Columns& columns) const;
  std::string cure(const Columns& columns) const;
  std::string all_names() const;
  [[noreturn]] void refuse(const Columns& columns) const;

  const TableRow& row_;            // the header
  std::vector<HeaderName> names_;  // of its cells
  const std::string& log_;
  const LogOptions& options_;
};

/// The columns of the finger whose columns end in this.
Columns HeaderReader::finger_columns(const std::string& suffix) const {
  Columns columns;
  columns.count = names_.size();
  columns.suffix = suffix;
  // First what the options name, then what has a known name.
  std::vector<bool> taken(names_.size(), false);
  add_named(columns, taken);
  add_known(columns, taken);
  columns.kind = kind_of(columns);
  // What is said of all angles holds where nothing is said of this column.
  if (!columns.u_wrapped) columns.u_wrapped = options_.wrapped;
  if (!columns.psi_wrapped) columns.psi_wrapped = options_.wrapped;
  // A centre has both.
  if (columns.has(Column::x) != columns.has(Column::y)) {
    throw InputError(fmt::format("{}: the header has a column '{}' but no '{}', expected both or neither{}",
                                 where(log_, row_.line), columns.called(columns.has(Column::x) ? Column::x : Column::y),
                                 columns.called(columns.has(Column::x) ? Column::y : Column::x), cure(columns)));
  }
  return columns;
}

/// Throws InputError: a column that needs a skin, or no place of the pin.
void HeaderReader::require_pin(const Columns& columns) const {
  for (const Column column : {Column::u, Column::length, Column::distance}) {
    if (!columns.has(column)) continue;
    throw InputError(
        fmt::format("{} has a column '{}', expected x and y of the pin and at most psi: a wheel has no skin; a round "
                    "finger with one is disk,r=R in place of wheel,r=R",
                    start(), name_of(column)));
  }
  if (columns.has(Column::x) && columns.has(Column::y)) return;
  const std::string why = columns.has(Column::psi)
                              ? ": how the wheel is turned says nothing of the part by itself, any "
                                "place on it fits; add where the pin was"
                              : "";
  throw InputError(
      fmt::format("{}: expected columns 'x' and 'y', where the wheel's pin was in the world{}; the header has {}",
                  start(), why, all_names()));
}

/// Takes the columns that the options name: each cell at most once (`taken`). Options of the other finger are passed
/// over. Throws InputError: a name that the header does not have, one that is read twice.
void HeaderReader::add_named(Columns& columns, std::vector<bool>& taken) const {
  for (const ColumnSource& source : options_.columns) {
    const std::optional<Column> column = column_named(source.column, columns.suffix);
    if (!column) {
      // A column without _a or _b in a log of two fingers: whose it is is not known.
      if (!columns.suffix.empty() && !says_where_of_one_of_two(source.column) && is_known(source.column)) {
        throw InputError(fmt::format("{}: `columns` {}={}: the log is of two fingers, expected {}_a and {}_b",
                                     where(log_, row_.line), source.column, source.name, source.column, source.column));
      }
      continue;
    }
    const std::size_t cell = find(source);
    if (taken[cell]) {
      throw InputError(
          fmt::format("{}: `columns` reads '{}' twice, as {} as well: expected a column of its own for each",
                      where(log_, row_.line), source.name, source.column));
    }
    taken[cell] = true;
    set(columns, *column, cell);
    // "deg:unwrapped": how the angle is wrapped is taken off, the unit is left.
    std::string_view unit = source.unit;
    if (*column == Column::u) columns.u_wrapped = take_wrapping(unit);
    if (*column == Column::psi) columns.psi_wrapped = take_wrapping(unit);
    set_unit(columns, *column, names_[cell], std::string(unit));
  }
}

/// Takes the columns that have a known name, where the options do not name another. Where these name a pair, or one
/// column of it, other pairs of the header are not looked at.
void HeaderReader::add_known(Columns& columns, const std::vector<bool>& taken) const {
  // What the options have named, before any known name is taken.
  const Columns named = columns;
  const auto is_named = [&](const ColumnPair& pair) { return named.has(pair.place) || named.has(pair.angle); };
  const bool pair_is_chosen = std::any_of(kColumnPairs.begin(), kColumnPairs.end(), is_named);
  for (std::size_t k = 0; k < names_.size(); ++k) {
    const std::optional<Column> column = column_named(names_[k].known, columns.suffix);
    // Not known, used already, or named by the options elsewhere.
    if (!column || taken[k] || named.has(*column)) continue;
    const auto* const pair = std::find_if(kColumnPairs.begin(), kColumnPairs.end(), [&](const ColumnPair& one) {
      return one.place == *column || one.angle == *column;
    });
    if (pair_is_chosen && pair != kColumnPairs.end() && !is_named(*pair)) continue;
    set(columns, *column, k);
    set_unit(columns, *column, names_[k], "");
  }
}

/// Cell k holds this column. Throws InputError: another cell does already.
void HeaderReader::set(Columns& columns, Column column, std::size_t k) const {
  std::size_t& cell = columns.cell[static_cast<std::size_t>(column)];
  if (cell != Columns::kNone) {
    const std::string_view before = names_[cell].text;
    throw InputError(fmt::format("{}: the column '{}' occurs twice, as number {}{} and {}; rename one of them",
                                 where(log_, row_.line), shown(names_[k].text), cell + 1,
                                 before == names_[k].text ? "" : fmt::format(" ('{}')", shown(before)), k + 1));
  }
  cell = k;
  columns.source[static_cast<std::size_t>(column)] = {columns.called(column), std::string(names_[k].name)};
  if (column == Column::contact) columns.contact_is_shared = names_[k].known == name_of(Column::contact);
}

/// The unit of a column, and how its numbers are converted. `stated`: by the options; it goes before what the header
/// says, and that before what is said of all angles. Without any the numbers are radians, seconds or in the part's
/// unit; a name that sounds like another unit is refused then, because both can be meant. Throws InputError: a unit
/// that is not known or not the column's, or one of length where the part's is not known.
void HeaderReader::set_unit(Columns& columns, Column column, const HeaderName& header,
                            const std::string& stated) const {
  if (column == Column::contact) return;
  // In this order: the options, the header's brackets, then for angles what is said of all of them.
  std::string_view written = stated.empty() ? header.unit : stated;
  if (written.empty() && is_angle(column)) written = options_.angles;
  const std::string what =
      fmt::format("{}: the column '{}' ({})", where(log_, row_.line), shown(header.text), columns.called(column));
  if (written.empty()) {
    const std::string meant = unit_in_name(header.name, column, options_.unit);
    // A length whose name ends in a unit, as dist_mm: while the part's unit is not known it may be that one.
    const bool may_be_the_parts = column != Column::u && !is_angle(column) && column != Column::time;
    if (meant.empty() || (may_be_the_parts && options_.unit.empty())) return;
    throw InputError(fmt::format(
        "{} sounds like {}, which is not taken for granted: say it with its unit, as in `columns` {}={}:{}{}", what,
        meant, columns.called(column), header.name, meant,
        is_angle(column) ? fmt::format(", or with :rad where the numbers are radians") : ""));
  }
  // As written first, since capitals can tell units apart.
  const std::optional<Unit> as_written = unit_named(written);
  const std::optional<Unit> unit = as_written ? as_written : unit_named(lower_case(written));
  if (!unit || !takes(column, unit->dimension)) {
    throw InputError(fmt::format("{} is in '{}', expected {}", what, shown(written), what_it_takes(column)));
  }
  columns.source[static_cast<std::size_t>(column)].unit = written;
  if (column == Column::u) columns.u_dimension = unit->dimension;
  Conversion& to = columns.conversion[static_cast<std::size_t>(column)];
  // Angles become radians and times seconds; lengths need to know the part's unit.
  if (unit->dimension != Dimension::length) {
    to = conversion_to_plain(*unit);
  } else if (!options_.unit.empty()) {
    to = length_conversion(unit->name, options_.unit, what);
  } else {
    throw InputError(fmt::format("{} is in {}, and the part's unit is not known: state it with `unit`, as in `unit` {}",
                                 what, unit->name, unit->name));
  }
}

/// The cell of the name that the options give, with or without its unit. Throws InputError: there is none.
std::size_t HeaderReader::find(const ColumnSource& source) const {
  for (std::size_t k = 0; k < names_.size(); ++k) {
    if (names_[k].text == source.name || names_[k].name == source.name) return k;
  }
  std::vector<std::string> names;
  for (const HeaderName& one : names_) names.emplace_back(one.name);
  // A typo is likely: the nearest name goes into the message.
  const std::string nearest = nearest_name(source.name, names);
  throw InputError(fmt::format("{}: expected a column '{}' for {} (`columns`), found none{}; the header has {}",
                               where(log_, row_.line), source.name, source.column,
                               nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest), all_names()));
}

/// The names in the header, for messages; of long headers the first ones.
std::string HeaderReader::all_names() const {
  constexpr std::size_t kMost = 30;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(names_.size(), kMost); ++k) names.push_back(shown(names_[k].text));
  return fmt::format("{}{}", fmt::join(names, ", "), names_.size() > kMost ? ", ..." : "");
}

/// Which of the pairs the log has: exactly one of them, and whole.
LogKind HeaderReader::kind_of(const Columns& columns) const {
  const ColumnPair* found = nullptr;
  for (const ColumnPair& pair : kColumnPairs) {
    const bool has_place = columns.has(pair.place);
    if (has_place != columns.has(pair.angle)) {
      // psi with x and y, and no u: the log of a wheel that was given as a finger's.
      const bool is_wheels = pair.angle == Column::psi && !has_place && columns.has(Column::x);
      throw InputError(fmt::format("{} has a column '{}' but no '{}', expected both{}{}{}", start(),
                                   columns.called(has_place ? pair.place : pair.angle),
                                   columns.called(has_place ? pair.angle : pair.place), hint(columns), cure(columns),
                                   is_wheels ? kOfWheel : ""));
    }
    // Neither of this pair.
    if (!has_place) continue;
    // Two pairs, which may contradict each other: the user has to choose.
    if (found != nullptr) {
      throw InputError(fmt::format(
          "{}: the header has '{}' and '{}' as well as '{}' and '{}', expected only one of these pairs; rename the "
          "columns that are not to be used, or choose a pair: `columns` {}={},{}={}",
          where(log_, row_.line), columns.called(found->place), columns.called(found->angle),
          columns.called(pair.place), columns.called(pair.angle), columns.called(found->place),
          names_[columns[found->place]].name, columns.called(found->angle), names_[columns[found->angle]].name));
    }
    found = &pair;
  }
  if (found == nullptr) refuse(columns);
  return static_cast<LogKind>(found - kColumnPairs.data());
}

/// The likely typo: a name that is not known but near to one that is missing. Too many names are near to x, y and u.
std::string HeaderReader::hint(const Columns& columns) const {
  std::vector<std::string> missing;
  for (std::size_t k = 0; k < kColumnCount; ++k) {
    const bool is_word = std::string_view(kColumnNames[k]).size() > 1;
    if (is_word && columns.cell[k] == Columns::kNone) missing.push_back(columns.called(static_cast<Column>(k)));
  }
  // Names that are known, or the other finger's, are no typos.
  for (const HeaderName& one : names_) {
    if (is_known(one.known) || (!columns.suffix.empty() && says_where_of_one_of_two(one.known))) continue;
    const std::string nearest = nearest_name(std::string(one.name), missing);
    if (!nearest.empty()) return fmt::format("; did you mean '{}' by '{}'?", nearest, shown(one.text));
  }
  return "";
}

/// What to type so that the header is understood: the option with guesses. If all names are known no option helps, and
/// the header is shown.
std::string HeaderReader::cure(const Columns& columns) const {
  // Without an unknown name there is nothing to guess from.
  const bool any_is_left =
      std::any_of(names_.begin(), names_.end(), [](const HeaderName& one) { return !is_known(one.known); });
  if (!any_is_left) return fmt::format("; the header has {}", all_names());
  return fmt::format("; say which column is which, as in `columns` {} (the header has {}){}",
                     suggested_columns(names_, columns), all_names(),
                     columns.suffix.empty() ? "; touches without rolling have x and y alone" : "");
}

/// Throws InputError: the header has none of the pairs, of this finger or at all.
void HeaderReader::refuse(const Columns& columns) const {
  if (!columns.suffix.empty()) {
    const bool is_a = columns.suffix == kFingerSuffixes[0];
    // If no name sounds like the missing finger's, the log is likely of one finger alone.
    const bool is_of_one = !holds_columns_of(names_, is_a ? 0 : 1);
    const std::string of_one = fmt::format("; of one finger alone say `columns` {} (the header has {})",
                                           suggested_columns(names_, {}), all_names());
    throw InputError(
        fmt::format("{} has columns of finger {} but none of finger {}, expected the same of both, such as 'u_a', "
                    "'psi_a', 'u_b' and 'psi_b'{}{}",
                    start(), is_a ? 'b' : 'a', is_a ? 'a' : 'b', is_of_one ? "" : hint(columns),
                    is_of_one ? of_one : cure(columns)));
  }
  const bool is_wheels = columns.has(Column::x) && columns.has(Column::y);
  throw InputError(fmt::format(
      "{} does not say what the columns are, expected {}{}{}{}. Known are: {}; of two fingers with _a "
      "and _b behind them",
      start(), kExpected, hint(columns), cure(columns), is_wheels ? kOfWheel : "", fmt::join(kColumnNames, ", ")));
}

}  // namespace

std::vector<Columns> columns_of(const TableRow& header, const std::string& log, const LogOptions& options) {
  return HeaderReader(header, log, options).columns();
}

Columns pin_columns_of(const TableRow& header, const std::string& log, const LogOptions& options) {
  return HeaderReader(header, log, options).pin_columns();
}

namespace {

/// A note where two columns without a header look like x, y of touches rather than distance, dturn; else empty. Few
/// fingers turn by more than half a turn from one row to the next: so large a number is likely a place.
std::string note_of_touches(const TableRow& row, const Columns& columns) {
  const auto turn = static_cast<std::size_t>(Column::dturn);
  const std::optional<double> value = parse_number(row.cells[1]);
  if (!value || std::abs(columns.conversion[turn](*value)) <= std::numbers::pi) return "";
  return fmt::format(
      "line {}: two columns without a header are taken for distance and dturn; they look like x,y of touches: if so, "
      "name them in a header, x,y",
      row.line);
}

}  // namespace

Columns bare_columns(const TableRow& row, const std::string& log, const LogOptions& options) {
  // Names need a header to be looked for in.
  if (!options.columns.empty()) {
    throw InputError(
        fmt::format("{}: the log starts with '{}', numbers, expected a header with the names that "
                    "`columns` gives; put one in front of the rows",
                    where(log, row.line), shown(row.text)));
  }
  if (row.cells.size() != 2) {
    throw InputError(fmt::format(
        "{}: the log starts with '{}', {} numbers without a header: expected a header that names {}, or exactly two "
        "columns, distance and dturn; touched places are named x,y. Known are: {}",
        where(log, row.line), shown(row.text), row.cells.size(), kExpected, fmt::join(kColumnNames, ", ")));
  }
  // Without a header: two columns of increments, as a wheel encoder with a gyroscope writes them.
  Columns columns;
  columns.count = 2;
  columns.kind = LogKind::increments;
  columns.cell[static_cast<std::size_t>(Column::distance)] = 0;
  columns.cell[static_cast<std::size_t>(Column::dturn)] = 1;
  if (const std::optional<Unit> unit = unit_named(options.angles)) {
    columns.conversion[static_cast<std::size_t>(Column::dturn)] = conversion_to_plain(*unit);
  }
  columns.note = note_of_touches(row, columns);
  return columns;
}

}  // namespace rollfix
