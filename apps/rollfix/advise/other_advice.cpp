#include "rollfix/advise/other_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "outline/turn.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/arguments/question_arguments.hpp"
#include "rollfix/arguments/typed.hpp"
#include "rollfix/documents.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate/touch_arguments.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/question.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

std::string headline(const HoldAnswer& held, const NextPin& next) {
  const std::string verdict = held.verdict_text();
  if (!next.advice) return fmt::format("{}: {}\n", verdict, next.why);
  if (!next.helps()) return fmt::format("{}: no motion of the pin will tell them apart: {}\n", verdict, next.why);
  const ExpectedGain& advised = next.advice->advised();
  const int decimals = decimals_for(held.part.perimeter());
  return fmt::format(
      "{}: move the pin by {} along the jaw{} and {} away from it{}: {:.2f} placements are expected to remain, {:.2f} "
      "of "
      "{:.2f} bits gained\n",
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
  const std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() != 4) {
    throw InputError(
        fmt::format("{}: expected X,Y,DX,DY, as in 0,50,1,0: where the finger's centre starts, and which "
                    "way it goes, found {}",
                    what, counted(fields.size(), "number", "numbers")));
  }
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

}  // namespace rollfix::app
