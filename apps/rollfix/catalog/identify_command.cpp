#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "documents/documents.hpp"
#include "documents/json_output.hpp"
#include "log/jitter.hpp"
#include "outline/turn.hpp"
#include "rollfix/arguments/arguments.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/program.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

std::string places(const Json& numbers) {
  std::vector<std::string> all;
  for (const Json& number : numbers) all.push_back(fixed(number.get<double>(), decimals_for(number.get<double>())));
  return fmt::format("{}", fmt::join(all, ", "));
}

std::string probability(const Json& number) {
  constexpr double kLeast = 0.00005;
  if (number.is_null()) return "-";
  return number.get<double>() < kLeast ? "<0.0001" : fmt::format("{:.4f}", number.get<double>());
}

/// A row for each placement, the part's name and probability in its first.
std::string parts_table(const Json& document, const std::string& unit) {
  const bool has_noise = !document["noise"].is_null();
  Table table;
  table.add_column("part", Table::Align::left);
  if (has_noise) table.add_column("probability");
  table.add_column("there", Table::Align::left);
  if (has_noise) table.add_column("place's");
  for (const char* title : {"start", "end"}) table.add_column(title_in(title, unit));
  std::size_t rows = 0;
  std::size_t left_out = 0;
  for (const Json& part : document["parts"]) {
    bool is_first = true;
    for (const Json& placement : part["placements"]) {
      if (++rows > kMostRows) {
        ++left_out;
        continue;
      }
      std::vector<std::string> cells{is_first ? part["name"].get<std::string>() : ""};
      if (has_noise) cells.push_back(is_first ? probability(part["probability"]) : "");
      std::string kind = placement["kind"].get<std::string>();
      if (placement.contains("direction")) kind += " " + placement["direction"].get<std::string>();
      cells.push_back(kind);
      if (has_noise) cells.push_back(probability(placement["probability"]));
      cells.push_back(places(placement["start"]));
      cells.push_back(places(placement["end"]));
      table.add_row(std::move(cells));
      is_first = false;
    }
  }
  const std::string more =
      left_out == 0 ? ""
                    : fmt::format("... and {} more; --json lists them all\n", counted(left_out, "place", "places"));
  return table.str() + more;
}

// Of a part with a symmetry, or of a continuum, no more poses are shown.
constexpr std::size_t kMostPoses = 4;

Table table_of_poses(bool has_noise, const std::string& unit) {
  Table table;
  table.add_column("part", Table::Align::left);
  if (has_noise) table.add_column("probability");
  if (has_noise) table.add_column("pose's");
  for (const std::string& title : {title_in("x", unit), title_in("y", unit), std::string("heading [deg]")}) {
    table.add_column(title);
    if (has_noise) table.add_column("±");
  }
  table.add_column("", Table::Align::left);
  return table;
}

/// x, y and heading of a pose, with noise each with its standard deviation; null: of any pose, of rolls without x and y
/// of any place.
void add_pose_cells(const Json& pose, bool has_noise, std::vector<std::string>& cells) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double factor = i < 2 ? 1 : 1 / kDegree;
    const bool is_any = pose.is_null() || pose["pose"][0][i].is_null() || (i == 2 && pose["any_heading"].get<bool>());
    const double value = is_any ? 0 : factor * pose["pose"][0][i].get<double>();
    cells.push_back(is_any ? "any" : fixed(value, i < 2 ? decimals_for(value) : 3));
    if (!has_noise) continue;
    const double variance = is_any ? 0 : pose["pose_covariance"][i][i].get<double>();
    cells.push_back(is_any ? "-" : rough(factor * std::sqrt(std::max(0.0, variance))));
  }
}

/// Of touches: a row for each pose.
std::string poses_table(const Json& document, const std::string& unit) {
  const bool has_noise = !document["noise"].is_null();
  Table table = table_of_poses(has_noise, unit);
  std::size_t parts = 0;
  for (const Json& part : document["parts"]) {
    if (++parts > kMostRows) break;
    const Json any_pose = Json::array({nullptr});  // one touch
    const Json& poses = part["placements"].empty() ? any_pose : part["placements"];
    for (std::size_t k = 0; k < std::min(poses.size(), kMostPoses); ++k) {
      const Json& pose = poses[k];
      std::string name = k == 0 ? part["name"].get<std::string>() : "";
      if (k + 1 == kMostPoses && poses.size() > kMostPoses) {
        name = fmt::format("  and {} more", counted(poses.size() - kMostPoses, "pose", "poses"));
      }
      std::vector<std::string> cells{name};
      if (has_noise) cells.push_back(k == 0 ? probability(part["probability"]) : "");
      if (has_noise) cells.push_back(pose.is_null() ? "-" : probability(pose["probability"]));
      add_pose_cells(pose, has_noise, cells);
      cells.emplace_back(pose.is_null() || pose["kind"] != "continuum" ? "" : "continuum");
      table.add_row(std::move(cells));
    }
  }
  const std::size_t more = document["parts"].size() - std::min(document["parts"].size(), kMostRows);
  return table.str() +
         (more == 0 ? ""
                    : fmt::format("... and {}; --json lists them all\n", counted(more, "more part", "more parts")));
}

