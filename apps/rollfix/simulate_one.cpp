#include <fmt/format.h>

#include "rollfix/contact/log.hpp"
#include "rollfix/contact/rolling.hpp"
#include "rollfix/error.hpp"
#include "rollfix/finger_argument.hpp"
#include "rollfix/simulation.hpp"
#include "rollfix/typed_number.hpp"

namespace rollfix::app {
namespace {

void require_sensible(const SimulateArguments& arguments) {
  if (arguments.fingers.empty()) throw InputError("simulate: expected --finger, as in --finger disk,r=0.1, found none");
  if (arguments.starts.empty()) {
    throw InputError("simulate: expected --start, the arc length of the first contact, found none");
  }
  if (arguments.lengths.empty() == arguments.rotation.empty()) {
    throw InputError(fmt::format("simulate: expected --length or --rotation, found {}",
                                 arguments.lengths.empty() ? "neither" : "both"));
  }
}

/// Lengths are along the stored outline, as everywhere.
RollPlan plan_of(const SimulateArguments& arguments, const Part& part) {
  RollPlan plan;
  plan.start = read_number(arguments.starts.front(), "--start");
  if (!arguments.lengths.empty()) plan.distance = read_number(arguments.lengths.front(), "--length");
  if (!arguments.rotation.empty()) plan.rotation = read_angle(arguments.rotation, "--rotation");
  if (!arguments.samples.empty()) plan.rows = read_count(arguments.samples, "--samples", 2);
  plan.psi = orientation_at(part, plan.start, arguments, 0);
  return plan;
}

}  // namespace

Report simulate_one(const SimulateArguments& arguments) {
  require_sensible(arguments);
  const std::string file = arguments.files.empty() ? "-" : arguments.files.front();
  require_writable_log(file, arguments.force);
  const DiskFinger finger = *read_finger(arguments.fingers);
  Report report;
  const Part part = load_part(arguments.part, report.notes);
  const Roll roll = rollfix::roll(part, finger, plan_of(arguments, part));

  if (part.reversed()) report.notes.push_back(reversed_note(part));
  report.notes.push_back(roll_text(part, roll.s, roll.angle));
  add_reach_note(report, beyond_reach_note(part, finger, roll.s, "a real finger "));
  add_log(report, file, format_log(roll.log));
  return report;
}

}  // namespace rollfix::app
