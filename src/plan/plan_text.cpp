#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>
#include <string>

#include "plan/planning.hpp"
#include "rollfix/plan.hpp"

namespace rollfix {
namespace {

/// Degrees for the reader; the plan has radians.
double in_degrees(double angle) { return angle * 180 / std::numbers::pi; }

/// The unit of lengths behind a number, if the part has one.
std::string unit_behind(const PlanProblem& problem) {
  const std::string& unit = problem.part.unit();
  return unit.empty() ? "" : " " + unit;
}

/// When and where a condition fails: the time, the row (counted from 1) and the contacts.
std::string when(const PlanMargin& margin) {
  std::string text = fmt::format("at {:.4g} s, row {}, with the contact{} at s = {:.6g}", margin.time, margin.row + 1,
                                 margin.place.size() == 2 ? "s" : "", margin.place[0]);
  if (margin.place.size() == 2) text += fmt::format(", t = {:.6g}", margin.place[1]);
  return text;
}

/// Why the force slips: how far it comes from the normal, and the friction that would hold it, margin included.
std::string friction_text(const PlanProblem& problem, const PlanMargin& margin) {
  const PlanFinger& finger = problem.fingers[margin.finger];
  const std::string name = planning::name_of_finger(problem, margin.finger);
  // |A| or |B| at worst: the cone less what is left
  const double tilt = margin.allowed - margin.value;
  // the friction angle that would do
  const double asked = tilt + problem.margin;
  // Beyond a right angle the force would have to pull.
  if (!finger.friction || asked >= 0.5 * std::numbers::pi) {
    return fmt::format("no friction would hold {}, first {}: at worst the force comes to {:.2f} deg from the normal",
                       name, when(margin), in_degrees(tilt));
  }
  return fmt::format(
      "{} slips, first {}: at worst the force comes to {:.2f} deg from the normal, and friction {:.4g} holds it up to "
      "{:.2f} deg{}; friction {:.4g} would do",
      name, when(margin), in_degrees(tilt), *finger.friction, in_degrees(margin.allowed),
      problem.margin > 0 ? fmt::format(", less a margin of {:.2f} deg", in_degrees(problem.margin)) : "",
      std::tan(asked));
}

/// Which limit is exceeded, by what is reached and what is allowed.
std::string limit_text(const PlanProblem& problem, const PlanMargin& margin) {
  const std::string name = planning::name_of_finger(problem, margin.finger);
  // `value` is what is left: below 0 here
  const double reached = margin.allowed - margin.value;
  const std::string unit = unit_behind(problem);
  switch (margin.condition) {
    case Condition::speed:
      return fmt::format("{} is too fast, first {}: up to {:.4g}{}/s, the limit is {:.4g}; take longer", name,
                         when(margin), reached, unit, margin.allowed);
    case Condition::turn:
      return fmt::format("{} turns too fast, first {}: up to {:.4g} deg/s, the limit is {:.4g}; take longer", name,
                         when(margin), in_degrees(reached), in_degrees(margin.allowed));
    case Condition::travel:
      return fmt::format("{} travels too far {}: {:.4g}{} in all, the limit is {:.4g}; roll less far", name,
                         when(margin), reached, unit, margin.allowed);
    default:
      return fmt::format("{} turns too far {}: {:.4g} deg in all, the limit is {:.4g}; roll less far", name,
                         when(margin), in_degrees(reached), in_degrees(margin.allowed));
  }
}

/// The sentence for a condition that fails.
std::string failure_text(const PlanProblem& problem, const PlanMargin& margin) {
  switch (margin.condition) {
    case Condition::friction:
      return friction_text(problem, margin);
    case Condition::reach:
      // An obstruction without depth is a concave corner.
      if (margin.value == 0) {
        return fmt::format("{} can't roll over the concave corner {}", planning::name_of_finger(problem, margin.finger),
                           when(margin));
      }
      return fmt::format("{} would hit the part, first {}: by up to {:.4g}{}",
                         planning::name_of_finger(problem, margin.finger), when(margin), -margin.value,
                         unit_behind(problem));
    case Condition::apart:
      return fmt::format("the fingers hit each other, first {}: they come to {:.4g}{} at worst{}", when(margin),
                         margin.value, unit_behind(problem),
                         problem.clearance > 0 ? fmt::format(", and {:.4g} is asked for", problem.clearance) : "");
    case Condition::stable:
      return fmt::format(
          "the part rolls out from between finger a and the wheel {}: the balance is not stable there "
          "({:.3g}, and above 0 it would be)",
          when(margin), margin.value);
    case Condition::turns_back:
      return fmt::format(
          "the wheel can't follow {}: its contact is a centre of curvature away from finger a's, and "
          "turns back; roll less far, or the other way",
          when(margin));
    default:
      return limit_text(problem, margin);
  }
}

/// How far each finger rolls, and in which time.
std::string success_text(const Plan& plan, const PlanProblem& problem) {
  std::string text;
  for (std::size_t which = 0; which < plan.length.size(); ++which) {
    text += fmt::format("{}{} rolls by {:.6g}{}", which == 0 ? "" : ", ", planning::name_of_finger(problem, which),
                        plan.length[which], unit_behind(problem));
  }
  return text + fmt::format(", in {:.4g} s", plan.duration);
}

}  // namespace

/// The word for a condition in JSON and on the command line.
const char* name_of(Condition condition) {
  switch (condition) {
    case Condition::reach:
      return "reach";
    case Condition::friction:
      return "friction";
    case Condition::apart:
      return "apart";
    case Condition::stable:
      return "stable";
    case Condition::turns_back:
      return "turns_back";
    case Condition::speed:
      return "speed";
    case Condition::turn:
      return "turn";
    case Condition::travel:
      return "travel";
    case Condition::rotation:
      return "rotation";
  }
  return "";
}

/// The first line of the answer: "plan: ...", "no plan: ..." with the failure that comes first, or "undecided: ...".
std::string verdict_text(const Plan& plan, const PlanProblem& problem) {
  if (plan.failure) return "no plan: " + failure_text(problem, plan.margins[*plan.failure]);
  if (!plan.decided) return "undecided: a margin is so near 0 that it is not proved to last between the rows";
  return "plan: " + success_text(plan, problem);
}

/// The table for the robot as CSV, docs/plan.md: 17 digits, so that reading it back gives the same numbers. `finger`:
/// its columns alone, without a suffix; none: all of them.
std::string format_plan(const Plan& plan, std::optional<std::size_t> finger) {
  const Log& log = plan.roll.log;
  const std::size_t fingers = log.fingers.size();
  std::vector<std::pair<std::string, const std::vector<double>*>> columns{{"time", &log.time}};
  for (std::size_t which = 0; which < fingers; ++which) {
    if (finger && *finger != which) continue;
    // With one finger in the table the columns have no suffix: it is a log of one finger.
    const std::string suffix = fingers == 1 || finger ? "" : which == 0 ? "_a" : "_b";
    const FingerRows& rows = log.fingers[which];
    const PlanRates& rates = plan.rates[which];
    columns.insert(columns.end(), {{"u" + suffix, &rows.u}, {"psi" + suffix, &rows.psi}});
    columns.insert(columns.end(), {{"x" + suffix, &rows.x}, {"y" + suffix, &rows.y}});
    columns.insert(columns.end(), {{"vx" + suffix, &rates.vx}, {"vy" + suffix, &rates.vy}});
    columns.emplace_back("omega" + suffix, &rates.omega);
  }
  // x, y and heading of the part as columns
  std::vector<double> pose[3];
  for (const Pose& one : plan.roll.pose) {
    pose[0].push_back(one.x);
    pose[1].push_back(one.y);
    pose[2].push_back(one.heading);
  }
  // What only a free part has.
  if (fingers == 2) {
    columns.insert(columns.end(), {{"part_x", &pose[0]}, {"part_y", &pose[1]}, {"part_heading", &pose[2]}});
    columns.emplace_back("force", &plan.force);
  }
  // the head, then the rows
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (std::size_t k = 0; k < columns.size(); ++k) fmt::format_to(out, "{}{}", k == 0 ? "" : ",", columns[k].first);
  text.push_back('\n');
  for (std::size_t row = 0; row < log.time.size(); ++row) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      fmt::format_to(out, "{}{:#.17g}", k == 0 ? "" : ",", (*columns[k].second)[row]);
    }
    text.push_back('\n');
  }
  return fmt::to_string(text);
}

}  // namespace rollfix
