#include "rollfix/arguments/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include "rollfix/error.hpp"
#include "rollfix/touch.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

TouchTableOptions table_options(const RollArguments& arguments, const std::string& unit) {
  TouchTableOptions options;
  if (!arguments.reading.columns.empty()) options.columns = parse_touch_columns(arguments.reading.columns);
  options.unit = unit;
  options.decimal_comma = has_decimal_comma(arguments.reading.decimal);
  if (!options.decimal_comma) options.decimal_comma = has_decimal_comma(arguments.part.decimal);
  return options;
}

/// The first rows of a file or of standard input; nothing of another pipe, which can be read once only, or of what
/// can't be read.
std::string first_rows_of(const std::string& path) {
  constexpr std::size_t kEnoughForHeader = 65536;
  std::error_code ignored;
  if (path != "-" && !std::filesystem::is_regular_file(path, ignored)) return "";
  const std::string text = beginning_of_text(path, kEnoughForHeader);
  return text.size() < kEnoughForHeader ? text : text.substr(0, text.rfind('\n') + 1);
}

/// Whether --columns is of a roll: it names no column of touches alone, and one that only a roll has.
bool are_columns_of_roll(const std::string& columns) {
  if (columns.empty() || names_touch_columns(columns)) return false;
  try {
    parse_touch_columns(columns);
  } catch (const InputError&) {
    return true;  // or of nothing: whoever reads rolls says so
  }
  return false;
}

