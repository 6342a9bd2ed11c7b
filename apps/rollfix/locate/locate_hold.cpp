#include "rollfix/locate/locate_hold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/part_argument.hpp"
#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/draw/hold_figure.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files/hold_document.hpp"
#include "rollfix/hold/hold.hpp"
#include "rollfix/locate/touch_arguments.hpp"
#include "rollfix/output/hold_text.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

void require_options_of_hold(const RollArguments& arguments) {
  const auto refuse = [](bool given, const char* option, const char* why) {
    if (given) throw InputError(fmt::format("{}: {}; leave it out", option, why));
  };
  refuse(!arguments.readings.empty(), "--reading", "three and more fingers are taken from logs");
  refuse(!arguments.roll.empty(), "--roll", "it chooses from one log, and --log is given more than once");
  refuse(!arguments.facing.empty(), "--facing", "logs of u and psi contain it");
  refuse(!arguments.prior.empty(), "--prior", "it is not taken with three and more fingers");
  refuse(!arguments.pose.heading.empty(), "--heading", "three and more fingers tell how the part lies themselves");
  refuse(!arguments.pose.pose.empty(), "--pose", "three and more fingers tell how the part lies themselves");
  refuse(!arguments.direction.empty(), "--direction", "logs of u and psi contain it");
  refuse(arguments.robust, "--robust", "outliers are not looked for with three and more fingers");
  refuse(arguments.may_overlap, "--may-overlap", "overlapping fingers are not looked for with three and more");
  refuse(!arguments.clear.empty(), "--clear", "it is about touches");
  if (!arguments.noise.empty() && !arguments.instants.empty()) {
    throw InputError("--at: with --noise all rows are used; leave it out");
  }
  if (!arguments.noise.empty() && !arguments.tolerance.empty()) {
    throw InputError("--tolerance: --noise already says how far rows are off; leave one out");
  }
  if (arguments.fingers.empty()) {
    throw InputError(fmt::format(
        "--log is given {} times, which is as many fingers on a part that is free to move: expected --finger, "
        "once for all or once for each; rolls of one finger on a part at rest are --roll all",
        arguments.logs.size()));
  }
  const auto from_stdin = std::count(arguments.logs.begin(), arguments.logs.end(), "-");
  if (from_stdin > 1 || (from_stdin == 1 && arguments.part.part == "-")) {
    throw InputError("more than one thing can't come from standard input: give the others as files");
  }
}

std::vector<double> read_hold_instants(const std::string& text) {
  std::vector<double> instants;
  if (text.empty()) return instants;
  for (const std::string_view field : split(text, ',')) {
    instants.push_back(read_number(field, fmt::format("--at {}", text)));
  }
  return instants;
}

HoldProblem read_hold_problem(const RollArguments& arguments, std::vector<std::string>& notes,
                              std::vector<Outline>* others) {
  require_options_of_hold(arguments);
  HoldProblem problem{load_part(arguments.part, notes, others), {}, {}};
  const std::string unit = problem.part.unit();
  LogOptions options = read_log_options(arguments.reading, unit);
  if (!options.decimal_comma) options.decimal_comma = has_decimal_comma(arguments.part.decimal);
  for (const std::string& path : arguments.logs) {
    Log log = read_log(path, options);
    add_log_notes(log, notes);
    problem.logs.push_back(std::move(log));
  }
  problem.fingers = read_fingers(arguments.fingers, arguments.logs.size(), unit);
  problem.noise = read_noise(arguments.noise, unit);
  if (!arguments.tolerance.empty()) {
    const bool is_angle = arguments.tolerance.find(',') == std::string::npos;
    problem.tolerance = is_angle ? TouchTolerance{0, read_angle(arguments.tolerance, "--tolerance")}
                                 : read_touch_tolerance(arguments.tolerance, unit);
  }
  problem.at = read_hold_instants(arguments.instants);
  problem.mirrored = arguments.mirror;
  if (!arguments.budget.empty()) problem.budget = read_count(arguments.budget, "--budget", 1);
  return problem;
}

}  // namespace

bool are_many_fingers(const RollArguments& arguments) { return arguments.logs.size() > 2; }

Report locate_hold(const RollArguments& arguments, const TouchOutput& output) {
  require_figure_output(output.figure, output.json);
  Report report;
  std::vector<Outline> others;
  const HoldProblem problem = read_hold_problem(arguments, report.notes, &others);
  for (const Finger& finger : problem.fingers) {
    if (finger.is_disk()) continue;
    report.notes.push_back(no_reach_note(finger));
    break;
  }
  const HoldAnswer answer = solve(problem);
  report.exit_code = exit_code_of(answer);
  report.data = output.json ? format_hold(answer) : hold_text(answer);
  if (output.figure.file.empty()) return report;
  HoldFigure figure{&answer};
  figure.others = std::move(others);
  add_figure(output.figure, draw_hold(figure), report);
  return report;
}

}  // namespace rollfix::app
