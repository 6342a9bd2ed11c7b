#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "documents/documents.hpp"
#include "outline/turn.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/arguments/arguments.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/program.hpp"
#include "rollfix/question.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::app {

/// `advise` of a jaw beside a wheel without skin: how its pin moves next. `travel`: as typed. Throws InputError.
Report advise_rig(const RollArguments& arguments, const std::string& travel, const OutputArgument& output, bool json);

/// `advise` of touches without rolling: which approach tells the remaining poses apart. `approaches`: as typed.
/// Throws InputError.
Report advise_touches(const std::vector<std::string>& touches, const RollArguments& arguments,
                      const std::vector<std::string>& approaches, const OutputArgument& output, bool json);

namespace {

std::string headline(const HoldAnswer& held, const NextPin& next) {
  const std::string verdict = held.verdict_text();
  if (!next.advice) return fmt::format("{}: {}\n", verdict, next.why);
  if (!next.helps()) return fmt::format("{}: no motion of the pin will tell them apart: {}\n", verdict, next.why);
  const ExpectedGain& advised = next.advice->advised();
  const int decimals = decimals_for(held.part.perimeter());
  return fmt::format(
      "{}: move the pin by {} along the jaw{} and {} away from it{}: {:.2f} placements are expected to remain, {:.2f} "
      "of {:.2f} bits gained\n",
      verdict, fixed(next.advice->lengths()[0], decimals), behind(held.part.unit()),
      held.squeezed ? "as the squeeze has it" : fixed(next.advice->lengths()[1], decimals),
      held.squeezed ? "" : behind(held.part.unit()), advised.placements, advised.bits, next.advice->bits_wanted);
}

std::string table_of(const HoldAnswer& held, const NextPin& next) {
  const int decimals = decimals_for(held.part.perimeter());
  Table table;
  table.add_column("", Table::Align::left);
  for (const char* title : {"jaw now", "wheel now"}) table.add_column(title_in(title, held.part.unit()));
  table.add_column("probability");
  table.add_column(title_in("length to expect", held.part.unit()));
  for (std::size_t k = 0; k < next.hypotheses.size(); ++k) {
    const Hypothesis& one = next.hypotheses[k];
    table.add_row({std::to_string(one.label), fixed(one.place[0], decimals), fixed(one.place[1], decimals),
                   fmt::format("{:.4f}", one.probability), fixed(next.travels[k], decimals)});
  }
  return "\n" + table.str();
}

}  // namespace

Report advise_rig(const RollArguments& arguments, const std::string& travel, const OutputArgument& output, bool json) {
  Report report;
  const Question question = read_question({}, arguments, report.notes);
  const HoldAnswer held = solve(moving_problem(question));
  std::optional<Interval> within;
  if (!travel.empty()) within = read_travel(travel, question.part.unit());
  const NextPin next = next_pin(held, within);
  report.exit_code = exit_code_of(held);
  report.data = json ? format_next_pin(held, next) : headline(held, next);
  if (!json && next.helps()) report.data += table_of(held, next);
  if (output.file.empty()) return report;
  if (next.advice) {
    add_figure(output, draw_advice({*next.advice, held.part.name(), held.verdict_text()}), report);
  } else {
    report.notes.push_back(fmt::format("-o {}: nothing is drawn: {}", output.file, next.why));
  }
  return report;
}