/// X,Y,X,Y.
Clear read_clear(const std::string& text, const std::string& unit) {
  const std::string what = "--clear " + text;
  const std::vector<std::string_view> fields = fields_of(text, what, 4, 4,
                                                         "expected X,Y,X,Y, as in 0,0,12.5,3.1: from where to where "
                                                         "the finger's centre went straight and felt nothing, or "
                                                         "rows, where --log has rows with contact 0; found {}");
  std::array<double, 4> numbers{};
  for (std::size_t k = 0; k < 4; ++k) numbers[k] = read_length(fields[k], what, unit);
  return {{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
}

/// Of --columns of a roll what it says of where the centre was, and of contact.
std::string columns_of_places(const std::string& columns) {
  std::vector<std::string> kept;
  for (const std::string_view one : split(columns, ',')) {
    const std::string_view column = trimmed(one.substr(0, one.find('=')));
    if (column == "x" || column == "y" || column == "contact") kept.emplace_back(one);
  }
  return fmt::format("{}", fmt::join(kept, ","));
}

/// The paths between the rows with contact 0 of logs, and from them to the next roll.
std::vector<Clear> free_rows_of(const RollArguments& arguments, const std::string& unit) {
  RollArguments places = arguments;
  places.reading.columns = columns_of_places(arguments.reading.columns);
  std::vector<Clear> paths;
  for (const std::string& path : arguments.logs) {
    if (path == "-") {
      throw InputError("--clear rows: of rolls it reads the log twice, which standard input can't: give it as a file");
    }
    const TouchTable table = parse_touches(read_text(path), path, table_options(places, unit));
    paths.insert(paths.end(), table.clear.begin(), table.clear.end());
  }
  return paths;
}

void add_clear(const std::vector<std::string>& given, std::vector<Clear> of_rows, const std::string& unit,
               Measurements& measured) {
  for (const std::string& text : given) {
    if (text != "rows") {
      measured.clear.push_back(read_clear(text, unit));
      continue;
    }
    if (of_rows.empty()) {
      throw InputError(
          "--clear rows: expected in the --log a row with contact 0 and a row after it, found none: the "
          "way from the one to the other is what felt nothing");
    }
    measured.clear.insert(measured.clear.end(), of_rows.begin(), of_rows.end());
    of_rows.clear();
  }
}

}  // namespace

MeasuredTouch read_touch(const std::string& text, const std::string& unit) {
  const std::string what = "--touch " + text;
  const std::vector<std::string_view> fields = fields_of(
      text, what, 2, 5,
      "expected X,Y or X,Y,NORMAL, as in 12.5,3.1,73deg: where the finger's centre was, and the direction out of the "
      "part, found {}");
  const auto is_given = [&](std::size_t k) { return k < fields.size() && !fields[k].empty(); };
  MeasuredTouch touch;
  for (std::size_t k = 0; k < 2; ++k) {  // where only the normal was measured both are empty
    touch.at[static_cast<Eigen::Index>(k)] =
        is_given(k) ? read_length(fields[k], what, unit) : std::numeric_limits<double>::quiet_NaN();
  }
  if (is_given(2)) touch.normal = written_angle(fields[2], what);
  if (is_given(3)) touch.position_sd = read_length(fields[3], what, unit);
  if (is_given(4)) touch.normal_sd = written_angle(fields[4], what);
  return touch;
}

TouchTolerance read_touch_tolerance(const std::string& text, const std::string& unit) {
  const std::string what = "--tolerance " + text;
  const std::vector<std::string_view> fields =
      fields_of(text, what, 1, 2, "expected LENGTH or LENGTH,ANGLE, as in 0.1,2deg, found {}");
  return {read_length(fields[0], what, unit), fields.size() == 2 ? written_angle(fields[1], what) : 0};
}

void add_touch_arguments(CLI::App& command, std::vector<std::string>& touches, RollArguments& arguments) {
  command
      .add_option("--touch", touches,
                  "a touch without rolling: the finger's centre in the world and, if it was measured, the direction "
                  "out of the part; repeatable, with --noise position=SD,angle=SD or --tolerance LENGTH,ANGLE; the "
                  "answer is every pose of the part; behind the normal, which may be empty, the touch's own standard "
                  "deviations may follow, of its place and of its normal: 12.5,3.1,,0.1 or 12.5,3.1,73deg,0.1,2deg")
      ->type_name("X,Y[,NORMAL]")
      ->allow_extra_args(false);
  command
      .add_option("--clear", arguments.clear,
                  "of touches and several rolls: where the finger's centre went straight from one place to another and "
                  "felt nothing; repeatable; rows: between the rows of the log with contact 0, and from them "
                  "to the next contact")
      ->type_name("X,Y,X,Y|rows")
      ->allow_extra_args(false);
}

bool is_table_of_touches(const std::string& path, const RollArguments& arguments) {
  if (are_columns_of_roll(arguments.reading.columns)) return false;
  return is_touch_table(first_rows_of(path), table_options(arguments, ""));
}

bool are_touches(const std::vector<std::string>& touches, const RollArguments& arguments) {
  if (!touches.empty()) return true;
  if (arguments.logs.size() != 1 || are_columns_of_roll(arguments.reading.columns)) return false;
  return names_touch_columns(arguments.reading.columns) || is_table_of_touches(arguments.logs.front(), arguments);
}

void add_touches(const std::vector<std::string>& touches, const RollArguments& arguments, const std::string& unit,
                 Measurements& measured, std::vector<std::string>& notes) {
  for (const std::string& text : touches) measured.touches.push_back(read_touch(text, unit));
  std::vector<Clear> of_rows;
  const bool is_roll = !measured.rolls.empty() || arguments.logs.empty();
  if (!is_roll && !touches.empty()) {
    const bool is_table = is_table_of_touches(arguments.logs.front(), arguments);
    throw InputError(is_table ? "--touch and --log both give touches: leave one of them out"
                              : "--touch and a --log of rolls share a pose with --roll all: add it");
  }
  if (!is_roll) {
    const std::string& file = arguments.logs.front();
    TouchTable table =
        parse_touches(read_text(file), file == "-" ? "standard input" : file, table_options(arguments, unit));
    measured.touches = std::move(table.touches);
    of_rows = std::move(table.clear);
    notes.insert(notes.end(), table.notes.begin(), table.notes.end());
  }
  const bool any_rows = std::find(arguments.clear.begin(), arguments.clear.end(), "rows") != arguments.clear.end();
  if (any_rows && measured.at_rest && !measured.rolls.empty()) of_rows = free_rows_of(arguments, unit);
  add_clear(arguments.clear, std::move(of_rows), unit, measured);
}

}  // namespace rollfix::app
