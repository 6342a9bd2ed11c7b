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
#include "rollfix/locate/certificate.hpp"
#include "rollfix/locate/touch_arguments.hpp"
#include "rollfix/output/hold_text.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

bool has_wheel(const RollArguments& arguments) {
  return std::any_of(arguments.fingers.begin(), arguments.fingers.end(), names_wheel);
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

void require_options_of_hold(const RollArguments& arguments) {
  const std::string many = has_wheel(arguments) ? "fingers beside a wheel" : "three and more fingers";
  const auto refuse = [](bool given, const char* option, const std::string& why) {
    if (given) throw InputError(fmt::format("{}: {}; leave it out", option, why));
  };
  refuse(!arguments.readings.empty(), "--reading", many + " are taken from logs");
  refuse(!arguments.roll.empty(), "--roll", "it chooses from one log, and --log is given more than once");
  refuse(!arguments.facing.empty(), "--facing", "logs of u and psi contain it");
  refuse(!arguments.prior.empty(), "--prior", "it is not taken with " + many);
  refuse(!arguments.pose.heading.empty(), "--heading", many + " tell how the part lies themselves");
  refuse(!arguments.pose.pose.empty(), "--pose", many + " tell how the part lies themselves");
  refuse(!arguments.direction.empty(), "--direction", "logs of u and psi contain it");
  refuse(arguments.robust, "--robust", "outliers are not looked for with " + many);
  refuse(arguments.may_overlap, "--may-overlap", "overlapping fingers are not looked for with " + many);
  refuse(!arguments.clear.empty(), "--clear", "it is about touches");
  refuse(!arguments.squeezed.empty() && !has_wheel(arguments), "--squeezed",
         "it is about a finger with skin and a wheel without, wheel,r=R, that squeeze a part");
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
  if (has_wheel(arguments)) require_logs_of_wheels(arguments);
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

/// Logs with their fingers: those with skin, then the wheels'.
void read_hold_logs(const RollArguments& arguments, const LogOptions& options, const std::string& unit,
                    HoldProblem& problem, std::vector<std::string>& notes) {
  std::vector<std::string> skins;
  std::vector<double> radii;
  for (const std::string& text : arguments.fingers) {
    if (names_wheel(text)) {
      radii.push_back(read_wheel(text, unit));
    } else {
      skins.push_back(text);
    }
  }
  const std::size_t count = arguments.logs.size() - radii.size();
  for (std::size_t k = 0; k < count; ++k) {
    Log log = read_log(arguments.logs[k], options);
    add_log_notes(log, notes);
    problem.logs.push_back(std::move(log));
  }
  for (std::size_t k = 0; k < radii.size(); ++k) {
    problem.wheels.push_back({read_pin_log(arguments.logs[count + k], options), radii[k]});
    add_log_notes(problem.wheels.back().log.rows, notes);
  }
  problem.fingers = read_fingers(skins, count, unit);
}

HoldProblem read_hold_problem(const RollArguments& arguments, std::vector<std::string>& notes,
                              std::vector<Outline>* others) {
  require_options_of_hold(arguments);
  HoldProblem problem{load_part(arguments.part, notes, others), {}, {}};
  const std::string unit = problem.part.unit();
  LogOptions options = read_log_options(arguments.reading, unit);
  if (!options.decimal_comma) options.decimal_comma = has_decimal_comma(arguments.part.decimal);
  read_hold_logs(arguments, options, unit, problem, notes);
  if (!arguments.squeezed.empty()) problem.squeezed = read_angle(arguments.squeezed, "--squeezed");
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

bool are_many_fingers(const RollArguments& arguments) {
  return arguments.logs.size() > 2 || (has_wheel(arguments) && arguments.readings.empty());
}

Report locate_hold(const RollArguments& arguments, const TouchOutput& output) {
  require_figure_output(output.figure, output.json);
  require_certificate(output.certificate, output.figure.force, output.json, output.figure.file);
  Report report;
  std::vector<Outline> others;
  const HoldProblem problem = read_hold_problem(arguments, report.notes, &others);
  for (const Finger& finger : problem.fingers) {
    if (finger.is_disk() || (finger.is_jaw() && !problem.wheels.empty())) continue;
    report.notes.push_back(no_reach_note(finger));
    break;
  }
  const HoldAnswer answer = solve(problem);
  report.exit_code = exit_code_of(answer);
  report.data = output.json ? format_hold(answer) : hold_text(answer);
  if (!output.figure.file.empty()) {
    HoldFigure figure{&answer};
    figure.others = std::move(others);
    add_figure(output.figure, draw_hold(figure), report);
  }
  if (!output.certificate.empty()) {
    add_certificate(output.certificate, output.figure.force, problem, answer, report);
  }
  return report;
}

}  // namespace rollfix::app
