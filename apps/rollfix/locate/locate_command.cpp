#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <ostream>
#include <utility>
#include <vector>

#include "answer/steps.hpp"
#include "rollfix/arguments/arguments.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/locate/locate_command.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/program.hpp"
#include "rollfix/solve.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kLocateExamples = R"(Examples (wing.csv and wing-roll.csv: from rollfix demo):
  rollfix locate gallery:ellipse,a=2,b=1 --reading 1.5,73.2deg
  rollfix locate wing.csv --reading 60.1,5.12deg --reading 120,18.39deg -o where.svg
  rollfix locate wing.csv --log wing-roll.csv --finger disk,r=10
  rollfix locate wing.csv --log wing-roll.csv --finger disk,r=10 --at 6.1,12.32 --json
  rollfix locate wing.csv --log wing-roll.csv --finger disk,r=10 --noise contact=0.05,angle=0.2deg,slip=0.002
  rollfix locate wing.csv --batch problems.jsonl > answers.jsonl
  rollfix locate gallery:cam --reading 0.9,40deg --certify proof.json && rollfix-verify proof.json
Touches without rolling, of a part at rest:
  rollfix locate gallery:cam --touch 6.486,3.822 --touch 4.355,4.133 --touch 3.824,3.238 --touch 4.507,1.895 --finger disk,r=0.2 --noise position=0.005
  rollfix locate gallery:cam --touch 5,4.4,97deg --touch 4,3.2,160deg --touch 5.2,2,280deg --noise position=0.05,angle=3deg -o poses.svg
Two fingers on a part that is free to move:
  rollfix locate gallery:cam --reading 0.7446832,-0.3983439,57.48184deg --reading 1.5,-0.8,110.97000deg
  rollfix locate gallery:cam --reading 1.5,-0.8,110.97000deg --facing -142.40990deg
  rollfix simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --length 1.5 --length -0.8 -o cam-rolls.csv
  rollfix locate gallery:cam --log cam-rolls.csv --finger disk,r=0.2 -o cam-pairs.svg
Three and more fingers on a part that is free to move, a log of each with the same times:
  rollfix simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --length 1.5 --length -0.8 -o hold-a.csv -o hold-b.csv
  rollfix simulate gallery:cam --finger disk,r=0.2 --start 1 --start 6 --length 1.5 --length 0.5 -o again.csv -o hold-c.csv
  rollfix locate gallery:cam --log hold-a.csv --log hold-b.csv --log hold-c.csv --finger disk,r=0.2 -o cam-hold.svg
)";

struct LocateArguments {
  RollArguments roll;
  std::vector<std::string> touches;
  bool json = false;
  AnswerDetail detail;
  std::vector<std::string> maps;
  std::string batch;
  std::string certificate;
  OutputArgument output;
  MarchArguments march;
};

/// Throws InputError: nothing to work with, or too much.
void require_sensible(const LocateArguments& arguments) {
  const RollArguments& roll = arguments.roll;
  require_part(roll.part);
  if (roll.readings.empty() && roll.logs.empty() && arguments.touches.empty()) {
    throw InputError("locate: expected --reading LENGTH,TURN, --log FILE or --touch X,Y, found none");
  }
  const bool are_of_one_roll = !roll.readings.empty() && !roll.logs.empty() && roll.logs.size() <= 2;
  if (are_of_one_roll && roll.roll != "all" && arguments.touches.empty()) {
    throw InputError("locate: expected --reading or --log, found both: they can't be of the same roll");
  }
  if (arguments.maps.empty()) require_figure_output(arguments.output, arguments.json);
  require_certificate(arguments.certificate, arguments.output.force, arguments.json, arguments.output.file);
  read_step(arguments.march);
}

/// What the paper's algorithm has no use for.
void require_march(const LocateArguments& arguments) {
  const RollArguments& roll = arguments.roll;
  const auto refuse = [](bool given, const char* option) {
    if (given) throw InputError(fmt::format("--march: the paper's algorithm has no use for {}; leave one out", option));
  };
  refuse(!roll.noise.empty(), "--noise");
  refuse(!roll.facing.empty(), "--facing");
  refuse(!roll.budget.empty(), "--budget");
  refuse(!arguments.output.file.empty(), "-o");
  refuse(arguments.detail.explain, "--explain");
  refuse(roll.mirror, "--mirror");
  refuse(roll.direction == "either", "--direction either");
  refuse(!arguments.maps.empty(), "--map");
  refuse(!arguments.certificate.empty(), "--certify");
}

