#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "files/documents/documents.hpp"
#include "rollfix/answer/next_roll.hpp"
#include "rollfix/answer/solve.hpp"
#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/output_argument.hpp"
#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/commands.hpp"
#include "rollfix/draw/advice_figure.hpp"
#include "rollfix/error.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/usage.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kAdviseExamples = R"(Examples (wing.csv and wing-roll.csv: from rollfix demo):
  rollfix advise gallery:cam --reading 0.4,20.1deg
  rollfix advise gallery:limacon --reading 0.9,30.15deg --finger disk,r=0.1 --travel -1,1.5 -o next.svg
  rollfix advise wing.csv --log wing-roll.csv --finger disk,r=10 --noise contact=0.05,angle=0.2deg --json
)";

// Placements in the table.
constexpr std::size_t kMostContenders = 20;

struct AdviseArguments {
  RollArguments roll;
  std::string travel;
  bool json = false;
  OutputArgument output;
};

Interval read_travel(const std::string& text, const std::string& unit) {
  const std::vector<std::string_view> fields = split(text, ',');
  const std::string what = "--travel " + text;
  if (fields.size() == 1) {
    const double most = read_length(fields[0], what, unit);
    if (!(most > 0)) throw InputError(what + ": expected a length above 0, or BACK,FORWARD as in -0.5,1.2");
    return {-most, most};
  }
  if (fields.size() != 2) {
    throw InputError(what + ": expected one length, or BACK,FORWARD as in -0.5,1.2; are there decimal commas in it?");
  }
  const Interval travel{read_length(fields[0], what, unit), read_length(fields[1], what, unit)};
  if (!(travel.lo <= 0 && travel.hi >= 0 && travel.width() > 0)) {
    throw InputError(what + ": expected a length of at most 0, backwards, and one of at least 0, forwards");
  }
  return travel;
}

std::string headline(const NextRoll& outcome) {
  const std::string verdict = outcome.answer.verdict.text();
  if (!outcome.advice) return fmt::format("{}: {}", verdict, outcome.why);
  if (!outcome.advice->helps) return fmt::format("{}: no roll will tell them apart: {}", verdict, outcome.why);
  const Prospect& advised = outcome.advice->advised();
  const int decimals = decimals_for(outcome.answer.part.perimeter());
  return fmt::format("{}: roll on {} by {}{}: {:.2f} placements are expected to remain, {:.2f} of {:.2f} bits gained",
                     verdict, advised.length < 0 ? "backwards" : "forwards", fixed(std::abs(advised.length), decimals),
                     behind(outcome.answer.part.unit()), advised.placements, advised.bits, outcome.advice->bits_wanted);
}

/// What the contenders of one placement have in common.
struct Expected {
  double first = 0;  // contact
  double last = 0;
  double probability = 0;
  Interval turn{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void add(const Contender& contender, double turn_ahead) {
    if (probability == 0) first = contender.place;
    last = contender.place;
    probability += contender.probability;
    turn = {std::min(turn.lo, turn_ahead), std::max(turn.hi, turn_ahead)};
  }
};

std::string span_of(const std::string& lo, const std::string& hi) { return lo == hi ? lo : lo + " to " + hi; }

std::string advise_text(const NextRoll& outcome) {
  std::string text = headline(outcome) + "\n";
  if (!outcome.helps()) return text;
  const int decimals = decimals_for(outcome.answer.part.perimeter());
  Table table;
  table.add_column("", Table::Align::left);
  table.add_column(title_in("contact now", outcome.answer.part.unit()));
  for (const char* title : {"probability", "turn to expect [deg]"}) table.add_column(title);
  const std::vector<Contender>& all = outcome.contenders;
  std::size_t placements = 0;
  for (std::size_t k = 0; k < all.size();) {
    // A wide placement is several contenders: one row.
    Expected row;
    const std::size_t label = all[k].label;
    for (; k < all.size() && all[k].label == label; ++k) row.add(all[k], outcome.turn_ahead(all[k]));
    if (++placements <= kMostContenders) {
      table.add_row({fmt::format("a{}", label), span_of(fixed(row.first, decimals), fixed(row.last, decimals)),
                     fmt::format("{:.4f}", row.probability), span_of(degrees(row.turn.lo), degrees(row.turn.hi))});
    }
  }
  text += "\n" + table.str();
  if (placements > kMostContenders) {
    text += fmt::format("... and {} more; --json lists them all\n", placements - kMostContenders);
  }
  return text;
}

Report advise_report(const AdviseArguments& arguments) {
  const RollArguments& roll = arguments.roll;
  require_part(roll.part);
  if (roll.readings.empty() == roll.logs.empty()) {
    throw InputError("advise: expected --reading LENGTH,TURN or --log FILE of the roll so far");
  }
  counts_clockwise(roll.direction);  // one way or the other, not either
  require_figure_output(arguments.output, arguments.json);
  Report report;
  const Problem problem = read_problem(roll, report.notes);
  std::optional<Interval> travel;
  if (!arguments.travel.empty()) travel = read_travel(arguments.travel, problem.part.unit());
  if (problem.felt.is_log() ? problem.felt.log->fingers.size() == 2 : problem.felt.readings.front().fingers() == 2) {
    throw InputError("advise: expected what one finger read, found two fingers");
  }
  const NextRoll outcome = next_roll(solve(problem), travel);
  add_notes(outcome.answer, report);
  report.exit_code = exit_code_of(outcome.answer);
  report.data = arguments.json ? json_text(next_roll_json(outcome)) : advise_text(outcome);
  if (!arguments.output.file.empty()) {
    if (!outcome.advice) {  // an answer all the same
      report.notes.push_back(fmt::format("-o {}: nothing is drawn: {}", arguments.output.file, outcome.why));
      return report;
    }
    add_figure(arguments.output,
               draw_advice({*outcome.advice, outcome.answer.part.name(), outcome.answer.verdict.text()}), report);
  }
  return report;
}

}  // namespace

void add_advise_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<AdviseArguments>();
  CLI::App* command =
      program.add_subcommand("advise", "The next roll: which one tells the remaining placements apart.");
  command->footer(kAdviseExamples);
  add_roll_arguments(*command, arguments->roll);
  command
      ->add_option(
          "--travel", arguments->travel,
          "how far the finger can roll on: a length, or one backwards, below 0, and one forwards; default one lap")
      ->type_name("BACK,FORWARD");
  add_output_argument(*command, arguments->output,
                      "a figure of what is to be expected by length: .svg, .png or .pdf, - for SVG on stdout");
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/advise/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return advise_report(*arguments); }; });
}

}  // namespace rollfix::app
