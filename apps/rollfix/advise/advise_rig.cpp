#include "rollfix/advise/advise_rig.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "rollfix/advise.hpp"
#include "rollfix/arguments/question_arguments.hpp"
#include "rollfix/arguments/travel_argument.hpp"
#include "rollfix/documents.hpp"
#include "rollfix/draw.hpp"
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

}  // namespace rollfix::app
