#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "rollfix/commands.hpp"
#include "rollfix/draw/part_figure.hpp"
#include "rollfix/inspect_outcome.hpp"
#include "rollfix/output_argument.hpp"
#include "rollfix/part_argument.hpp"
#include "rollfix/usage.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kExamples = R"(Examples:
  rollfix inspect gallery:ellipse,a=2,b=1
  rollfix inspect wing.csv -o inspected.svg    # wing.csv: from rollfix demo
  rollfix inspect gallery:spline,seed=7 --json
)";

struct InspectArguments {
  PartArgument part;
  OutputArgument output;
  bool json = false;
};

Report inspect(const InspectArguments& arguments) {
  require_figure_output(arguments.output, arguments.json);
  const Part part = load_part(arguments.part);
  const InspectOutcome outcome = look_at(part);
  Report report;
  report.data = arguments.json ? json_text(inspect_json(outcome)) : inspect_text(outcome);
  if (part.reversed()) report.notes.push_back(reversed_note(part));
  if (!arguments.output.file.empty()) add_figure(arguments.output, draw_part({&part, "", 640}), report);
  return report;
}

}  // namespace

void add_inspect_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<InspectArguments>();
  CLI::App* command = program.add_subcommand(
      "inspect", "What a part is: size, inflections, vertices, corners, and how ambiguous rolls on it are.");
  command->footer(kExamples);
  add_part_argument(*command, arguments->part);
  add_output_argument(*command, arguments->output, "a figure of the part: .svg, .png or .pdf, - for SVG on stdout");
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/inspect/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return inspect(*arguments); }; });
}

}  // namespace rollfix::app