namespace {

/// X,Y,DX,DY.
Approach read_approach(const std::string& text, const std::string& unit) {
  const std::string what = "--approach " + text;
  const std::vector<std::string_view> fields = fields_of(
      text, what, 4, 4,
      "expected X,Y,DX,DY, as in 0,50,1,0: where the finger's centre starts, and which way it goes, found {}");
  const Vec2 along(read_number(fields[2], what), read_number(fields[3], what));
  if (!(along.norm() > 0)) throw InputError(what + ": expected a direction DX,DY that is not 0,0");
  return {{read_length(fields[0], what, unit), read_length(fields[1], what, unit)}, std::atan2(along.y(), along.x())};
}

std::string headline(const TouchAnswer& answer, const NextTouch& next) {
  if (!next.helps) return fmt::format("{}: {}\n", answer.verdict_text(), next.why);
  const TouchGain& advised = next.advised();
  const int decimals = decimals_for(answer.part.perimeter());
  const bool any_are_listed = !next.expected.empty();
  return fmt::format("{}: from x {}, y {}{} go in direction {} deg until it touches: {}{:.2f} of {:.2f} bits gained\n",
                     answer.verdict_text(), fixed(advised.approach.from.x(), decimals),
                     fixed(advised.approach.from.y(), decimals), behind(answer.part.unit()),
                     degrees(nearest_angle(advised.approach.direction)),
                     any_are_listed ? fmt::format("{:.2f} poses are expected to remain, ", advised.poses) : "",
                     advised.bits, next.bits_wanted);
}

/// What rolling from the last touch gains instead.
std::string roll_line(const TouchAnswer& answer, const NextTouch& next) {
  if (!next.roll) return "";
  const double length = next.roll->length;
  return fmt::format("or roll over {}{}{} from the last touch: {:.2f} bits gained by its turn\n", length > 0 ? "+" : "",
                     fixed(length, decimals_for(answer.part.perimeter())), behind(answer.part.unit()), next.roll->bits);
}

std::string table_of(const TouchAnswer& answer, const NextTouch& next) {
  const int decimals = decimals_for(answer.part.perimeter());
  const std::string unit = answer.part.unit();
  Table table;
  table.add_column("pose", Table::Align::left);
  table.add_column("probability");
  for (const char* title : {"travel", "x", "y"}) table.add_column(title_in(title, unit));
  table.add_column("normal [deg]");
  for (std::size_t k = 0; k < std::min(next.expected.size(), kMostRows); ++k) {
    const ExpectedTouch& one = next.expected[k];
    std::vector<std::string> cells{fmt::format("p{}", one.placement), fmt::format("{:.4f}", one.probability)};
    if (one.hits) {
      for (const double number : {one.travel, one.at.x(), one.at.y()}) cells.push_back(fixed(number, decimals));
      cells.push_back(degrees(one.normal));
    } else {
      cells.insert(cells.end(), {"misses", "-", "-", "-"});
    }
    table.add_row(std::move(cells));
  }
  const std::size_t more = next.expected.size() - std::min(next.expected.size(), kMostRows);
  return "\n" + table.str() + (more > 0 ? fmt::format("... and {} more; --json lists them all\n", more) : "");
}

}  // namespace

Report advise_touches(const std::vector<std::string>& touches, const RollArguments& arguments,
                      const std::vector<std::string>& approaches, const OutputArgument& output, bool json) {
  require_figure_output(output, json);
  Report report;
  std::vector<Outline> others;
  const TouchProblem problem = read_touch_problem(touches, arguments, report.notes, &others);
  std::vector<Approach> ways;
  for (const std::string& text : approaches) ways.push_back(read_approach(text, problem.part.unit()));
  const TouchAnswer answer = solve(problem);
  report.exit_code = exit_code_of(answer);
  NextTouch next;
  if (answer.status == Status::complete) {
    next = next_touch(answer, ways);
  } else {
    next.why = "the budget ran out: touch once more, or raise --budget";
  }
  report.data = json ? format_next_touch(answer, next)
                     : headline(answer, next) + roll_line(answer, next) +
                           (next.helps && !next.expected.empty() ? table_of(answer, next) : std::string());
  if (output.file.empty()) return report;
  TouchFigure figure{&answer};
  figure.others = std::move(others);
  if (next.helps) figure.next = &next;
  add_figure(output, draw_touches(figure), report);
  return report;
}

// ---- of rolls