/// The same readings, asked of the paper's algorithm.
Report march_report(const LocateArguments& arguments, const Problem& problem) {
  const Observation observed = observe(problem);
  const Tolerance tolerance = problem.tolerance
                                  ? tolerance_given(*problem.tolerance)
                                  : tolerance_from_digits(problem.part, observed.roundings, observed.readings);
  MarchQuestion question{{}, tolerance.value, read_step(arguments.march), arguments.json};
  for (const Reading& reading : observed.readings) {
    if (!reading.is_exact()) {
      throw InputError(
          "--march: expected rows off the corners of the finger, found one on a corner; choose others with --at, of a "
          "log whose first row is off them too, or leave --march out");
    }
    question.readings.push_back({{reading.length.begin(), reading.length.end()}, reading.turn});
  }
  return locate_by_march(problem.part, question);
}

/// What only answers to one roll have.
void require_outputs(const LocateArguments& arguments, const Question& question) {
  const QuestionKind kind = kind_of(question);
  const bool has_rolls = !question.measured.rolls.empty();
  const auto refuse = [&](bool given, const char* option) {
    if (!given) return;
    throw InputError(fmt::format("{}: {}", option,
                                 kind == QuestionKind::moving ? "is of one or two fingers with skin; leave it out"
                                 : has_rolls ? "is of one roll; leave it out, or choose one with --roll N"
                                             : "touches do not roll and have no use for it; leave it out"));
  };
  if (kind == QuestionKind::roll) {
    if (arguments.detail.explain && question.fingers.empty()) {
      throw InputError("--explain lists what the finger can't reach: give --finger as well");
    }
    return require_map_output(arguments.maps, arguments.output.file, arguments.output.force, arguments.json, has_rolls,
                              !question.fingers.empty());
  }
  refuse(!arguments.maps.empty(), "--map");
  refuse(arguments.march.march, "--march");
  refuse(arguments.detail.explain, "--explain");
}

/// What a batch has no use for.
void require_batch(const LocateArguments& arguments) {
  const auto refuse = [](bool given, const char* option) {
    if (given) throw InputError(fmt::format("--batch: each line has its own problem; leave {} out", option));
  };
  refuse(!arguments.roll.readings.empty(), "--reading");
  refuse(!arguments.roll.logs.empty(), "--log");
  refuse(!arguments.touches.empty(), "--touch");
  refuse(!arguments.output.file.empty(), "-o");
  refuse(!arguments.maps.empty(), "--map");
  refuse(!arguments.certificate.empty(), "--certify");
  refuse(arguments.march.march, "--march");
}

std::string text_of(const Solution& solution, const AnswerDetail& detail) {
  if (solution.at_rest() != nullptr) return touches_text(*solution.at_rest(), detail.verbose);
  if (solution.moving() != nullptr) return hold_text(*solution.moving());
  return answer_text(*solution.roll(), detail);
}

void add_certificate(const LocateArguments& arguments, const Question& question, const Solution& solution,
                     Report& report) {
  const std::string& file = arguments.certificate;
  const bool force = arguments.output.force;
  if (solution.roll() != nullptr) add_certificate(file, force, roll_problem(question), *solution.roll(), report);
  if (solution.at_rest() != nullptr) add_certificate(file, force, rest_problem(question), *solution.at_rest(), report);
  if (solution.moving() != nullptr) add_certificate(file, force, moving_problem(question), *solution.moving(), report);
}

/// Of fingers on a part that moves; those of a roll are among the notes on its answer.
void add_reach_note(const Question& question, Report& report) {
  for (const Finger& finger : question.fingers) {
    if (finger.is_disk() || (finger.is_jaw() && !question.measured.wheels.empty())) continue;
    report.notes.push_back(no_reach_note(finger));
    return;
  }
}

/// Everything that was found, in the forms that are wanted.
void add_solution(const LocateArguments& arguments, const Question& question, std::vector<Outline> others,
                  const Solution& solution, Report& report) {
  if (solution.roll() != nullptr) add_notes(*solution.roll(), report);
  if (solution.moving() != nullptr) add_reach_note(question, report);
  report.exit_code = exit_code_of(solution);
  report.data = arguments.json ? format_solution(solution, Layout::lines, arguments.detail.explain)
                               : text_of(solution, arguments.detail);
  if (!arguments.maps.empty()) {
    add_table(arguments.output, mapped_points(*solution.roll(), arguments.maps, others, report.notes), report);
  } else if (!arguments.output.file.empty()) {
    add_figure(arguments.output, draw_solution({&question, &solution, std::move(others)}), report);
  }
  if (!arguments.certificate.empty()) add_certificate(arguments, question, solution, report);
}