/// Of touches and rolls: what to do next.
std::string advice_of_touches(const Json& document) {
  const bool has_rolls = !document["rolls"].empty();
  const auto is_open = [](const Json& part) {
    return part["verdict"].get<std::string>().rfind("unobservable", 0) == 0;
  };
  if (document["samples"] == 1 && !document["parts"].empty() && is_open(document["parts"][0])) {
    return "one touch fits every part in any pose: touch the part elsewhere as well\n";
  }
  if (!document["undecided"].empty()) {
    return fmt::format("the budget ran out on {}: more {}, or a larger --budget, leave less to look at\n",
                       counted(document["undecided"].size(), "part", "parts"), has_rolls ? "rolls" : "touches");
  }
  if (!document["parts"].empty()) return "";
  if (has_rolls) {
    return "no pose of any part fits all rolls and touches: check the noise, the unit, the finger's radius, and "
           "--mirror, and whether the part was moved in between\n";
  }
  return "no pose of any part fits all touches: check the noise, the unit, the finger's radius, and --mirror\n";
}

std::string congruent_lines(const Json& document) {
  std::string text;
  std::size_t lines = 0;
  for (const Json& part : document["parts"]) {
    if (part["congruent_with"].empty()) continue;
    if (++lines > kMostNotes) continue;
    std::vector<std::string> others;
    for (const Json& name : part["congruent_with"]) others.push_back(name.get<std::string>());
    text += fmt::format("{} can't be told from {}\n", plain(part["name"].get<std::string>()),
                        plain(fmt::format("{}", fmt::join(others, ", "))));
  }
  if (lines > kMostNotes) text += fmt::format("... and {} more such lines\n", lines - kMostNotes);
  return text;
}

std::string refused_lines(const Json& document) {
  std::string text;
  const Json& refused = document["refused"];
  for (std::size_t k = 0; k < std::min(refused.size(), kMostNotes); ++k) {
    text += fmt::format("not on {}: {}\n", plain(refused[k]["name"].get<std::string>()),
                        plain(refused[k]["why"].get<std::string>()));
  }
  if (refused.size() > kMostNotes) text += fmt::format("... and not on {} more\n", refused.size() - kMostNotes);
  return text;
}

/// For people: what a document of "rollfix/identify/1" says.
std::string identify_text(const Json& document, const std::string& unit) {
  const Json& catalog = document["catalog"];
  std::string text = fmt::format("{}\n{} of {} were searched, bounds rule the others out",
                                 document["verdict"].get<std::string>(), catalog["searched"].get<std::size_t>(),
                                 counted(catalog["parts"].get<std::size_t>(), "part", "parts"));
  if (!document["rest"].is_null() && !document["parts"].empty())
    text += fmt::format("; probability of all that is not listed {}", rough(document["rest"].get<double>()));
  text += "\n";
  const bool of_touches = document.contains("touches");
  if (of_touches) text += advice_of_touches(document);
  if (!document["parts"].empty())
    text += "\n" + (of_touches ? poses_table(document, unit) : parts_table(document, unit));
  const std::string below = congruent_lines(document) + refused_lines(document);
  if (!below.empty()) text += "\n" + below;
  return text;
}

ExitCode exit_code_of_parts(const Json& identified) {
  if (identified["status"] != "complete") return ExitCode::incomplete;
  return identified["parts"].empty() ? ExitCode::nothing_fits : ExitCode::fits;
}

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
  report.exit_code = exit_code_of_parts(document);
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

/// What to try where a roll fits no part: the noise that its rows show, where none was stated.
std::string advice_of_none(const Problem& question) {
  if (!question.noise && question.measured.is_log()) {
    if (const auto shown = noise_that_shows(*question.measured.log, question.fingers)) {
      return fmt::format(
          "the rows jitter by more than their digits say, but no noise was stated\n"
          "  try {}; slip and a wrong radius may add to it\n",
          noise_option(*shown));
    }
  }
  return "no place of any part fits the roll: check the finger's radius, the unit, the signs of the columns and the "
         "noise; or the part is not in the catalog\n";
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
        "or give the logs of fingers with skin alone");
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
  if (!arguments.json && found.verdict == "none") report.data += advice_of_none(question);
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