namespace {

constexpr const char* kAdviseExamples = R"(Examples (wing.csv and wing-roll.csv: from rollfix demo):
  rollfix advise gallery:cam --reading 0.4,20.1deg
  rollfix advise gallery:limacon --reading 0.9,30.15deg --finger disk,r=0.1 --travel -1,1.5 -o next.svg
  rollfix advise wing.csv --log wing-roll.csv --finger disk,r=10 --noise contact=0.05,angle=0.2deg --json
Nothing is known yet: which roll tells most at first; for two fingers --finger for each:
  rollfix advise gallery:cam --finger disk,r=0.2 --finger disk,r=0.2 --noise contact=0.005,angle=0.2deg
Two fingers on a part that is free to move: which rolls on, and how far:
  rollfix advise gallery:spline,n=9,seed=7,wobble=0.2 --reading 0.58,0.94,-0.725248 --reading 1.01,1.92,-1.99849
A jaw with skin and a wheel without: how the wheel's pin moves next
  rollfix advise gallery:cam --log jaw.csv --log pin.csv --finger jaw --finger wheel,r=0.4 --noise contact=0.01,angle=0.3deg,position=0.01
Touches without rolling: where to touch next, of all ways or of two:
  rollfix advise gallery:cam --touch 6.486,3.822 --touch 4.355,4.133 --touch 3.824,3.238 --finger disk,r=0.2 --noise position=0.005
  rollfix advise gallery:cam --touch 6.486,3.822 --touch 4.355,4.133 --touch 3.824,3.238 --finger disk,r=0.2 --noise position=0.005 --approach 3,1,1,1 --approach 9,3,-1,0
Which part is it? Of a catalog, what tells apart the parts that remain:
  rollfix advise --catalog parts.db --log roll.csv --finger disk,r=10 --noise contact=0.05,angle=0.2deg
)";

// Placements in the table.
constexpr std::size_t kMostHypotheses = 20;

struct AdviseArguments {
  RollArguments roll;
  std::vector<std::string> touches;
  std::vector<std::string> approaches;
  std::string catalog;
  std::string travel;
  std::string friction;
  bool json = false;
  OutputArgument output;
};

/// "roll on forwards by 1.2 mm"; "roll on finger a forwards by 1.2 mm, finger b stays".
std::string roll_text(const PerFinger<double>& lengths, const Part& part) {
  const auto by = [&](double length) {
    return fmt::format("{} by {}{}", length < 0 ? "backwards" : "forwards",
                       fixed(std::abs(length), decimals_for(part.perimeter())), behind(part.unit()));
  };
  if (lengths.size() == 1) return "roll on " + by(lengths[0]);
  if (lengths[0] == 0) return fmt::format("roll finger b on {}, finger a stays", by(lengths[1]));
  if (lengths[1] == 0) return fmt::format("roll finger a on {}, finger b stays", by(lengths[0]));
  return fmt::format("roll finger a on {}, finger b {}", by(lengths[0]), by(lengths[1]));
}

std::string headline(const std::string& verdict, const std::optional<Advice>& advice, const std::string& why,
                     const Part& part) {
  if (!advice) return fmt::format("{}: {}", verdict, why);
  if (!advice->helps) return fmt::format("{}: no roll will tell them apart: {}", verdict, why);
  const ExpectedGain& advised = advice->advised();
  const int decimals = decimals_for(part.perimeter());
  return fmt::format(
      "{}: {}: {:.2f} placements are expected to remain, {:.2f} of {:.2f} bits gained; travel to expect until they are "
      "told apart: {}{}",
      verdict, roll_text(advice->lengths(), part), advised.placements, advised.bits, advice->bits_wanted,
      fixed(advised.travel, decimals), behind(part.unit()));
}