/// Of two fingers' readings both ways round are no figure.
void require_one_way(const LocateArguments& arguments, const Question& question) {
  const std::vector<Reading>& readings = question.measured.readings;
  if (arguments.output.file.empty() || readings.empty() || readings.front().fingers() != 2) return;
  if (question.direction != Direction::either) return;
  throw InputError("-o: a figure of two fingers is of one way round: expected --direction ccw or cw, found either");
}

Report locate_report(const LocateArguments& arguments, std::ostream& out) {
  if (!arguments.batch.empty()) {
    require_batch(arguments);
    return locate_batch(arguments.roll, arguments.batch, arguments.detail.explain, out);
  }
  require_sensible(arguments);
  Report report;
  std::vector<Outline> others;
  const Question question = read_question(arguments.touches, arguments.roll, report.notes, &others);
  require_outputs(arguments, question);
  require_one_way(arguments, question);
  if (arguments.march.march) {
    require_march(arguments);
    Report of_march = march_report(arguments, roll_problem(question));
    of_march.notes = std::move(report.notes);
    return of_march;
  }
  add_solution(arguments, question, std::move(others), solve(question), report);
  return report;
}

/// "left out 2 stray rows, lines 17 and 40, ...".
std::string strays_note(const std::vector<std::size_t>& lines) {
  constexpr std::size_t kMostNamed = 8;
  const std::vector<std::size_t> named(lines.begin(),
                                       lines.begin() + static_cast<std::ptrdiff_t>(std::min(lines.size(), kMostNamed)));
  return fmt::format("left out {} that the roll jumps to and comes back from: {} {}{}",
                     counted(lines.size(), "stray row", "stray rows"), lines.size() == 1 ? "line" : "lines",
                     fmt::join(named, ", "), lines.size() > kMostNamed ? ", ..." : "");
}

}  // namespace

ExitCode exit_code_of(const Solution& solution) {
  if (solution.status() == Status::incomplete) return ExitCode::incomplete;
  return solution.fits() ? ExitCode::fits : ExitCode::nothing_fits;
}

void add_notes(const Answer& answer, Report& report) {
  for (const Finger& finger : answer.fingers) {
    if (has_reach(finger)) continue;
    report.notes.push_back(no_reach_note(finger));
    break;
  }
  if (answer.part.reversed()) report.notes.push_back(reversed_note(answer.part));
  if (!answer.strays.empty()) report.notes.push_back(strays_note(answer.strays));
  for (std::string& note : notes_of(answer)) report.notes.push_back(std::move(note));
}

void add_locate_command(CLI::App& program, Command& chosen, std::ostream& out) {
  const auto arguments = std::make_shared<LocateArguments>();
  CLI::App* command = program.add_subcommand("locate", "Every place on a part where a roll can have started.");
  command->footer(kLocateExamples);
  RollArguments& roll = arguments->roll;
  add_roll_arguments(*command, roll, true);
  add_touch_arguments(*command, arguments->touches, roll);
  command
      ->add_option("--at", roll.instants,
                   "instants of the log to use, seconds; default its last row, for two fingers also the middle one")
      ->type_name("T1,T2,...");
  command
      ->add_option(
          "--facing", roll.facing,
          "the angle from finger b's contact normal to finger a's at the first contacts; with it one reading of two "
          "fingers is enough")
      ->type_name("ANGLE");
  add_squeezed_argument(*command, roll.squeezed);
  command
      ->add_option("--budget", roll.budget,
                   "intervals to examine, beyond the part's own, before giving up; default 1000000")
      ->type_name("N");
  command
      ->add_option(
          "--batch", arguments->batch,
          "many problems, a JSON object in each line, - for stdin: \"readings\", \"log\" or \"touches\", and the "
          "options by their names in place of those given here; an answer in each line, in order, on all cores")
      ->type_name("FILE");
  command
      ->add_option("--certify", arguments->certificate,
                   "write a certificate of the answer, JSON, which rollfix-verify proves again")
      ->type_name("FILE");
  add_output_argument(*command, arguments->output,
                      "a figure of the placements: .svg, .png or .pdf, - for SVG on stdout");
  add_switch(*command, "--explain", arguments->detail.explain,
             "list placements that fit but were dropped because the finger can't reach them, and why");
  add_switch(*command, "--verbose", arguments->detail.verbose,
             "also show how wide placements are, how they move with the reading, and what was assumed exact");
  add_map_argument(*command, arguments->maps);
  add_march_arguments(*command, arguments->march);
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/locate/1)");
  command->callback(
      [arguments, &chosen, &out] { chosen = [arguments, &out] { return locate_report(*arguments, out); }; });
}

}  // namespace rollfix::app
