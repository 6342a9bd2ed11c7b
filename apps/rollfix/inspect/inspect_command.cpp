#include <fmt/format.h>

#include <memory>

#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/output_argument.hpp"
#include "rollfix/arguments/part_argument.hpp"
#include "rollfix/commands.hpp"
#include "rollfix/documents.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/inspect/inspect_outcome.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/usage.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kInspectExamples = R"(Examples:
  rollfix inspect gallery:ellipse,a=2,b=1
  rollfix inspect wing.csv -o inspected.svg    # wing.csv: from rollfix demo
  rollfix inspect gallery:spline,seed=7 --json
  rollfix inspect plate.dxf                    # from rollfix demo; lists its loops, --loop 2 takes the hole
  rollfix inspect wing.csv --smooth 0.05 -o wing.json    # as a scan; saved, and taken by every command
  rollfix inspect wing.csv -o outline.csv    # as numbers: s, x, y, the tangent's direction and the curvature
  rollfix inspect gallery:gear --finger disk,r=0.1 -o reach.svg    # where can that finger touch at all?
)";

struct InspectArguments {
  PartArgument part;
  std::vector<std::string> fingers;
  OutputArgument output;
  bool json = false;
};

Report inspect_report(const InspectArguments& arguments) {
  require_part_output(arguments.output, arguments.json);
  const LoadedPart loaded = load(arguments.part);
  const std::vector<Finger> fingers = read_fingers(arguments.fingers, 1, loaded.part.unit());
  const std::optional<Finger> finger = fingers.empty() ? std::nullopt : std::optional<Finger>(fingers.front());
  if (finger && !has_reach(*finger)) {
    throw InputError(
        fmt::format("--finger {}: where a finger can touch is known of disks and jaws only", finger->name()));
  }
  const Part& part = loaded.part;
  const Inspection outcome = inspect(part, finger);
  Report report;
  report.notes = loaded.notes;
  report.data = arguments.json ? format_inspection(outcome, loaded) : inspect_text(outcome, loaded);
  if (part.reversed()) report.notes.push_back(reversed_note(part));
  add_part_output(
      arguments.output, part,
      [&] {
        return draw_part({&part, "", 640, outcome.reach, other_loops(loaded)});
      },
      report);
  return report;
}

}  // namespace

void add_inspect_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<InspectArguments>();
  CLI::App* command = program.add_subcommand(
      "inspect", "What a part is: size, inflections, vertices, corners, and how ambiguous rolls on it are.");
  command->footer(kInspectExamples);
  add_part_argument(*command, arguments->part);
  add_finger_argument(*command, arguments->fingers);
  add_output_argument(*command, arguments->output,
                      "a figure of the part: .svg, .png or .pdf, - for SVG on stdout; .json: its outline, which every "
                      "command takes as PART; .csv: the outline as numbers, s,x,y,tangent,curvature");
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/inspect/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return inspect_report(*arguments); }; });
}

}  // namespace rollfix::app
