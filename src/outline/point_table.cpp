#include "outline/point_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "outline/box.hpp"
#include "outline/refusals.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/table.hpp"
#include "text/text.hpp"
#include "text/units.hpp"

// A table of points, read line by line.
// Notation:
//   data            a line up to a '#', with decimal points for commas: `data_`
//   field, cell     what stands between blanks, commas or semicolons; of a row with a header: cells
//   title           a line of words before the first point; the one that names columns is the header: Header
//   x, y            the two columns to read: the first two, or those that the header calls so
// Follows docs/files.md, "Points and scans".
// Idea: without a header, or with one whose first columns are x and y, two numbers begin each line and the rest of it
// is not looked at; with another header cells are counted. A line that is neither is refused, not passed over: a point
// that is missing would change the part.
namespace rollfix {

namespace {

/// What a line holds: nothing, a point, words, a single number, or two numbers between which another mark stands than
/// behind them.
enum class LineKind { blank, point, words, one_number, mixed_separators };

/// Blanks within a line; a return before the line's end counts as one.
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }
/// What may stand between two fields, besides blanks.
bool is_mark(char c) { return c == ',' || c == ';'; }

/// Between two fields: blanks with at most one comma or semicolon among them. Returns the mark, a blank when there
/// is none, or 0 when the line ends or nothing separates.
char skip_separator(const char*& cursor, const char* end) {
  const char* const start = cursor;
  char mark = ' ';
  while (cursor != end && is_space(*cursor)) ++cursor;
  if (cursor != end && is_mark(*cursor)) {
    mark = *cursor++;
    while (cursor != end && is_space(*cursor)) ++cursor;
  }
  // A mark at the end of the line is returned: "1," has an empty second field.
  const bool line_ends = cursor == end && mark == ' ';
  return line_ends || cursor == start ? '\0' : mark;
}

/// Reads the first two fields of a line without a header, in one pass. `point` is set where the result is a point.
LineKind read_line(std::string_view line, Vec2& point) {
  const char* cursor = line.data();
  const char* const end = line.data() + line.size();
  while (cursor != end && is_space(*cursor)) ++cursor;
  if (cursor == end) return LineKind::blank;
  // Each step takes a field or a separator; where one is missing, what stands there tells the kind.
  if (!scan_number(cursor, end, point.x())) return LineKind::words;
  const char first_mark = skip_separator(cursor, end);
  if (first_mark == '\0') return cursor == end ? LineKind::one_number : LineKind::words;
  if (cursor == end) return LineKind::one_number;  // "1,"
  if (!scan_number(cursor, end, point.y())) return LineKind::words;
  const char second_mark = skip_separator(cursor, end);
  if (second_mark == '\0') return cursor == end ? LineKind::point : LineKind::words;
  // "1,5;2,5" or "1,5 2,5": a decimal comma, most likely, and nothing that could be taken for a point by mistake.
  return is_mark(first_mark) && second_mark != first_mark ? LineKind::mixed_separators : LineKind::point;
}

/// Throws InputError with the file, the line's number and text, and what to write instead.
[[noreturn]] void refuse_line(const std::string& name, std::size_t number, std::string_view line, LineKind kind) {
  const std::string where = fmt::format("{}:{}: '{}'", name, number, shown(line));
  switch (kind) {
    case LineKind::one_number:
      throw InputError(where + " is only one number, expected two as in '1.5 2'; a title goes behind a #");
    case LineKind::mixed_separators:
      throw InputError(where +
                       " mixes separators, expected 'x y' or 'x,y' with decimal points, not commas, "
                       "which `decimal_comma` takes");
    case LineKind::blank:
    case LineKind::point:
    case LineKind::words:
      break;
  }
  throw InputError(where + " is not two numbers, expected a point as in '1.5 2' or '1.5,2'");
}

// ---- headers

/// The cells of a row, trimmed and without quotes. Between blanks none is empty; between marks some may be.
std::vector<std::string_view> cells_of(std::string_view row, char separator) {
  std::vector<std::string_view> cells;
  for (const std::string_view cell : split(trimmed(row), separator)) {
    if (separator != ' ' || !cell.empty()) cells.push_back(unquoted(cell));
  }
  return cells;
}

/// "X [mm]" as x and mm.
struct Title {
  std::string name;  // in lower case
  std::string unit;
};

/// "x_mm", "y mm" as x and mm, y and mm. Other names may end in anything.
/// `name` in lower case. Only behind x and y is a unit of length taken off.
Title title_with_unit(const std::string& name) {
  const bool is_coordinate =
      name.size() > 2 && (name[0] == 'x' || name[0] == 'y') && (name[1] == '_' || name[1] == ' ');
  const std::optional<Unit> unit = is_coordinate ? unit_named(name.substr(2)) : std::nullopt;
  if (!unit || unit->dimension != Dimension::length) return {name, ""};
  return {name.substr(0, 1), std::string(unit->name)};
}

/// A cell of a header, with the unit in brackets or parentheses behind it.
Title title_of(std::string_view cell) {
  const char open = cell.empty() ? '\0' : cell.back() == ']' ? '[' : cell.back() == ')' ? '(' : '\0';
  const std::size_t at = open == '\0' ? std::string_view::npos : cell.rfind(open);
  if (at == std::string_view::npos) return title_with_unit(lower_case(cell));
  return {lower_case(trimmed(cell.substr(0, at))), std::string(trimmed(cell.substr(at + 1, cell.size() - at - 2)))};
}

/// The line that says which column is which.
struct Header {
  char separator = ',';
  std::vector<Title> titles;  // of the columns, in order
  std::size_t x = 0;          // the columns to read
  std::size_t y = 1;

