#include <fmt/format.h>

#include <memory>

#include "rollfix/commands.hpp"
#include "rollfix/error.hpp"
#include "rollfix/finger_argument.hpp"
#include "rollfix/locate_request.hpp"
#include "rollfix/observation.hpp"
#include "rollfix/reading_argument.hpp"
#include "rollfix/roll_argument.hpp"
#include "rollfix/usage.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kLocateExamples = R"(Examples (wing.csv and wing-roll.csv: from rollfix demo):
  rollfix locate gallery:ellipse,a=2,b=1 --reading 1.5,73.2deg
  rollfix locate wing.csv --reading 60.1,5.12deg --reading 120,18.39deg -o where.svg
  rollfix locate wing.csv --log wing-roll.csv --finger disk,r=10
  rollfix locate wing.csv --log wing-roll.csv --finger disk,r=10 --at 6.1,12.32 --json
  rollfix locate wing.csv --log wing-roll.csv --finger disk,r=10 --noise contact=0.05,angle=0.2deg,slip=0.002
Two fingers on a part that is free to move:
  rollfix locate gallery:cam --reading 0.7446832,-0.3983439,57.48184deg --reading 1.5,-0.8,110.97000deg
  rollfix locate gallery:cam --reading 1.5,-0.8,110.97000deg --facing -142.40990deg
  rollfix simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --length 1.5 --length -0.8 -o cam-rolls.csv
  rollfix locate gallery:cam --log cam-rolls.csv --finger disk,r=0.2 -o cam-pairs.svg
)";

/// What can't be meant, before any file is read.
void require_sensible(const LocateArguments& arguments) {
  const bool from_log = !arguments.logs.empty();
  if (arguments.readings.empty() && !from_log) {
    throw InputError("locate: expected --reading LENGTH,TURN or --log FILE, found neither");
  }
  if (!arguments.readings.empty() && from_log) {
    throw InputError("locate: expected --reading or --log, found both: they can't be of the same roll");
  }
  if (arguments.explain && arguments.fingers.empty()) {
    throw InputError("--explain lists what the finger can't reach: give --finger as well");
  }
  if (!arguments.roll.empty() && !from_log) throw InputError("--roll chooses from a log: give a --log as well");
  if (!arguments.instants.empty() && !from_log) throw InputError("--at picks instants of a log: give a --log as well");
  if (from_log && arguments.logs.front() == "-" && arguments.part.part == "-") {
    throw InputError("the part and the log can't both come from standard input: give one of them as a file");
  }
}

/// What the paper's algorithm has no use for.
void require_march(const LocateArguments& arguments) {
  const auto refuse = [](bool given, const char* option) {
    if (given) throw InputError(fmt::format("--march: the paper's algorithm has no use for {}; leave one out", option));
  };
  refuse(read_belief_options(arguments.noise).has_value(), "--noise");
  refuse(!arguments.facing.empty(), "--facing");
  refuse(!arguments.budget.empty(), "--budget");
  refuse(!arguments.output.file.empty(), "-o");
  refuse(arguments.explain, "--explain");
}

/// The same readings, asked of the paper's algorithm.
Report march_report(const LocateArguments& arguments, const std::vector<Log>& logs, bool two_fingers) {
  require_march(arguments);
  std::vector<std::string> notes;
  const Part part = load_part(arguments.part, notes);
  MarchQuestion question;
  question.step = read_step(arguments.march);
  question.json = arguments.json;
  std::vector<Rounding> roundings;
  if (two_fingers) {
    const std::optional<FingerPair> fingers = read_fingers(arguments.fingers);
    const PairObservation seen =
        logs.empty() ? observe_pair_readings(arguments.readings, "")
                     : observe_pair_log(paired(logs[0], logs[1]), part, fingers, read_instants(arguments.instants));
    for (const PairReading& reading : seen.readings) {
      question.readings.push_back({{reading.length_a, reading.length_b}, reading.turn});
    }
    roundings = seen.roundings;
  } else {
    const std::optional<Finger> finger = read_finger(arguments.fingers);
    const Observation seen = logs.empty() ? observe_readings(arguments.readings)
                                          : observe_log(logs.front(), part, finger, read_instants(arguments.instants));
    for (const Reading& reading : seen.readings) question.readings.push_back({{reading.length}, reading.turn});
    roundings = seen.roundings;
  }
  question.tolerance = tolerance_of(arguments, part, roundings).value;
  Report report = locate_by_march(part, question);
  report.notes = std::move(notes);
  return report;
}

Report locate_report(const LocateArguments& arguments) {
  require_sensible(arguments);
  require_figure_output(arguments.output, arguments.json);
  const ChosenRoll roll = arguments.logs.empty() ? ChosenRoll{} : read_roll(arguments.logs, arguments.roll);
  const std::vector<Log>& logs = roll.logs;
  const bool two_fingers = logs.empty() ? are_of_two_fingers(arguments.readings) : logs.size() == 2;
  if (!two_fingers && !arguments.facing.empty()) {
    throw InputError("--facing compares two fingers: expected --reading LA,LB,THETA with it");
  }
  read_step(arguments.march);
  Report report = arguments.march.march ? march_report(arguments, logs, two_fingers)
                  : two_fingers         ? locate_two(arguments, logs)
                                        : locate_one(arguments, logs);
  if (!roll.note.empty()) report.notes.insert(report.notes.begin(), roll.note);
  return report;
}

}  // namespace

void add_locate_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<LocateArguments>();
  CLI::App* command = program.add_subcommand("locate", "Every place on a part where a roll can have started.");
  command->footer(kLocateExamples);
  add_part_argument(*command, arguments->part);
  command
      ->add_option("--reading", arguments->readings,
                   "from the first contact: arc length travelled, along the stored outline, and turn of the tangent; "
                   "of two fingers both lengths and finger a's turn less finger b's: LA,LB,THETA")
      ->type_name("L,THETA")
      ->allow_extra_args(false);
  command->add_option("--log", arguments->logs, "a tactile log, - for stdin; of two fingers one file or two")
      ->type_name("FILE")
      ->allow_extra_args(false);
  add_roll_argument(*command, arguments->roll);
  add_finger_argument(*command, arguments->fingers);
  command
      ->add_option("--at", arguments->instants,
                   "instants of the log to use, seconds; default its last row, of two fingers also the middle one")
      ->type_name("T1,T2,...");
  command
      ->add_option(
          "--facing", arguments->facing,
          "how far finger a's contact normal is turned from finger b's at the first contacts; then one reading "
          "of two fingers suffices")
      ->type_name("ANGLE");
  command
      ->add_option("--tolerance", arguments->tolerance,
                   "how far the turn may be off; default 1e-9, or the rounding of the digits given, "
                   "or what --noise makes of it")
      ->type_name("ANGLE");
  add_noise_arguments(*command, arguments->noise);
  command
      ->add_option("--budget", arguments->budget,
                   "intervals to look at, beyond the part's own, before giving up; default 1000000")
      ->type_name("N");
  add_output_argument(*command, arguments->output,
                      "a figure of the placements: .svg, .png or .pdf, - for SVG on stdout");
  add_switch(*command, "--explain", arguments->explain,
             "list what fits and was dropped all the same, because the finger can't get there, and why");
  add_march_arguments(*command, arguments->march);
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/locate/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return locate_report(*arguments); }; });
}

}  // namespace rollfix::app
