#include <fmt/format.h>

#include <memory>
#include <numbers>
#include <optional>

#include "rollfix/commands.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/contact/rolling.hpp"
#include "rollfix/error.hpp"
#include "rollfix/finger_argument.hpp"
#include "rollfix/output_argument.hpp"
#include "rollfix/part_argument.hpp"
#include "rollfix/table.hpp"
#include "rollfix/typed_number.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kExamples = R"(Examples:
  rollfix simulate gallery:ellipse --finger disk,r=0.3 --start 1 --length 1.5 -o ellipse-roll.csv
  rollfix simulate gallery:spline --finger disk,r=0.1 --start 4 --length -0.8 --samples 11
  rollfix simulate gallery:cam --finger disk,r=0.2 --start 3 --rotation 200deg
)";

struct SimulateArguments {
  PartArgument part;
  std::vector<std::string> fingers;
  std::string start;
  std::string length;
  std::string rotation;
  std::string contact_angle;
  std::string samples;
  OutputArgument output;
};

void require_sensible(const SimulateArguments& arguments) {
  if (arguments.fingers.empty()) throw InputError("simulate: expected --finger, as in --finger disk,r=0.1, found none");
  if (arguments.start.empty())
    throw InputError("simulate: expected --start, the arc length of the first contact, found none");
  if (arguments.length.empty() == arguments.rotation.empty()) {
    throw InputError(fmt::format("simulate: expected --length or --rotation, found {}",
                                 arguments.length.empty() ? "neither" : "both"));
  }
}

/// Lengths are along the stored outline, as everywhere.
RollPlan plan_of(const SimulateArguments& arguments, const Part& part) {
  RollPlan plan;
  plan.start = read_number(arguments.start, "--start");
  if (!arguments.length.empty()) plan.distance = read_number(arguments.length, "--length");
  if (!arguments.rotation.empty()) plan.rotation = read_angle(arguments.rotation, "--rotation");
  if (!arguments.samples.empty()) plan.rows = read_count(arguments.samples, "--samples", 2);
  // u + psi is the direction from the finger's centre to the contact: a right angle left of the tangent.
  const double contact_angle =
      arguments.contact_angle.empty() ? 0 : read_angle(arguments.contact_angle, "--contact-angle");
  if (part.closed() || (plan.start >= 0 && plan.start <= part.perimeter())) {
    plan.psi = part.tangent(plan.start) + std::numbers::pi / 2 - contact_angle;
  }
  return plan;
}

std::string summary(const Part& part, const Roll& roll) {
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("rolled from s = {} over length {}; the tangent turned by {} deg", fixed(roll.s.front(), decimals),
                     fixed(roll.s.back() - roll.s.front(), decimals), degrees(roll.angle.back() - roll.angle.front()));
}

Report simulate(const SimulateArguments& arguments) {
  require_sensible(arguments);
  const bool to_file = !arguments.output.file.empty() && arguments.output.file != "-";
  if (to_file) require_writable(arguments.output.file, arguments.output.force);
  const DiskFinger finger = *read_finger(arguments.fingers);
  const Part part = load_part(arguments.part);
  const Roll roll = rollfix::roll(part, finger, plan_of(arguments, part));

  Report report;
  if (part.reversed()) report.notes.push_back(reversed_note(part));
  report.notes.push_back(summary(part, roll));
  if (to_file) {
    report.files.push_back({arguments.output.file, format_log(roll.log)});
    report.notes.push_back(fmt::format("wrote {}", arguments.output.file));
  } else {
    report.data = format_log(roll.log);
  }
  return report;
}

}  // namespace

void add_simulate_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = program.add_subcommand("simulate", "Writes the tactile log of a finger that rolls on a part.");
  command->footer(kExamples);
  add_part_argument(*command, arguments->part);
  add_finger_argument(*command, arguments->fingers);
  command->add_option("--start", arguments->start, "where the first contact is: arc length along the stored outline")
      ->type_name("S");
  command->add_option("--length", arguments->length, "how far to roll, negative for backwards")->type_name("L");
  command->add_option("--rotation", arguments->rotation, "or how far to turn the finger, negative for backwards")
      ->type_name("ANGLE");
  command
      ->add_option("--contact-angle", arguments->contact_angle, "where on the finger the first contact is; default 0")
      ->type_name("ANGLE");
  command->add_option("--samples", arguments->samples, "rows of the log, at equal times; default 101")->type_name("N");
  add_output_argument(*command, arguments->output, "the log, - for stdout, which is the default");
  command->callback([arguments, &chosen] { chosen = [arguments] { return simulate(*arguments); }; });
}

}  // namespace rollfix::app
