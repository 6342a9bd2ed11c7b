#include "rollfix/arguments/measured_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/part_argument.hpp"
#include "rollfix/arguments/typed_readings.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate/touch_arguments.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

LogOptions log_options(const RollArguments& arguments, const std::string& unit) {
  LogOptions options = read_log_options(arguments.reading, unit);
  if (!options.decimal_comma) options.decimal_comma = has_decimal_comma(arguments.part.decimal);
  return options;
}

/// Throws InputError: options that say how to read a log, where there is none.
void require_log(const RollArguments& arguments) {
  if (!arguments.roll.empty()) throw InputError("--roll chooses from a log: give a --log as well");
  if (!arguments.reading.any()) return;
  throw InputError(
      fmt::format("--{} is about a log: give a --log as well", !arguments.reading.columns.empty()   ? "columns"
                                                               : !arguments.reading.wrapped.empty() ? "wrapped"
                                                                                                    : "skip-bad"));
}

/// Throws InputError: options that say how to read a roll, where touches are given.
void require_no_roll(const RollArguments& arguments) {
  const auto refuse = [](bool given, const char* option) {
    if (given) throw InputError(fmt::format("{}: touches do not roll and have no use for it; leave it out", option));
  };
  refuse(!arguments.roll.empty(), "--roll");
  refuse(!arguments.reading.wrapped.empty(), "--wrapped");
  refuse(arguments.reading.skip_bad, "--skip-bad");
  if (!arguments.reading.columns.empty() && arguments.logs.empty()) {
    throw InputError("--columns is about a table: give it with --log, or leave --columns out");
  }
}

/// Throws InputError: a table of touches, or a file that was given before, whose rolls would count twice.
void require_log_of_rolls(const RollArguments& arguments, std::size_t k) {
  const std::string& path = arguments.logs[k];
  if (is_table_of_touches(path, arguments)) {
    throw InputError(
        fmt::format("{}: expected a log of a roll, with u and psi, found a table of touches: give them with --touch "
                    "X,Y[,NORMAL], or leave the rolls and --roll out",
                    path));
  }
  const auto until = arguments.logs.begin() + static_cast<std::ptrdiff_t>(k);
  if (std::find(arguments.logs.begin(), until, path) == until) return;
  throw InputError(fmt::format("--log {}: it is given twice, and its rolls would count twice: leave one out", path));
}

/// --roll all: the rolls of all logs, one after another, of a part that stays where it is.
void add_all_rolls(const RollArguments& arguments, const std::string& unit, Measurements& measured,
                   std::vector<std::string>& notes) {
  if (arguments.logs.empty()) throw InputError("--roll all takes the rolls of a log: give a --log as well");
  LogOptions options = log_options(arguments, unit);
  options.single_rows = true;
  measured.at_rest = true;
  for (std::size_t k = 0; k < arguments.logs.size(); ++k) {
    require_log_of_rolls(arguments, k);
    for (Log& roll : read_rolls(arguments.logs[k], options)) {
      add_log_notes(roll, notes);
      measured.rolls.push_back(std::move(roll));
    }
  }
}

/// Each finger its log, those with skin first.
void require_logs_of_wheels(const RollArguments& arguments) {
  const std::vector<std::string>& fingers = arguments.fingers;
  const auto first_wheel = std::find_if(fingers.begin(), fingers.end(), names_wheel);
  if (first_wheel == fingers.begin()) {
    throw InputError(fmt::format(
        "--finger {}: expected fingers with skin first, then wheels, and --log in the same order, as in --finger jaw "
        "--finger wheel,r=0.4 --log jaw.csv --log pin.csv; a wheel alone says nothing of a part that may lie anywhere",
        fingers.front()));
  }
  const auto late = std::find_if_not(first_wheel, fingers.end(), names_wheel);
  if (late != fingers.end()) {
    throw InputError(fmt::format(
        "--finger {}: expected fingers with skin before wheels, and --log in the same order; found it behind {}", *late,
        *first_wheel));
  }
  if (arguments.logs.size() == fingers.size()) return;
  throw InputError(
      fmt::format("--finger is given {} times and --log {}: beside a wheel expected a log for each finger, in the same "
                  "order; of a wheel x and y of its pin, without which any place on the part fits",
                  fingers.size(), counted(arguments.logs.size(), "time", "times")));
}

/// A log of each finger: those with skin, then the wheels'.
void add_logs_of_fingers(const RollArguments& arguments, const std::string& unit, Measurements& measured,
                         std::vector<std::string>& notes) {
  if (!arguments.roll.empty()) {
    throw InputError("--roll: it chooses from one log, and --log is given more than once; leave it out");
  }
  if (has_wheel(arguments)) require_logs_of_wheels(arguments);
  const LogOptions options = log_options(arguments, unit);
  std::vector<double> radii;
  for (const std::string& text : arguments.fingers) {
    if (names_wheel(text)) radii.push_back(read_wheel(text, unit));
  }
  const std::size_t count = arguments.logs.size() - radii.size();
  for (std::size_t k = 0; k < count; ++k) {
    Log log = read_log(arguments.logs[k], options);
    add_log_notes(log, notes);
    measured.rolls.push_back(std::move(log));
  }
  for (std::size_t k = 0; k < radii.size(); ++k) {
    measured.wheels.push_back({read_pin_log(arguments.logs[count + k], options), radii[k]});
    add_log_notes(measured.wheels.back().log.rows, notes);
  }
}

}  // namespace

bool has_wheel(const RollArguments& arguments) {
  return std::any_of(arguments.fingers.begin(), arguments.fingers.end(), names_wheel);
}

Measurements read_one_roll(const RollArguments& arguments, const Part& part, std::vector<std::string>& notes) {
  Measurements measured = read_readings(arguments.readings, part, notes);
  if (arguments.logs.empty()) {
    require_log(arguments);
  } else {
    measured.rolls = {read_roll(arguments.logs, arguments.roll, log_options(arguments, part.unit()), notes)};
  }
  return measured;
}

Measurements read_measurements(const std::vector<std::string>& touches, const RollArguments& arguments,
                               const Part& part, std::vector<std::string>& notes) {
  const bool is_all = arguments.roll == "all";
  const bool has_fingers =
      !is_all && (arguments.logs.size() > 2 || (has_wheel(arguments) && arguments.readings.empty()));
  const bool has_touches = !is_all && !has_fingers && are_touches(touches, arguments);
  const bool is_one_roll = !is_all && !has_fingers && !has_touches;
  if (has_touches) require_no_roll(arguments);
  Measurements measured =
      is_one_roll ? read_one_roll(arguments, part, notes) : read_readings(arguments.readings, part, notes);
  if (is_all) add_all_rolls(arguments, part.unit(), measured, notes);
  if (has_fingers) add_logs_of_fingers(arguments, part.unit(), measured, notes);
  add_touches(touches, arguments, part.unit(), measured, notes);
  return measured;
}

}  // namespace rollfix::app
