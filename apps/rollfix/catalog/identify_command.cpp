#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/arguments/catalog_argument.hpp"
#include "rollfix/arguments/measured_arguments.hpp"
#include "rollfix/arguments/output_argument.hpp"
#include "rollfix/arguments/question_arguments.hpp"
#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/catalog/identify_text.hpp"
#include "rollfix/commands.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/locate/touch_arguments.hpp"
#include "rollfix/usage.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kIdentifyExamples = R"(Examples:
  rollfix catalog build sections/ -o parts.db
  rollfix identify parts.db --log roll.csv --finger disk,r=10 --noise contact=0.05,angle=0.2deg
  rollfix identify parts.db --reading 60.1,5.12deg --reading 120,18.39deg --json
  rollfix identify parts.db --log roll.csv --finger disk,r=10 --noise contact=0.05,angle=0.2deg -o which.svg
Touches without rolling, of a part at rest:
  rollfix identify parts.db --touch 106.5,94.4 --touch 158.0,50.0 --touch 192.9,57.6 --finger disk,r=3 --noise position=0.02
  rollfix identify parts.db --log touches.csv --finger disk,r=3 --noise position=0.02,angle=2deg --json
Several rolls of a finger, and touches, of a part at rest:
  rollfix identify parts.db --log run.csv --roll all --finger disk,r=10 --noise contact=0.05,angle=0.2deg,position=0.05
)";

struct IdentifyArguments {
  std::string catalog;
  RollArguments roll;
  std::vector<std::string> touches;
  std::string jobs;
  bool without_index = false;
  bool json = false;
  OutputArgument output;
};

/// What is asked of every part.
Problem read_question(const IdentifyArguments& arguments, const Catalog& catalog, std::vector<std::string>& notes) {
  const RollArguments& roll = arguments.roll;
  if (roll.readings.empty() && roll.logs.empty()) {
    throw InputError("identify: expected --reading LENGTH,TURN, --log FILE or --touch X,Y, found none");
  }
  if (!roll.clear.empty()) {
    throw InputError(
        "--clear is about touches and several rolls: give --touch, or rolls with --roll all, or leave --clear out");
  }
  if (!roll.readings.empty() && !roll.logs.empty()) {
    throw InputError("identify: expected --reading or --log, found both: they can't be of the same roll");
  }
  require_no_prior(roll.prior);
  return read_problem(roll, any_part_of(catalog), notes);
}

Report of_document(const std::string& text, const IdentifyArguments& arguments, const Catalog& catalog, Report report) {
  const Json document = Json::parse(text);
  report.exit_code = exit_code_of(document);
  report.data = arguments.json ? text : identify_text(document, catalog.unit());
  return report;
}

Svg figure_of(const Identified& found, const Catalog& catalog) {
  PartsFigure figure;
  figure.verdict = found.verdict;
  figure.of = found.asked;
  figure.rest = found.rest;
  for (const PartFound& part : found.parts) {
    PartsFigure::Entry entry{catalog.entry(part.weight.part).name, part.probability, &part.answer};
    for (const std::size_t other : part.congruent) entry.congruent.push_back(catalog.entry(other).name);
    figure.parts.push_back(std::move(entry));
  }
  return draw_parts(figure);
}

/// By touches, or by several rolls and touches, of which --roll all says that they share a pose.
Report report_of_contacts(const TouchProblem& question, const IdentifyArguments& arguments, const Catalog& catalog,
                          const IdentifyOptions& options, Report report) {
  if (!arguments.output.file.empty()) {
    throw InputError(fmt::format("-o: a figure is of one roll; of {} draw the part: rollfix locate PART with the same",
                                 question.rolls.empty() ? "touches" : "several rolls"));
  }
  const IdentifiedByTouches found = identify(catalog, question, options);
  return of_document(format_identified(catalog, found), arguments, catalog, std::move(report));
}

Report identify_report(const IdentifyArguments& arguments) {
  if (arguments.catalog.empty()) throw InputError("identify: expected a CATALOG: rollfix catalog build makes one");
  require_figure_output(arguments.output, arguments.json);
  if (has_wheel(arguments.roll)) {
    throw InputError(
        "identify: a wheel without skin is taken beside a known part: ask rollfix locate of each part that it may be, "
        "or "
        "give the logs of fingers with skin alone");
  }
  const Catalog catalog(arguments.catalog);
  IdentifyOptions options;
  options.use_index = !arguments.without_index;
  if (!arguments.jobs.empty()) options.threads = static_cast<unsigned>(read_count(arguments.jobs, "--jobs", 1));
  Report report;
  const bool may_share_a_pose = arguments.roll.roll == "all" || are_touches(arguments.touches, arguments.roll);
  const Question asked = may_share_a_pose
                             ? app::read_question(arguments.touches, arguments.roll, any_part_of(catalog), report.notes)
                             : Question(any_part_of(catalog), {});
  if (may_share_a_pose && kind_of(asked) == QuestionKind::at_rest) {
    return report_of_contacts(rest_problem(asked), arguments, catalog, options, std::move(report));
  }
  const Problem question = may_share_a_pose ? roll_problem(asked) : read_question(arguments, catalog, report.notes);
  const Identified found = identify(catalog, question, options);
  report = of_document(format_identified(catalog, found), arguments, catalog, std::move(report));
  if (!arguments.output.file.empty()) add_figure(arguments.output, figure_of(found, catalog), report);
  return report;
}

}  // namespace

void add_identify_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* command =
      program.add_subcommand("identify", "Which parts of a catalog a roll or touches fit, and where on each.");
  command->footer(kIdentifyExamples);
  command->add_option("CATALOG", arguments->catalog, "as catalog build makes it");
  add_felt_arguments(*command, arguments->roll, true);
  add_touch_arguments(*command, arguments->touches, arguments->roll);
  command
      ->add_option("--at", arguments->roll.instants,
                   "instants of the log to use, seconds; default all rows, as exact as their digits or the noise say")
      ->type_name("T1,T2,...");
  command
      ->add_option(
          "--facing", arguments->roll.facing,
          "how far finger a's contact normal is turned from finger b's at the first contacts; then one reading "
          "of two fingers suffices")
      ->type_name("ANGLE");
  command->add_option("--budget", arguments->roll.budget, "intervals to examine on a part before giving up")
      ->type_name("N");
  command->add_option("--jobs", arguments->jobs, "threads; default as many as there are processors")->type_name("N");
  add_switch(*command, "--without-index", arguments->without_index,
             "search every part, without bounds: slow, to check that the bounds lose nothing");
  add_output_argument(*command, arguments->output,
                      "a figure of the parts that remain: .svg, .png or .pdf, - for SVG on stdout");
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/identify/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return identify_report(*arguments); }; });
}

}  // namespace rollfix::app
