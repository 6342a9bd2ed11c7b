#include <fmt/format.h>

#include <memory>
#include <optional>

#include "rollfix/commands.hpp"
#include "rollfix/draw/locate_figure.hpp"
#include "rollfix/error.hpp"
#include "rollfix/finger_argument.hpp"
#include "rollfix/locate_outcome.hpp"
#include "rollfix/observation.hpp"
#include "rollfix/output_argument.hpp"
#include "rollfix/part_argument.hpp"
#include "rollfix/typed_number.hpp"
#include "rollfix/usage.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kExamples = R"(Examples (wing.csv and wing-roll.csv: from rollfix demo):
  rollfix locate gallery:ellipse,a=2,b=1 --reading 1.5,73.2deg
  rollfix locate wing.csv --reading 60.1,5.12deg --reading 120,18.39deg -o where.svg
  rollfix locate wing.csv --log wing-roll.csv --finger disk,r=10
  rollfix locate wing.csv --log wing-roll.csv --finger disk,r=10 --at 6.1,12.32 --json
)";

struct LocateArguments {
  PartArgument part;
  std::vector<std::string> readings;
  std::vector<std::string> logs;
  std::vector<std::string> fingers;
  std::string instants;
  std::string tolerance;
  std::string budget;
  bool json = false;
  OutputArgument output;
};

/// What can't be meant, before any file is read.
void require_sensible(const LocateArguments& arguments) {
  const bool from_log = !arguments.logs.empty();
  if (arguments.logs.size() > 1) throw InputError("--log is given twice, which is two fingers: not there yet");
  if (arguments.readings.empty() && !from_log) {
    throw InputError("locate: expected --reading LENGTH,TURN or --log FILE, found neither");
  }
  if (!arguments.readings.empty() && from_log) {
    throw InputError("locate: expected --reading or --log, found both: they can't be of the same roll");
  }
  if (!arguments.instants.empty() && !from_log) throw InputError("--at picks instants of a log: give a --log as well");
  if (from_log && arguments.logs.front() == "-" && arguments.part.part == "-") {
    throw InputError("the part and the log can't both come from standard input: give one of them as a file");
  }
}

Observation observe(const LocateArguments& arguments, const Part& part, const std::optional<DiskFinger>& finger) {
  if (arguments.logs.empty()) return observe_readings(arguments.readings);
  return observe_log(read_log(arguments.logs.front()), part, finger, read_instants(arguments.instants));
}

ExitCode exit_code_of(const Search& found) {
  if (found.status == Status::incomplete) return ExitCode::incomplete;
  return found.placements.empty() ? ExitCode::nothing_fits : ExitCode::fits;
}

LocateOutcome search(const LocateArguments& arguments, const Part& part, const Observation& observation) {
  LocateOutcome outcome{part, observation.readings, observation.instants, {}, {}};
  outcome.tolerance = arguments.tolerance.empty() ? tolerance_from_rounding(part, observation.roundings)
                                                  : tolerance_from_option(arguments.tolerance);
  LocateOptions options;
  options.tolerance = outcome.tolerance.value;
  if (!arguments.budget.empty()) options.budget = read_count(arguments.budget, "--budget", 1);
  outcome.found = locate(part, outcome.readings, options);
  return outcome;
}

Report locate_report(const LocateArguments& arguments) {
  require_sensible(arguments);
  require_figure_output(arguments.output, arguments.json);
  const std::optional<DiskFinger> finger = read_finger(arguments.fingers);
  const Part part = load_part(arguments.part);
  const Observation observation = observe(arguments, part, finger);
  const LocateOutcome outcome = search(arguments, part, observation);

  Report report;
  report.exit_code = exit_code_of(outcome.found);
  report.data = arguments.json ? json_text(locate_json(outcome)) : locate_text(outcome);
  if (part.reversed()) report.notes.push_back(reversed_note(part));
  if (observation.lengths_turned_round) report.notes.emplace_back("the log's lengths changed their signs to match");
  if (!arguments.output.file.empty()) {
    LocateFigure figure;
    figure.part = &part;
    figure.readings = outcome.readings;
    figure.found = outcome.found;
    if (finger) figure.finger_radius = finger->radius;
    add_figure(arguments.output, draw_placements(figure), report);
  }
  return report;
}

}  // namespace

void add_locate_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<LocateArguments>();
  CLI::App* command = program.add_subcommand("locate", "Every place on a part where a roll can have started.");
  command->footer(kExamples);
  add_part_argument(*command, arguments->part);
  command
      ->add_option("--reading", arguments->readings,
                   "from the first contact: arc length travelled, along the stored outline, and turn of the tangent")
      ->type_name("L,THETA")
      ->allow_extra_args(false);
  command->add_option("--log", arguments->logs, "a tactile log, - for stdin")
      ->type_name("FILE")
      ->allow_extra_args(false);
  add_finger_argument(*command, arguments->fingers);
  command->add_option("--at", arguments->instants, "instants of the log to use, seconds; default its last row")
      ->type_name("T1,T2,...");
  command
      ->add_option("--tolerance", arguments->tolerance,
                   "how far the turn may be off; default 1e-9, or the rounding of the digits given")
      ->type_name("ANGLE");
  command
      ->add_option("--budget", arguments->budget,
                   "intervals to look at, beyond the part's own, before giving up; default 1000000")
      ->type_name("N");
  add_output_argument(*command, arguments->output,
                      "a figure of the placements: .svg, .png or .pdf, - for SVG on stdout");
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/locate/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return locate_report(*arguments); }; });
}

}  // namespace rollfix::app
