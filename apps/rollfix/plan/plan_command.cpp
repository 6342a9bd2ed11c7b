#include <fmt/format.h>

#include <memory>

#include "rollfix/commands.hpp"
#include "rollfix/documents.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/plan/plan_arguments.hpp"
#include "rollfix/plan/plan_output.hpp"
#include "rollfix/simulate/simulation.hpp"

namespace rollfix::app {
namespace {

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

ExitCode exit_code_of(const Plan& plan) {
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
  report.exit_code = exit_code_of(plan);
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
