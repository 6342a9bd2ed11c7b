#include "rollfix/locate/locate_rolls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/part_argument.hpp"
#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate/touch_arguments.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

void require_options_of_rolls(const RollArguments& arguments) {
  const auto refuse = [](bool given, const char* option, const char* why) {
    if (given) throw InputError(fmt::format("{}: {}; leave it out, or choose one roll with --roll N", option, why));
  };
  refuse(!arguments.readings.empty(), "--reading", "--roll all takes the rolls of a log");
  refuse(!arguments.facing.empty(), "--facing", "rolls with u and psi have it themselves");
  refuse(!arguments.instants.empty(), "--at", "--roll all takes rows all along every roll");
  refuse(!arguments.prior.empty(), "--prior", "it is of the start of one roll");
  refuse(!arguments.direction.empty(), "--direction", "rolls with u and psi say the direction themselves");
  refuse(arguments.may_overlap, "--may-overlap", "it is of two fingers");
  refuse(!arguments.clear.empty(), "--clear", "paths on which nothing was felt are taken with touches alone");
}

/// Throws InputError: a table of touches, or a file that was given before, whose rolls would count twice.
void require_log_of_rolls(const RollArguments& arguments, std::size_t k) {
  const std::string& path = arguments.logs[k];
  if (is_table_of_touches(path, arguments)) {
    throw InputError(
        fmt::format("{}: expected a log of a roll, with u and psi, found a table of touches: give them with --touch "
                    "X,Y[,NORMAL], or "
                    "leave the rolls and --roll out",
                    path));
  }
  if (std::find(arguments.logs.begin(), arguments.logs.begin() + static_cast<std::ptrdiff_t>(k), path) !=
      arguments.logs.begin() + static_cast<std::ptrdiff_t>(k)) {
    throw InputError(fmt::format("--log {}: it is given twice, and its rolls would count twice: leave one out", path));
  }
}

/// The rolls of all logs, one after another.
std::vector<Log> read_all_rolls(const RollArguments& arguments, const LogOptions& options,
                                std::vector<std::string>& notes) {
  std::vector<Log> rolls;
  for (const std::string& path : arguments.logs) {
    for (Log& roll : read_rolls(path, options)) {
      add_log_notes(roll, notes);
      rolls.push_back(std::move(roll));
    }
  }
  return rolls;
}

/// --tolerance of rolls alone: an angle, as of one roll, or LENGTH,ANGLE; of touches too: as these have it.
TouchTolerance read_tolerance(const std::string& text, bool has_touches, const std::string& unit) {
  const bool is_angle = text.find(',') == std::string::npos && !has_touches;
  return is_angle ? TouchTolerance{0, read_angle(text, "--tolerance")} : read_touch_tolerance(text, unit);
}

TouchProblem read_rolls_problem(const std::vector<std::string>& touches, const RollArguments& arguments,
                                std::vector<std::string>& notes, std::vector<Outline>* others) {
  require_options_of_rolls(arguments);
  TouchProblem problem{load_part(arguments.part, notes, others), {}};
  const std::string unit = problem.part.unit();
  LogOptions options = read_log_options(arguments.reading, unit);
  if (!options.decimal_comma) options.decimal_comma = has_decimal_comma(arguments.part.decimal);
  options.single_rows = true;
  problem.rolls = read_all_rolls(arguments, options, notes);
  for (const std::string& text : touches) problem.touches.push_back(read_touch(text, unit));
  const std::vector<Finger> fingers = read_fingers(arguments.fingers, 1, unit);
  if (!touches.empty()) require_disks(fingers, "--touch");
  if (!fingers.empty()) problem.finger = fingers.front();
  problem.noise = read_noise(arguments.noise, unit);
  if (!arguments.tolerance.empty()) {
    if (problem.noise) throw InputError("--tolerance: --noise already says how far rows are off; leave one out");
    problem.tolerance = read_tolerance(arguments.tolerance, !touches.empty(), unit);
  }
  problem.pose = read_pose(arguments.pose, unit);
  problem.mirrored = arguments.mirror;
  problem.robust = arguments.robust;
  if (!arguments.budget.empty()) problem.budget = read_count(arguments.budget, "--budget", 1);
  return problem;
}

}  // namespace

bool are_contacts(const std::vector<std::string>& touches, const RollArguments& arguments) {
  if (arguments.roll != "all") return false;
  if (arguments.logs.empty()) throw InputError("--roll all takes the rolls of a log: give a --log as well");
  for (std::size_t k = 0; k < arguments.logs.size(); ++k) require_log_of_rolls(arguments, k);
  if (!touches.empty() || arguments.logs.size() > 1) return true;
  LogOptions options = read_log_options(arguments.reading, "");
  if (!options.decimal_comma) options.decimal_comma = has_decimal_comma(arguments.part.decimal);
  options.single_rows = true;
  return arguments.logs.front() == "-" || read_rolls(arguments.logs.front(), options).size() > 1;
}

Report locate_rolls(const std::vector<std::string>& touches, const RollArguments& arguments,
                    const TouchOutput& output) {
  require_outputs(output);
  Report report;
  std::vector<Outline> others;
  const TouchProblem problem = read_rolls_problem(touches, arguments, report.notes, &others);
  return report_of(problem, std::move(others), output, std::move(report));
}

}  // namespace rollfix::app
