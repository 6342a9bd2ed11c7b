#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "documents/documents.hpp"
#include "rollfix/arguments/arguments.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/log.hpp"
#include "rollfix/program.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/teach.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kTeachExamples = R"(Examples:
  rollfix simulate gallery:cam --finger disk,r=0.2 --start 0 --length 7.6 --samples 600 -o around.csv
  rollfix teach around.csv --finger disk,r=0.2 -o taught.json
  rollfix locate taught.json --reading 0.9,40deg --tolerance 0.1deg
  rollfix teach around.csv --finger disk,r=0.2 --noise angle=1deg,slip=0.002 -o roughly.json
)";

struct TeachArguments {
  std::string log;
  std::vector<std::string> fingers;
  std::string noise;
  std::string corner_angle;
  LogArguments reading;
  std::string unit;
  OutputArgument output;
  bool bridge = false;
  bool open = false;
  bool allow_crossing = false;
  bool json = false;
};

TeachOptions options_of(const TeachArguments& arguments) {
  TeachOptions options;
  const std::vector<Finger> fingers = read_fingers(arguments.fingers, 1, arguments.unit);
  require_disks(fingers, "teach");
  if (!fingers.empty()) options.finger = fingers.front();
  options.noise = read_noise(arguments.noise, arguments.unit);
  options.bridge = arguments.bridge;
  options.open = arguments.open;
  if (!arguments.corner_angle.empty()) options.corner_angle = written_angle(arguments.corner_angle, "--corner-angle");
  if (options.bridge && options.open)
    throw InputError("--bridge closes the part, --open keeps it open: give one of them");
  return options;
}

/// What the figure shows of the roll.
TaughtRows rows_of(const Log& log, const TeachOptions& options, const Taught& taught) {
  const std::string closing = taught.closing == Closing::kept_open ? "kept open" : name_of(taught.closing);
  const bool closes = taught.closing != Closing::not_asked;
  return {dead_reckoned(log, options.finger), taught.lap, taught.gap, closes, closes ? closing : "kept open as asked"};
}

Report teach_report(const TeachArguments& arguments) {
  if (arguments.log.empty()) throw InputError("teach: expected a LOG of one roll around the part, found none");
  const TeachOptions options = options_of(arguments);
  require_part_output(arguments.output, arguments.json);
  const Log log = read_log(arguments.log, read_log_options(arguments.reading, arguments.unit));
  const Taught taught = rollfix::teach(log, options);
  const LoadedPart loaded{Part(taught.outline, {arguments.allow_crossing}), taught.outline.unit, {}, 0, {}};

  Report report;
  report.notes = taught.notes;
  add_log_notes(log, report.notes);
  const Inspection outcome = inspect(loaded.part);
  if (arguments.json) {
    report.data = format_taught(outcome, taught);
  } else {
    report.data = inspect_text(outcome, loaded);
  }
  add_part_output(
      arguments.output, loaded.part,
      [&] {
        return draw_part({&loaded.part, "", 640, {}, {}, rows_of(log, options, taught)});
      },
      report);
  return report;
}

}  // namespace

void add_teach_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<TeachArguments>();
  CLI::App* command = program.add_subcommand("teach", "A part without a drawing, from one full roll around it.");
  command->footer(kTeachExamples);
  command->add_option("LOG", arguments->log, "a tactile log, or distance,dturn of a drive; - for stdin")->type_name("");
  add_reading_arguments(*command, arguments->reading);
  add_skip_argument(*command, arguments->reading);
  add_unit_argument(*command, arguments->unit);
  add_finger_argument(*command, arguments->fingers);
  add_noise_argument(*command, arguments->noise);
  add_switch(*command, "--bridge", arguments->bridge, "close the gap by a piece, even if drift does not explain it");
  add_switch(*command, "--open", arguments->open, "the roll runs along an open curve: close nothing");
  command
      ->add_option("--corner-angle", arguments->corner_angle,
                   "there is a corner where neighbouring rows turn by at least this angle; default 59deg")
      ->type_name("ANGLE");
  add_switch(*command, "--allow-crossing", arguments->allow_crossing, "accept a course that crosses itself");
  add_output_argument(*command, arguments->output,
                      "the part, .json, which every command takes as PART; or a figure: .svg, .png, .pdf");
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/teach/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return teach_report(*arguments); }; });
}

}  // namespace rollfix::app
