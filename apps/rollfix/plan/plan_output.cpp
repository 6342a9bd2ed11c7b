#include "rollfix/plan/plan_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rollfix/output/table.hpp"

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

}  // namespace

std::string plan_text(const Plan& plan, const PlanProblem& problem) {
  std::string text = verdict_text(plan, problem) + "\n\n" + bodies_table(plan, problem) + "\n";
  if (!plan.margins.empty()) text += margins_table(plan, problem) + "\n";
  text += path_text(plan) + friction_line(plan, problem);
  for (const std::string& what : plan.unchecked) text += "unchecked " + what + "\n";
  return text;
}

}  // namespace rollfix::app