  /// x and y are the first two columns: lines are read as without a header.
  bool is_plain() const { return x == 0 && y == 1; }
  /// The first column of this name.
  std::optional<std::size_t> find(std::string_view name) const {
    const auto at = std::find_if(titles.begin(), titles.end(), [&](const Title& one) { return one.name == name; });
    if (at == titles.end()) return std::nullopt;
    return static_cast<std::size_t>(at - titles.begin());
  }
  bool has(std::string_view name) const { return find(name).has_value(); }
};

/// The columns that only logs have, and what they have in pairs.
constexpr std::array<std::string_view, 9> kOfLogs = {"u",   "psi",   "dturn",  "u_a",     "psi_a",
                                                     "u_b", "psi_b", "turn_a", "length_a"};
constexpr std::array<std::array<std::string_view, 2>, 3> kLogPairs = {
    {{"u", "psi"}, {"length", "turn"}, {"distance", "dturn"}}};

/// Throws InputError: a header of a log. Between commas one of its names is enough, unless x and y are there as well.
/// The words of a title ("length and turn") are not names, but u and psi are no words.
void refuse_log(const Header& header, bool is_header, std::string_view line, std::size_t number,
                const std::string& name) {
  const auto has = [&](std::string_view title) { return header.has(title); };
  // A log in place of a part is the likeliest mistake: it has two numbers in front of each line as well.
  const bool has_pair = std::any_of(kLogPairs.begin(), kLogPairs.end(), [&](const auto& pair) {
    return has(pair[0]) && has(pair[1]) && (is_header || pair[0] != "length");
  });
  const bool has_one =
      header.separator != ' ' && !(has("x") && has("y")) && std::any_of(kOfLogs.begin(), kOfLogs.end(), has);
  if (!has_pair && !has_one) return;
  throw InputError(
      fmt::format("{}:{}: '{}' is the header of a log, expected the points of a part, one 'x y' per line; the part "
                  "comes first and the log behind --log, as in rollfix locate part.csv --log {}",
                  name, number, shown(line), name));
}

/// Whether the next line goes on as this header begins: numbers where it has x and y.
bool is_followed_by_points(const Header& header, std::string_view next) {
  const std::vector<std::string_view> cells = cells_of(next, header.separator);
  return cells.size() == header.titles.size() && parse_number(cells[header.x]) && parse_number(cells[header.y]);
}

/// Reads a text from line to line: titles and the header in front, then points.
class TableReader {
 public:
  TableReader(std::string_view text, const std::string& name, std::optional<bool> decimal_comma)
      : rest_(text), name_(name), decimal_comma_(decimal_comma) {}