/// What the hypotheses of one placement have in common.
struct Expected {
  PerFinger<double> first;  // contacts
  PerFinger<double> last;
  double probability = 0;
  Interval turn{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void add(const Hypothesis& hypothesis, double turn_ahead) {
    if (probability == 0) first = hypothesis.place;
    last = hypothesis.place;
    probability += hypothesis.probability;
    turn = {std::min(turn.lo, turn_ahead), std::max(turn.hi, turn_ahead)};
  }
};

std::string span_of(const std::string& lo, const std::string& hi) { return lo == hi ? lo : lo + " to " + hi; }

/// A row of the table: of a placement, which may be several hypotheses where it is wide.
struct Row {
  std::string name;
  Expected expected;
};

std::string table_of(const std::string& first, const std::vector<Row>& rows, const Part& part) {
  const int decimals = decimals_for(part.perimeter());
  const std::size_t fingers = rows.front().expected.first.size();
  Table table;
  table.add_column(first, Table::Align::left);
  for (std::size_t k = 0; k < fingers; ++k) {
    const char* const title = fingers == 1 ? "contact now" : k == 0 ? "finger a now" : "finger b now";
    table.add_column(title_in(title, part.unit()));
  }
  for (const char* title : {"probability", "turn to expect [deg]"}) table.add_column(title);
  for (std::size_t k = 0; k < std::min(rows.size(), kMostHypotheses); ++k) {
    const Expected& row = rows[k].expected;
    std::vector<std::string> cells{rows[k].name};
    for (std::size_t finger = 0; finger < fingers; ++finger) {
      cells.push_back(span_of(fixed(row.first[finger], decimals), fixed(row.last[finger], decimals)));
    }
    cells.push_back(fmt::format("{:.4f}", row.probability));
    cells.push_back(span_of(degrees(row.turn.lo), degrees(row.turn.hi)));
    table.add_row(std::move(cells));
  }
  std::string text = "\n" + table.str();
  if (rows.size() > kMostHypotheses)
    text += fmt::format("... and {} more; --json lists them all\n", rows.size() - kMostHypotheses);
  return text;
}

std::string advise_text(const NextRoll& outcome) {
  const Part& part = outcome.answer.part;
  std::string text = headline(outcome.answer.verdict.text(), outcome.advice, outcome.why, part) + "\n";
  if (!outcome.helps()) return text;
  std::vector<Row> rows;
  for (const Hypothesis& hypothesis : outcome.hypotheses) {
    const std::string name = fmt::format("{}{}", hypothesis.place.size() == 1 ? "a" : "", hypothesis.label);
    if (rows.empty() || rows.back().name != name) rows.push_back({name, {}});
    rows.back().expected.add(hypothesis, outcome.turn_ahead(hypothesis));
  }
  return text + table_of("", rows, part);
}

std::string advise_text(const Catalog& catalog, const Identified& found, const NextRollOfParts& next,
                        const Part& any_part) {
  std::string text = headline(found.verdict, next.advice, next.why, any_part) + "\n";
  if (!next.helps()) return text;
  std::vector<Row> rows;
  std::optional<std::size_t> last;
  for (const NextRollOfParts::Place& place : next.places) {
    if (last != place.hypothesis.label) rows.push_back({catalog.entry(found.parts[place.part].weight.part).name, {}});
    last = place.hypothesis.label;
    rows.back().expected.add(place.hypothesis, place.turn_ahead);
  }
  return text + table_of("part", rows, any_part);
}

/// Before any contact: places all over the boundary, which stand for all others, need no table.
std::string first_roll_text(const NextRoll& outcome) {
  const Part& part = outcome.answer.part;
  const std::string fingers = outcome.answer.finger_count() == 1 ? "places" : "pairs of places";
  if (!outcome.helps())
    return fmt::format("nothing is known yet, and no roll will tell {} apart: {}\n", fingers, outcome.why);
  const ExpectedGain& advised = outcome.advice->advised();
  return fmt::format(
      "nothing is known yet: {}: of {} {} all over the boundary {:.2f} are expected to remain, {:.2f} of {:.2f} bits "
      "gained; travel to expect until they are told apart: {}{}\n",
      roll_text(outcome.advice->lengths(), part), outcome.hypotheses.size(), fingers, advised.placements, advised.bits,
      outcome.advice->bits_wanted, fixed(advised.travel, decimals_for(part.perimeter())), behind(part.unit()));
}

/// What is drawn of an advice, if there is one.
void add_advice_figure(const AdviseArguments& arguments, const std::optional<Advice>& advice, const std::string& why,
                       const std::string& name, const std::string& verdict, Report& report) {
  if (arguments.output.file.empty()) return;
  if (!advice) {  // an answer all the same
    report.notes.push_back(fmt::format("-o {}: nothing is drawn: {}", arguments.output.file, why));
    return;
  }
  add_figure(arguments.output, draw_advice({*advice, name, verdict}), report);
}

Report advise_on_catalog(const AdviseArguments& arguments) {
  if (!arguments.friction.empty()) {
    throw InputError("--friction: rolls are planned on a known part: give PART, or leave it out");
  }
  require_no_prior(arguments.roll.prior);
  const Catalog catalog(arguments.catalog);
  const Part any_part = any_part_of(catalog);
  Report report;
  const Problem problem = read_problem(arguments.roll, any_part, report.notes);
  std::optional<Interval> travel;
  if (!arguments.travel.empty()) travel = read_travel(arguments.travel, any_part.unit());
  const Identified found = identify(catalog, problem);
  const NextRollOfParts next = next_roll(found, travel);
  report.exit_code = found.status == Status::incomplete ? ExitCode::incomplete
                     : found.parts.empty()              ? ExitCode::nothing_fits
                                                        : ExitCode::fits;
  report.data = arguments.json ? format_next_roll(catalog, found, next) : advise_text(catalog, found, next, any_part);
  add_advice_figure(arguments, next.advice, next.why, catalog.path(), found.verdict, report);
  return report;
}

/// Options that say something of a roll that was.
void require_nothing_rolled(const RollArguments& roll) {
  const auto refuse = [](bool given, const char* option) {
    if (given)
      throw InputError(fmt::format("{}: it is about a roll that was, and none is given: leave it out", option));
  };
  refuse(!roll.tolerance.empty(), "--tolerance");
  refuse(!roll.prior.empty(), "--prior");
  refuse(!roll.pose.heading.empty(), "--heading");
  refuse(!roll.pose.pose.empty(), "--pose");
  refuse(!roll.direction.empty(), "--direction");
  refuse(!roll.roll.empty(), "--roll");
  refuse(roll.robust, "--robust");
  refuse(roll.mirror, "--mirror");
}

/// Only the part, the fingers and how noisy a roll would be.
Problem read_before_contact(const RollArguments& roll, std::vector<std::string>& notes) {
  Problem problem{load_part(roll.part, notes), std::vector<Reading>{}};
  problem.fingers = read_fingers(roll.fingers, 2, problem.part.unit());
  problem.noise = read_noise(roll.noise, problem.part.unit());
  problem.may_overlap = roll.may_overlap;
  return problem;
}

Report advise_beside_wheel(const AdviseArguments& arguments) {
  const RollArguments& roll = arguments.roll;
  if (!arguments.catalog.empty()) {
    throw InputError("--catalog: a wheel without skin is taken beside a known part: give PART, or fingers with skin");
  }
  if (roll.logs.empty()) {
    throw InputError(
        "advise: beside a wheel without skin expected --log of the jaw and --log of the pin: how the pin moves next "
        "follows from where both can be; before any contact move it a little first");
  }
  if (!arguments.friction.empty()) {
    throw InputError("--friction: it is not looked at beside a wheel without skin: leave it out, or ask rollfix plan");
  }
  require_figure_output(arguments.output, arguments.json);
  return advise_rig(roll, arguments.travel, arguments.output, arguments.json);
}

Report advise_report(const AdviseArguments& arguments) {
  const RollArguments& roll = arguments.roll;
  if (roll.roll == "all") {
    throw InputError(
        "advise: --roll all: the next touch is advised after touches alone, the next roll after one roll; give --touch "
        "alone, or one roll with --roll N");
  }
  if (arguments.catalog.empty() && are_touches(arguments.touches, roll)) {
    if (!arguments.travel.empty())
      throw InputError("--travel: touches do not roll and have no use for it; leave it out");
    if (!arguments.friction.empty()) {
      throw InputError("--friction: touches do not roll and have no use for it; leave it out");
    }
    return advise_touches(arguments.touches, roll, arguments.approaches, arguments.output, arguments.json);
  }
  if (!arguments.touches.empty() || !arguments.approaches.empty() || !roll.clear.empty()) {
    throw InputError("advise: --touch, --approach and --clear are about touches of one part: give PART and --touch");
  }
  require_part_or_catalog("advise", roll.part, arguments.catalog);
  const bool is_first = roll.readings.empty() && roll.logs.empty();
  if (!roll.readings.empty() && !roll.logs.empty()) {
    throw InputError("advise: --reading and --log are both given: leave one of them out");
  }
  if (is_first && (roll.fingers.empty() || !arguments.catalog.empty())) {
    throw InputError(
        "advise: expected --reading LENGTH,TURN or --log FILE of the roll so far, or --touch X,Y; before any contact "
        "PART and --finger, once or for each of two");
  }
  if (has_wheel(roll)) return advise_beside_wheel(arguments);
  if (!roll.squeezed.empty()) {
    throw InputError(
        "--squeezed: it is about a finger with skin and a wheel without that squeeze a part, such as a jaw and "
        "wheel,r=0.4; leave it out");
  }
  counts_clockwise(roll.direction);  // one way or the other, not either
  require_figure_output(arguments.output, arguments.json);
  if (!arguments.catalog.empty()) return advise_on_catalog(arguments);
  Report report;
  if (is_first) require_nothing_rolled(roll);
  const Problem problem = is_first ? read_before_contact(roll, report.notes) : read_problem(roll, report.notes);
  std::optional<Interval> travel;
  if (!arguments.travel.empty()) travel = read_travel(arguments.travel, problem.part.unit());
  std::optional<PerFinger<double>> friction;
  if (!arguments.friction.empty()) {
    const std::vector<double> each = read_coefficients(arguments.friction, 2);
    friction = PerFinger<double>(each[0], each[1]);
  }
  const NextRoll outcome = next_roll(
      is_first ? before_contact(problem.part, problem.fingers, problem.noise, problem.may_overlap) : solve(problem),
      travel, problem.may_overlap, friction);
  add_notes(outcome.answer, report);
  report.exit_code = exit_code_of(outcome.answer);
  report.data = arguments.json ? format_next_roll(outcome) : is_first ? first_roll_text(outcome) : advise_text(outcome);
  add_advice_figure(arguments, outcome.advice, outcome.why, outcome.answer.part.name(), outcome.answer.verdict.text(),
                    report);
  return report;
}

}  // namespace

