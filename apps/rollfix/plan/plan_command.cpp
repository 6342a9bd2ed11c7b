#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "rollfix/commands.hpp"
#include "rollfix/documents.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/plan.hpp"
#include "rollfix/plan/plan_arguments.hpp"
#include "rollfix/simulate/simulation.hpp"

namespace rollfix::app {
namespace {

std::string finger_name(const PlanProblem& problem, std::size_t which) {
  if (problem.fingers.size() == 1) return "finger";
  if (problem.fingers[which].wheel) return "wheel";
  return which == 0 ? "finger a" : "finger b";
}

/// What each body does from the first row to the last.
std::string bodies_table(const Plan& plan, const PlanProblem& problem) {
  const std::string& unit = problem.part.unit();
  const int decimals = decimals_for(problem.part.perimeter());
  Table table;
  table.add_column("", Table::Align::left);
  for (const char* const title : {"from s", "to s", "length"}) table.add_column(title_in(title, unit));
  for (const char* const title : {"from x", "y", "to x", "y"}) table.add_column(title_in(title, unit));
  table.add_column("turns [deg]");
  for (std::size_t which = 0; which < plan.length.size(); ++which) {
    const FingerRows& rows = plan.roll.log.fingers[which];
    table.add_row({finger_name(problem, which), fixed(plan.roll.s[which].front(), decimals),
                   fixed(plan.roll.s[which].back(), decimals), fixed(plan.length[which], decimals),
                   fixed(rows.x.front(), decimals), fixed(rows.y.front(), decimals), fixed(rows.x.back(), decimals),
                   fixed(rows.y.back(), decimals), degrees(rows.psi.back() - rows.psi.front())});
  }
  if (plan.roll.pose.empty()) return table.str();
  const Pose& first = plan.roll.pose.front();
  const Pose& last = plan.roll.pose.back();
  table.add_row({"part", "", "", "", fixed(first.x, decimals), fixed(first.y, decimals), fixed(last.x, decimals),
                 fixed(last.y, decimals), degrees(last.heading - first.heading)});
  return table.str();
}

bool is_angle(Condition condition) {
  return condition == Condition::friction || condition == Condition::turn || condition == Condition::rotation;
}

std::string condition_text(const PlanMargin& margin, const PlanProblem& problem) {
  const std::string name = finger_name(problem, margin.finger);
  switch (margin.condition) {
    case Condition::friction:
      return "friction of " + name;
    case Condition::apart:
      return "fingers apart";
    case Condition::stable:
      return "balance on the wheel";
    case Condition::turns_back:
      return "wheel goes on";
    case Condition::reach:
      return "reach of " + name;
    default:
      return fmt::format("{} of {}", name_of(margin.condition), name);
  }
}

std::string quantity(double value, const PlanMargin& margin, const std::string& unit) {
  const std::string per = margin.condition == Condition::speed || margin.condition == Condition::turn ? "/s" : "";
  if (is_angle(margin.condition)) return degrees(value) + " deg" + per;
  if (margin.condition == Condition::stable || margin.condition == Condition::turns_back) return rough(value);
  return rough(value) + (unit.empty() ? "" : " " + unit) + per;
}

std::string margins_table(const Plan& plan, const PlanProblem& problem) {
  const std::string& unit = problem.part.unit();
  const int decimals = decimals_for(problem.part.perimeter());
  Table table;
  table.add_column("", Table::Align::left);
  for (const char* const title : {"least left", "of", "at [s]", "row"}) table.add_column(title);
  table.add_column(title_in("s", unit));
  if (plan.length.size() == 2) table.add_column(title_in("t", unit));
  table.add_column("", Table::Align::left);
  for (const PlanMargin& margin : plan.margins) {
    std::vector<std::string> cells{condition_text(margin, problem),
                                   quantity(margin.value, margin, unit),
                                   margin.allowed > 0 ? quantity(margin.allowed, margin, unit) : "-",
                                   fmt::format("{:.4g}", margin.time),
                                   std::to_string(margin.row + 1),
                                   fixed(margin.place[0], decimals)};
    if (plan.length.size() == 2) cells.push_back(fixed(margin.place[1], decimals));
    cells.emplace_back(margin.fails ? "FAILS" : margin.proved ? "proved" : "");
    table.add_row(std::move(cells));
  }
  return table.str();
}

std::string path_text(const Plan& plan) {
  switch (plan.path) {
    case PlanPath::even:
      return plan.length.size() == 1 ? "" : "path      both fingers evenly\n";
    case PlanPath::searched:
      return "path      searched: the widest margin\n";
    case PlanPath::squeezed:
      return "path      as the wheel settles, squeezed\n";
  }
  return "";
}

std::string friction_line(const Plan& plan, const PlanProblem& problem) {
  if (plan.length.size() != 2) return "";
  std::string text;
  for (std::size_t which = 0; which < 2; ++which) {
    if (problem.fingers[which].wheel) continue;
    text += fmt::format("{}{:.3g} at {}", text.empty() ? "" : ", ", plan.friction_needed[which],
                        finger_name(problem, which));
  }
  return "friction  needed: " + text + (plan.expanding ? "; the fingers press apart" : "") + "\n";
}

/// What the program prints of a plan: the verdict, what each finger does, what is left of each condition.
std::string plan_text(const Plan& plan, const PlanProblem& problem) {
  std::string text = verdict_text(plan, problem) + "\n\n" + bodies_table(plan, problem) + "\n";
  if (!plan.margins.empty()) text += margins_table(plan, problem) + "\n";
  text += path_text(plan) + friction_line(plan, problem);
  for (const std::string& what : plan.unchecked) text += "unchecked " + what + "\n";
  return text;
}

constexpr const char* kPlanExamples = R"(Examples:
  rollfix plan gallery:ellipse --finger disk,r=0.3 --start 1 --length 1.5 --limit speed=0.2 -o plan.csv
Two fingers on a part that is free to move; how far the second one rolls is found:
  rollfix plan gallery:ellipse --finger disk,r=0.3 --start 2.4 --start 7.2 --length 0.8 --friction 0.5 -o both.csv
  rollfix plan gallery:ellipse --finger disk,r=0.3 --start 2.4 --start 7.2 --length 0.8 --length 0.7 -o a.csv -o b.csv
A jaw and a wheel on a free pin:
  rollfix plan gallery:ellipse --finger jaw --finger wheel,r=0.3 --start 2.4 --length 0.3 --friction 0.4
)";

void require_plan_files(const PlanArguments& arguments) {
  const auto [tables, figures] = files_of(arguments);
  if (figures.size() > 1) {
    throw InputError(fmt::format("-o {} -o {}: expected one figure of the plan", figures[0], figures[1]));
  }
  for (const std::string& file : figures) require_writable(file, arguments.force);
  if (tables.size() == 2 && (tables[0] == tables[1] || tables[0] == "-" || tables[1] == "-")) {
    throw InputError(
        fmt::format("-o {} -o {}: expected the names of two files, one for each finger, or one -o for both fingers",
                    tables[0], tables[1]));
  }
  for (const std::string& file : tables) {
    require_writable_log(file, arguments.force);
    if (file == "-" && arguments.json) {
      throw InputError("-o - and --json both go to standard output: give the plan the name of a file");
    }
  }
}

ExitCode exit_code_of_plan(const Plan& plan) {
  if (plan.failure) return ExitCode::nothing_fits;
  return plan.decided ? ExitCode::fits : ExitCode::incomplete;
}

void add_plan_files(const PlanArguments& arguments, const Plan& plan, const PlanProblem& problem, Report& report) {
  const auto [tables, figures] = files_of(arguments);
  for (const std::string& file : figures) {
    report.files.push_back({file, encode(draw_plan({&plan, &problem}), figure_format(file)), arguments.force});
    report.notes.push_back(fmt::format("wrote {}", file));
  }
  if (tables.empty()) return;
  if (!plan.feasible()) {
    report.notes.emplace_back("no table is written: that roll is not to be done");
    return;
  }
  const std::string verdict = report.data.substr(0, report.data.find('\n'));
  if (tables.size() == 1) {
    add_log(report, tables[0], format_plan(plan), arguments.force);
    if (tables[0] == "-") report.notes.push_back(verdict);
    return;
  }
  for (const std::size_t which : {0U, 1U}) add_log(report, tables[which], format_plan(plan, which), arguments.force);
}

Report plan(const PlanArguments& arguments) {
  require_plan_files(arguments);
  Report report;
  const Part part = load_part(arguments.part, report.notes);
  const PlanProblem problem = read_plan_problem(arguments, part);
  if (part.reversed()) report.notes.push_back(reversed_note(part));
  const Plan plan = solve(problem);
  report.exit_code = exit_code_of_plan(plan);
  report.data = arguments.json ? format_plan_document(plan, problem) : plan_text(plan, problem);
  add_plan_files(arguments, plan, problem, report);
  return report;
}

}  // namespace

void add_plan_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command = program.add_subcommand(
      "plan",
      "Says what one finger, or two, have to do so that they roll as far as is asked, or what stands in the way.");
  command->footer(kPlanExamples);
  add_plan_arguments(*command, *arguments);
  command->callback([arguments, &chosen] { chosen = [arguments] { return plan(*arguments); }; });
}

}  // namespace rollfix::app