  /// All points. Throws InputError at the first line that is none.
  NumberedPoints run() {
    while (next_line()) {
      Vec2 point;
      // A header that puts x and y elsewhere: cells are counted.
      if (header_ && !header_->is_plain()) {
        if (trimmed(data_).empty()) continue;
        point = point_in_table();
      } else {
        // Words are titles only before the first point; afterwards they are an error.
        const LineKind kind = read_line(data_, point);
        if (kind == LineKind::blank) continue;
        if (kind == LineKind::words && may_be_title()) {
          take_title();
          continue;
        }
        if (kind != LineKind::point) refuse_line(name_, number_, line_, kind);
        if (titles_ == 0 && !header_) look_for_more_columns();
      }
      add(point);
    }
    if (titles_ > 1) result_.notes.push_back(fmt::format("{} title lines were passed over", titles_));
    return std::move(result_);
  }

 private:
  /// Without a header nobody says that x and y are the first two.
  void look_for_more_columns() {
    // Asked at the first point only. Empty cells at the end of the line don't count.
    if (!result_.points.empty()) return;
    const char separator = separator_of(data_);
    std::vector<std::string_view> cells = cells_of(data_, separator);
    while (!cells.empty() && trimmed(cells.back()).empty()) cells.pop_back();
    if (cells.size() < 3) return;
    result_.notes.push_back(fmt::format(
        "{} columns without a header: the first two are taken as x and y; a line such as {} in front says otherwise",
        cells.size(), separator == ',' ? "'id,x,y'" : "'id x y'"));
  }

  /// Moves on by one line and fills `line_`, `data_` and `number_`; false at the end of the text.
  bool next_line() {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    data_ = line_.substr(0, line_.find('#'));
    if (std::optional<std::string> converted = with_decimal_points(data_, decimal_comma_)) {
      with_points_ = std::move(*converted);
      data_ = with_points_;
    }
    ++number_;
    return true;
  }

  /// The next line that is not blank, as far as it is data.
  std::string line_ahead() const {
    // Another reader of the rest, so that this one stays where it is. It takes the few lines up to the next with data.
    TableReader ahead(rest_, name_, decimal_comma_);
    while (ahead.next_line()) {
      if (!trimmed(ahead.data_).empty()) return std::string(ahead.data_);
    }
    return {};
  }

  /// In front of the points. A second one must not look like a point with a slip of the pen: "1.0 O.5".
  bool may_be_title() const {
    if (!result_.points.empty() || header_) return false;
    const char* cursor = data_.data();
    const char* const end = cursor + data_.size();
    double number = 0;
    while (cursor != end && is_space(*cursor)) ++cursor;
    const bool begins_like_a_point = scan_number(cursor, end, number) && skip_separator(cursor, end) != '\0';
    return titles_ == 0 || !begins_like_a_point;
  }

  /// A line of words before the points: the header, if it names columns, or a title that is passed over. Throws
  /// InputError: the header of a log, or one with x or y alone.
  void take_title() {
    ++titles_;
    result_.has_title = true;
    Header header;
    header.separator = separator_of(data_);
    for (const std::string_view cell : cells_of(data_, header.separator)) header.titles.push_back(title_of(cell));
    const std::optional<std::size_t> x = header.find("x");
    const std::optional<std::size_t> y = header.find("y");
    if (x && y) {
      header.x = *x;
      header.y = *y;
    }
    // Between marks several cells are a header; between blanks they may be the words of a title: then the next line
    // decides.
    const bool is_header =
        header.titles.size() > 1 && (header.separator != ' ' || is_followed_by_points(header, line_ahead()));
    refuse_log(header, is_header, line_, number_, name_);
    if (!is_header) return;
    if (x && y) {
      --titles_;
      take_unit(header);
      if (header.has("z")) result_.notes.push_back("the column z is not looked at: outlines are plane");
      header_ = header;
      return;
    }
    require_no_half(x, y);
    note_first_two(header);
  }