void add_advise_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<AdviseArguments>();
  CLI::App* command =
      program.add_subcommand("advise", "The next roll, or touch: which one tells the remaining placements apart.");
  command->footer(kAdviseExamples);
  add_roll_arguments(*command, arguments->roll);
  add_touch_arguments(*command, arguments->touches, arguments->roll);
  add_squeezed_argument(*command, arguments->roll.squeezed);
  command
      ->add_option("--approach", arguments->approaches,
                   "of touches: a way on which the next one can be tried, from X,Y towards DX,DY; repeatable; default "
                   "many all around the part")
      ->type_name("X,Y,DX,DY")
      ->allow_extra_args(false);
  add_catalog_argument(*command, arguments->catalog);
  command
      ->add_option("--travel", arguments->travel,
                   "how far each finger can roll on: a length, or one backwards, below 0, and one forwards; default "
                   "one lap; of a wheel without skin how far its pin can go, default a tenth of a lap")
      ->type_name("BACK,FORWARD");
  command
      ->add_option("--friction", arguments->friction,
                   "of two disks or jaws on the part, one coefficient or two: a roll is advised only if it can be "
                   "planned with it")
      ->type_name("MU[,MU]");
  add_output_argument(
      *command, arguments->output,
      "a figure of what is expected against the roll's length: .svg, .png or .pdf, - for SVG on stdout");
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/advise/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return advise_report(*arguments); }; });
}

}  // namespace rollfix::app
