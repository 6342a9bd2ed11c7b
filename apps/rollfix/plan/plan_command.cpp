#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/arguments/arguments.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/plan.hpp"
#include "rollfix/program.hpp"
#include "rollfix/simulate/simulation.hpp"
#include "text/text.hpp"

namespace rollfix::app {

/// What `rollfix plan` was given, as typed. Entry 0 of a list is finger a's, entry 1 finger b's.
struct PlanArguments {
  PartArgument part;
  std::vector<std::string> fingers;
  std::vector<std::string> starts;
  std::vector<std::string> lengths;
  std::vector<std::string> contact_angles;
  std::vector<std::string> contacts;
  std::string friction;
  std::string margin;
  std::string clearance;
  std::string limits;
  std::string duration;
  std::string pose;
  std::string part_rotation;
  std::string stays;
  std::string samples;
  std::vector<std::string> files;
  bool mirror = false;
  bool may_overlap = false;
  bool json = false;
  bool force = false;
};

/// Of -o the figure, .svg, .png or .pdf, and the tables.
struct PlanFiles {
  std::vector<std::string> tables;
  std::vector<std::string> figures;
};
PlanFiles files_of(const PlanArguments& arguments);

/// Adds all of them to a command.
void add_plan_arguments(CLI::App& command, PlanArguments& arguments);

/// The problem that is meant. Throws InputError.
PlanProblem read_plan_problem(const PlanArguments& arguments, const Part& part);

namespace {

/// A wheel is a disk on a free pin.
std::vector<Finger> read_shapes(const std::vector<std::string>& typed, std::size_t count, const std::string& unit) {
  std::vector<Finger> shapes;
  for (const std::string& text : typed) {
    shapes.push_back(names_wheel(text) ? disk(read_wheel(text, unit)) : read_fingers({text}, count, unit).front());
  }
  return shapes;
}

std::size_t count_of_fingers(const PlanArguments& arguments) {
  const std::size_t most =
      std::max({arguments.fingers.size(), arguments.starts.size(), arguments.lengths.size(),
                arguments.contact_angles.size(), arguments.contacts.size(), files_of(arguments).tables.size()});
  if (most > 2) {
    throw InputError("plan: expected one finger on a part at rest, or two that hold it; found an option three times");
  }
  return std::max<std::size_t>(1, most);
}

/// "20mm" or "20mm/s".
std::string_view per_second(std::string_view text) {
  const std::size_t mark = text.rfind("/s");
  return mark != std::string_view::npos && mark + 2 == text.size() ? text.substr(0, mark) : text;
}

PlanLimits read_limits(const std::string& text, const std::string& unit) {
  PlanLimits limits;
  if (text.empty()) return limits;
  const std::string what = "--limit " + text;
  for (const std::string_view field : split(text, ',')) {
    const std::size_t mark = field.find('=');
    const std::string_view name = field.substr(0, mark);
    const std::string_view value = mark == std::string_view::npos ? "" : field.substr(mark + 1);
    std::optional<double>* const limit = name == "speed"      ? &limits.speed
                                         : name == "turn"     ? &limits.turn
                                         : name == "travel"   ? &limits.travel
                                         : name == "rotation" ? &limits.rotation
                                                              : nullptr;
    if (limit == nullptr || value.empty()) {
      throw InputError(fmt::format(
          "{}: '{}' is none of speed=LENGTH, turn=ANGLE (both per second), travel=LENGTH and rotation=ANGLE, "
          "as in speed=20mm,turn=30deg",
          what, field));
    }
    if (*limit) throw InputError(fmt::format("{}: {} is given twice", what, name));
    const bool is_length = name == "speed" || name == "travel";
    *limit = is_length ? read_length(per_second(value), what, unit) : written_angle(per_second(value), what);
    if (!(**limit > 0)) throw InputError(fmt::format("{}: expected a {} above 0, found {}", what, name, value));
  }
  return limits;
}

Pose read_start_pose(const std::string& text, const std::string& unit) {
  if (text.empty()) return {};
  const std::string what = "--pose " + text;
  const std::vector<std::string_view> fields = fields_of(
      text, what, 3, 3, "expected X,Y,HEADING as in 100,40,12deg: where the part lies in the world at the start");
  return {read_length(fields[0], what, unit), read_length(fields[1], what, unit), written_angle(fields[2], what)};
}

Staying read_staying(const std::string& text) {
  if (text.empty()) return Staying::middle;
  if (text == "a") return Staying::a;
  if (text == "b") return Staying::b;
  if (text == "part") return Staying::part;
  throw InputError(fmt::format("--stays {}: expected a, b or part: what stays in place while two fingers roll", text));
}

void read_friction(const std::string& text, PlanProblem& problem) {
  if (text.empty()) return;
  const std::vector<double> friction = read_coefficients(text, problem.fingers.size());
  for (std::size_t which = 0; which < problem.fingers.size(); ++which) {
    problem.fingers[which].friction = friction[which];
  }
}

PlanFinger read_plan_finger(const PlanArguments& arguments, const Part& part, const Finger& shape, std::size_t which,
                            double heading) {
  PlanFinger finger;
  finger.finger = shape;
  const std::vector<std::string>& typed = arguments.fingers;
  finger.wheel = !typed.empty() && names_wheel(typed[std::min(which, typed.size() - 1)]);
  if (which < arguments.starts.size()) finger.start = read_length(arguments.starts[which], "--start", part.unit());
  if (which < arguments.lengths.size()) finger.length = read_length(arguments.lengths[which], "--length", part.unit());
  if (!shape.is_disk()) {
    const std::vector<std::string>& places = arguments.contacts;
    if (!places.empty()) {
      finger.u = read_length(places[std::min(which, places.size() - 1)], "--contact", part.unit());
    }
    return finger;
  }
  const std::vector<std::string>& angles = arguments.contact_angles;
  const double angle =
      angles.empty() ? 0 : written_angle(angles[std::min(which, angles.size() - 1)], "--contact-angle");
  const double s = finger.start.value_or(0);
  if (part.closed() || (s >= 0 && s <= part.perimeter())) {
    const double inward = part.tangent(s) + std::numbers::pi / 2;
    finger.psi = heading + (arguments.mirror ? std::numbers::pi - inward : inward) - angle;
  }
  return finger;
}

void require_given(const PlanArguments& arguments, std::size_t fingers) {
  if (arguments.fingers.empty()) throw InputError("plan: expected --finger, as in --finger disk,r=0.1, found none");
  if (arguments.lengths.empty()) {
    throw InputError("plan: expected --length, how far the finger, of two finger a, is to roll, found none");
  }
  const bool has_wheel = std::any_of(arguments.fingers.begin(), arguments.fingers.end(), names_wheel);
  const std::size_t least = has_wheel ? 1 : fingers;
  if (arguments.starts.size() < least) {
    throw InputError(fmt::format("plan: expected --start {}, the arc length of each first contact, found it {}",
                                 fingers == 2 ? "twice" : "once", arguments.starts.empty() ? "nowhere" : "once"));
  }
}

}  // namespace

PlanFiles files_of(const PlanArguments& arguments) {
  PlanFiles files;
  for (const std::string& file : arguments.files) {
    const std::string ending = ending_of(file);
    const bool is_figure = ending == ".svg" || ending == ".png" || ending == ".pdf";
    (is_figure ? files.figures : files.tables).push_back(file);
  }
  return files;
}

void add_plan_arguments(CLI::App& command, PlanArguments& arguments) {
  add_part_argument(command, arguments.part);
  command
      .add_option("--finger", arguments.fingers,
                  "disk,r=RADIUS, jaw, or the file of a convex outline; once for both fingers or for each; the second "
                  "may be wheel,r=RADIUS, a disk on a free pin that nothing turns")
      ->type_name("FINGER")
      ->allow_extra_args(false);
  add_repeated_option(command, "--start", arguments.starts, "S",
                      "where the first contact is: arc length along the stored outline; twice for two fingers; a "
                      "wheel's may be left out");
  add_repeated_option(command, "--length", arguments.lengths, "L",
                      "how far to roll, negative for backwards; of two fingers the second one's may be left out: then "
                      "the best is found");
  command.add_option("--friction", arguments.friction, "friction of the fingers on the part: one coefficient, or two")
      ->type_name("MU[,MU]");
  command.add_option("--margin", arguments.margin, "how far the force must stay inside the friction cones; default 0")
      ->type_name("ANGLE");
  command.add_option("--clearance", arguments.clearance, "how far the fingers must stay apart; default 0")
      ->type_name("LENGTH");
  command
      .add_option("--limit", arguments.limits,
                  "what the robot can do: speed=LENGTH and turn=ANGLE, both per second, travel=LENGTH and "
                  "rotation=ANGLE from the start; any of them")
      ->type_name("NAME=VALUE,...");
  command.add_option("--duration", arguments.duration, "seconds; default: the shortest within the limits")
      ->type_name("T");
  command.add_option("--pose", arguments.pose, "where the part lies in the world at the start; default 0,0,0")
      ->type_name("X,Y,HEADING");
  command
      .add_option("--part-rotation", arguments.part_rotation,
                  "how far the part turns meanwhile; two fingers only; default: so that the force keeps its direction, "
                  "beside a wheel so that finger a does not turn")
      ->type_name("ANGLE");
  command
      .add_option("--stays", arguments.stays,
                  "what stays in place: finger a, finger b, or the origin of the part; default: the "
                  "middle between both fingers")
      ->type_name("a|b|part");
  add_repeated_option(command, "--contact-angle", arguments.contact_angles, "ANGLE",
                      "where on a disk the first contact is; default 0; once for both fingers or for each");
  add_repeated_option(
      command, "--contact", arguments.contacts, "U",
      "where on a jaw or an outline the first contact is, arc length; once for both fingers or for each");
  add_switch(command, "--mirror", arguments.mirror,
             "the part lies face down: the fingers roll on the mirror image of the outline; --start and --length are "
             "along the outline as it was drawn");
  add_switch(command, "--may-overlap", arguments.may_overlap,
             "two fingers at different heights: they may pass one another");
  command.add_option("--samples", arguments.samples, "rows of the plan, at equal times; default 101")->type_name("N");
  add_switch(command, "--json", arguments.json, "print JSON");
  add_repeated_option(command, "-o", arguments.files, "FILE",
                      "the plan as a table that locate reads, - for stdout; twice: a table for each of two fingers; "
                      "with .svg, .png or .pdf a figure");
  add_switch(command, "--force", arguments.force, "replace files that exist");
}

PlanProblem read_plan_problem(const PlanArguments& arguments, const Part& part) {
  const std::size_t count = count_of_fingers(arguments);
  require_given(arguments, count);
  const std::vector<Finger> shapes = read_shapes(arguments.fingers, count, part.unit());
  require_owners(arguments.contact_angles, shapes, true);
  require_owners(arguments.contacts, shapes, false);
  PlanProblem problem{part, PerFinger<PlanFinger>::of(count)};
  problem.pose = read_start_pose(arguments.pose, part.unit());
  for (std::size_t which = 0; which < count; ++which) {
    problem.fingers[which] = read_plan_finger(arguments, part, *finger_of(shapes, which), which, problem.pose.heading);
  }
  read_friction(arguments.friction, problem);
  if (!arguments.part_rotation.empty())
    problem.part_rotation = written_angle(arguments.part_rotation, "--part-rotation");
  problem.staying = read_staying(arguments.stays);
  problem.limits = read_limits(arguments.limits, part.unit());
  if (!arguments.duration.empty()) problem.duration = read_number(arguments.duration, "--duration");
  if (!arguments.margin.empty()) problem.margin = written_angle(arguments.margin, "--margin");
  if (!arguments.clearance.empty()) problem.clearance = read_length(arguments.clearance, "--clearance", part.unit());
  problem.mirrored = arguments.mirror;
  problem.may_overlap = arguments.may_overlap;
  if (!arguments.samples.empty()) problem.rows = read_count(arguments.samples, "--samples", 2);
  return problem;
}

// ---- the command

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