  /// "y,z", "id,x": what is not x or y can't be told from the name, and one of them stands where the other belongs.
  void require_no_half(const std::optional<std::size_t>& x, const std::optional<std::size_t>& y) const {
    if ((!x || *x == 0) && (!y || *y == 1)) return;
    throw InputError(fmt::format("{}:{}: the header '{}' has a column '{}' but no '{}', expected both", name_, number_,
                                 shown(line_), x ? "x" : "y", x ? "y" : "x"));
  }

  /// A header without the names x and y: says which two columns are taken, as another two may be meant.
  void note_first_two(const Header& header) {
    if (header.titles.size() < 3 || !is_followed_by_points(header, line_ahead())) return;
    result_.notes.push_back(fmt::format("the header '{}' names no x and y: the first two columns, {} and {}, are taken",
                                        shown(line_), header.titles[0].name, header.titles[1].name));
  }

  /// The unit that the header states for x and y. Throws InputError: not one of length, or not the same for both.
  void take_unit(const Header& header) {
    const std::string& stated = header.titles[header.x].unit;
    if (stated.empty() && header.titles[header.y].unit.empty()) return;
    const std::optional<Unit> unit = unit_named(stated);
    if (!unit || unit->dimension != Dimension::length || header.titles[header.y].unit != stated) {
      throw InputError(fmt::format(
          "{}:{}: the header '{}' has x in '{}' and y in '{}', expected the same "
          "unit of length: {}",
          name_, number_, shown(line_), stated, header.titles[header.y].unit, unit_names(Dimension::length)));
    }
    result_.unit = unit->name;
  }

  /// The point in the header's columns. Throws InputError: no number there, or more cells than the header has, which a
  /// decimal comma makes.
  Vec2 point_in_table() const {
    // A line may be separated otherwise than its header, by blanks say.
    const bool is_alike = data_.find(header_->separator) != std::string_view::npos;
    const std::vector<std::string_view> cells = cells_of(data_, is_alike ? header_->separator : separator_of(data_));
    const auto number = [&](std::size_t k) {
      const std::optional<double> value = k < cells.size() ? parse_number(cells[k]) : std::nullopt;
      if (value) return *value;
      throw InputError(fmt::format(
          "{}:{}: '{}' has no number in the column '{}', number {}, expected one such as 1.5{}", name_, number_,
          shown(line_), header_->titles[k].name, k + 1, k < cells.size() ? decimal_comma_hint(cells[k]) : ""));
    };
    if (cells.size() > header_->titles.size() && header_->separator == ',') {
      throw InputError(
          fmt::format("{}:{}: '{}' has {} cells, expected {} as in the header; numbers take a decimal "
                      "point, not a comma",
                      name_, number_, shown(line_), cells.size(), header_->titles.size()));
    }
    return {number(header_->x), number(header_->y)};
  }

  /// Appends a point. Throws InputError: not finite, beyond kMostCoordinate, or one more than kMostPieces.
  void add(const Vec2& point) {
    if (!(point.cwiseAbs().maxCoeff() <= kMostCoordinate) || point.hasNaN()) {
      throw InputError(fmt::format("{}:{}: the point ({}, {}) is out of range, expected finite numbers of at most {}",
                                   name_, number_, point.x(), point.y(), kMostCoordinate));
    }
    if (result_.points.size() == kMostPieces) require_few_pieces(kMostPieces + 1, fmt::format("{}:{}", name_, number_));
    result_.points.push_back(point);
    result_.lines.push_back(number_);
  }

  std::string_view rest_;    // behind the line
  std::string_view line_;    // as in the file
  std::string_view data_;    // without a comment
  std::string with_points_;  // the same with decimal points for commas
  const std::string& name_;
  std::optional<bool> decimal_comma_;  // nothing: each line tells
  std::size_t number_ = 0;             // of the line, from 1 on
  std::size_t titles_ = 0;             // passed over
  std::optional<Header> header_;       // nothing before it comes, or without one
  NumberedPoints result_;
};

}  // namespace

NumberedPoints read_point_table(std::string_view text, const std::string& name, std::optional<bool> decimal_comma) {
  return TableReader(plain_beginning(text, name, "one point 'x y' per line"), name, decimal_comma).run();
}

}  // namespace rollfix
