#include <fmt/format.h>

#include <optional>

#include "log/mirrored.hpp"
#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/simulate/simulation.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::app {
namespace {

void require_one_finger(const SimulateArguments& arguments) {
  if (arguments.fingers.empty()) throw InputError("simulate: expected --finger, as in --finger disk,r=0.1, found none");
  if (arguments.starts.empty()) {
    throw InputError("simulate: expected --start, the arc length of the first contact, found none");
  }
  if (arguments.lengths.empty() == arguments.rotation.empty()) {
    throw InputError(fmt::format("simulate: expected --length or --rotation, found {}",
                                 arguments.lengths.empty() ? "neither" : "both"));
  }
}

/// Where on the finger the first contact is: an angle of a disk, which turns it, or an arc length of any other.
void place_contact(const SimulateArguments& arguments, const Part& part, const Finger& finger, RollPlan& plan) {
  if (finger.is_disk()) {
    if (!arguments.contacts.empty())
      throw InputError("--contact is of a jaw or an outline; a disk has --contact-angle");
    plan.psi = orientation_at(part, plan.start, arguments, 0);
    return;
  }
  if (!arguments.contact_angles.empty()) {
    throw InputError("--contact-angle is of a disk; a jaw or an outline has --contact, an arc length");
  }
  if (!arguments.contacts.empty()) plan.u = read_length(arguments.contacts.front(), "--contact", part.unit());
}

/// Lengths are along the stored outline, as everywhere.
RollPlan plan_of(const SimulateArguments& arguments, const Part& part, const Finger& finger) {
  RollPlan plan;
  plan.start = read_length(arguments.starts.front(), "--start", part.unit());
  if (!arguments.lengths.empty()) {
    plan.distance = read_length(arguments.lengths.front(), "--length", part.unit());
  }
  if (!arguments.rotation.empty()) plan.rotation = read_angle(arguments.rotation, "--rotation");
  if (!arguments.samples.empty()) plan.rows = read_count(arguments.samples, "--samples", 2);
  place_contact(arguments, part, finger, plan);
  return plan;
}

}  // namespace

Report simulate_one(const SimulateArguments& arguments) {
  require_one_finger(arguments);
  const std::string file = arguments.files.empty() ? "-" : arguments.files.front();
  require_writable_log(file, arguments.force);
  Report report;
  const Part part = load_part(arguments.part, report.notes);
  const std::optional<SimulatedNoise> noise = read_simulated_noise(arguments, part.unit());
  const Finger finger = read_fingers(arguments.fingers, 1, part.unit()).front();
  // What rolls on the drawn outline is what a mirror shows of the finger.
  const Finger seen = arguments.mirror ? mirrored(finger) : finger;
  RollPlan plan = plan_of(arguments, part, finger);
  if (arguments.mirror && plan.u) plan.u = mirrored_u(finger, *plan.u);
  NoisyRoll noisy;
  if (noise) {
    noisy = noisy_roll(part, seen, plan, noise->noise, noise->seed);
  } else {
    noisy.truth = rollfix::roll(part, seen, plan);
    noisy.log = noisy.truth.log;
  }
  const Roll& roll = noisy.truth;

  if (part.reversed()) report.notes.push_back(reversed_note(part));
  report.notes.push_back(roll_text(part, roll.s[0], roll.angle[0]));
  add_reach_note(report, beyond_reach_note(part, finger, roll.s[0], "a real finger "));
  if (noise) report.notes.push_back(roll_error_text(finger, noisy.error[0]));
  add_log(report, file, format_log(arguments.mirror ? in_mirror(noisy.log, {seen}) : noisy.log), arguments.force);
  return report;
}

}  // namespace rollfix::app
