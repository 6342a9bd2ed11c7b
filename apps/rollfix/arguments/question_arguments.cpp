#include "rollfix/arguments/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "rollfix/error.hpp"
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

namespace {

/// Throws InputError before anything is read: standard input can't be two things.
void require_one_from_stdin(const std::vector<std::string>& touches, const RollArguments& arguments) {
  const auto count = std::count(arguments.logs.begin(), arguments.logs.end(), "-");
  if (count == 0 || (count == 1 && arguments.part.part != "-")) return;
  if (arguments.logs.size() > 1) {
    throw InputError("more than one thing can't come from standard input: give the others as files");
  }
  throw InputError(fmt::format("the part and the {} can't both come from standard input: give one of them as a file",
                               are_touches(touches, arguments) ? "touches" : "log"));
}

std::vector<double> read_instants(const std::string& text) {
  std::vector<double> instants;
  if (text.empty()) return instants;
  for (const std::string_view field : split(text, ',')) {
    instants.push_back(read_number(field, fmt::format("--at {}", text)));
  }
  return instants;
}

std::optional<Direction> read_direction(const std::string& text) {
  if (text.empty()) return std::nullopt;
  if (text == "either") return Direction::either;
  return counts_clockwise(text) ? Direction::clockwise : Direction::counterclockwise;
}

/// Those with skin: wheels are among the measurements.
std::vector<Finger> read_skins(const RollArguments& arguments, const Question& question) {
  const Measurements& measured = question.measured;
  const std::string unit = question.part.unit();
  switch (kind_of(question)) {
    case QuestionKind::moving: {
      std::vector<std::string> skins;
      std::copy_if(arguments.fingers.begin(), arguments.fingers.end(), std::back_inserter(skins),
                   [](const std::string& text) { return !names_wheel(text); });
      return read_fingers(skins, measured.rolls.size(), unit);
    }
    case QuestionKind::at_rest: {
      std::vector<Finger> fingers = read_fingers(arguments.fingers, 1, unit);
      if (!measured.touches.empty()) require_disks(fingers, "--touch");
      return fingers;
    }
    case QuestionKind::roll:
      break;
  }
  const bool is_log = !measured.rolls.empty();
  const bool of_two = is_log ? measured.rolls.front().fingers.size() == 2
                             : !measured.readings.empty() && measured.readings.front().fingers() == 2;
  return read_fingers(arguments.fingers, of_two ? 2 : 1, unit);
}

/// An angle of one roll; of touches LENGTH or LENGTH,ANGLE, of what else shares a pose an angle or both.
std::optional<TouchTolerance> read_tolerance(const std::string& text, const Question& question) {
  if (text.empty()) return std::nullopt;
  const bool is_roll = kind_of(question) == QuestionKind::roll;
  const bool is_angle = question.measured.touches.empty() && text.find(',') == std::string::npos;
  if (!is_roll && !is_angle) return read_touch_tolerance(text, question.part.unit());
  const double angle = written_angle(text, "--tolerance");
  if (is_roll && angle < 0) {
    throw InputError(fmt::format("--tolerance: '{}' is negative, expected an angle of at least 0", text));
  }
  return TouchTolerance{0, angle};
}

Question question_of(Part part, Measurements measured, const RollArguments& arguments) {
  const std::string unit = part.unit();
  Question question(std::move(part), std::move(measured));
  question.fingers = read_skins(arguments, question);
  question.noise = read_noise(arguments.noise, unit);
  question.prior = read_prior(arguments.prior, unit);
  question.pose = read_pose(arguments.pose, unit);
  question.at = read_instants(arguments.instants);
  question.direction = read_direction(arguments.direction);
  question.mirrored = arguments.mirror;
  question.robust = arguments.robust;
  question.may_overlap = arguments.may_overlap;
  if (!arguments.facing.empty()) {
    question.facing = written_angle(arguments.facing, "--facing");
    question.measured.roundings.push_back({0, half_unit_of_angle(arguments.facing)});
  }
  if (!arguments.squeezed.empty()) question.squeezed = written_angle(arguments.squeezed, "--squeezed");
  question.tolerance = read_tolerance(arguments.tolerance, question);
  if (!arguments.budget.empty()) question.budget = read_count(arguments.budget, "--budget", 1);
  return question;
}

}  // namespace

Question read_question(const std::vector<std::string>& touches, const RollArguments& arguments, Part part,
                       std::vector<std::string>& notes) {
  Measurements measured = read_measurements(touches, arguments, part, notes);
  return question_of(std::move(part), std::move(measured), arguments);
}

Question read_question(const std::vector<std::string>& touches, const RollArguments& arguments,
                       std::vector<std::string>& notes, std::vector<Outline>* others) {
  require_one_from_stdin(touches, arguments);
  std::vector<std::string> of_part;
  Part part = load_part(arguments.part, of_part, others);
  Question question = read_question(touches, arguments, std::move(part), notes);
  notes.insert(notes.end(), of_part.begin(), of_part.end());
  return question;
}

Problem read_problem(const RollArguments& arguments, Part part, std::vector<std::string>& notes) {
  Measurements measured = read_one_roll(arguments, part, notes);
  return roll_problem(question_of(std::move(part), std::move(measured), arguments));
}

Problem read_problem(const RollArguments& arguments, std::vector<std::string>& notes, std::vector<Outline>* others) {
  require_one_from_stdin({}, arguments);
  std::vector<std::string> of_part;
  Part part = load_part(arguments.part, of_part, others);
  Problem problem = read_problem(arguments, std::move(part), notes);
  notes.insert(notes.end(), of_part.begin(), of_part.end());
  return problem;
}

TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments,
                                std::vector<std::string>& notes, std::vector<Outline>* others) {
  return rest_problem(read_question(touches, arguments, notes, others));
}

TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments, Part part,
                                std::vector<std::string>& notes) {
  return rest_problem(read_question(touches, arguments, std::move(part), notes));
}

}  // namespace rollfix::app
