#include <fmt/format.h>

#include <array>
#include <numbers>
#include <optional>
#include <utility>

#include "log/mirrored.hpp"
#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/typed.hpp"
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
  if (!arguments.rotation.empty()) plan.rotation = written_angle(arguments.rotation, "--rotation");
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

namespace {

constexpr std::size_t kUsualRows = 101;

void require_a_wheel(const SimulateArguments& arguments) {
  const std::array<std::pair<bool, const char*>, 6> of_fingers = {
      {{!arguments.fingers.empty(), "--finger"},
       {!arguments.rotation.empty(), "--rotation"},
       {!arguments.part_rotation.empty(), "--part-rotation"},
       {!arguments.contacts.empty(), "--contact"},
       {!arguments.contact_angles.empty(), "--contact-angle"},
       {arguments.mirror, "--mirror"}}};
  for (const auto& [given, option] : of_fingers) {
    if (given) throw InputError(fmt::format("{} is of a finger, --odometer has none: give one of them", option));
  }
  if (arguments.starts.size() != 1 || arguments.lengths.size() != 1 || arguments.files.size() > 1) {
    throw InputError("simulate --odometer: expected one --start, one --length and at most one -o");
  }
}

double seconds_of(const SimulateArguments& arguments, std::size_t rows) {
  if (arguments.seconds.empty()) return static_cast<double>(rows);
  const double seconds = read_number(arguments.seconds, "--seconds");
  if (seconds > 0) return seconds;
  throw InputError(fmt::format("--seconds {}: expected a time above 0", arguments.seconds));
}

std::string drawn_text(const NoisyIncrements& drive, const Noise& noise) {
  std::string text = fmt::format("the wheel went {:.6g} % farther than it measured", 100 * drive.error.slip + 0.0);
  if (noise.gyro > 0) text += fmt::format("; turns are {:.6f} times what was measured", drive.turn_scale);
  if (noise.drift > 0) {
    constexpr double kDegreesPerHour = 3600 * 180 / std::numbers::pi;
    text += fmt::format("; the gyroscope's bias is {:.4g} deg/h", kDegreesPerHour * drive.turn_bias);
  }
  return text;
}

}  // namespace

Report simulate_wheel(const SimulateArguments& arguments) {
  require_a_wheel(arguments);
  const std::string file = arguments.files.empty() ? "-" : arguments.files.front();
  require_writable_log(file, arguments.force);
  Report report;
  const Part part = load_part(arguments.part, report.notes);
  const std::optional<SimulatedNoise> noise = read_simulated_noise(arguments, part.unit());
  const double start = read_length(arguments.starts.front(), "--start", part.unit());
  const double length = read_length(arguments.lengths.front(), "--length", part.unit());
  const std::size_t rows = arguments.samples.empty() ? kUsualRows : read_count(arguments.samples, "--samples", 1);
  const Noise sds = noise ? noise->noise : Noise{};
  const NoisyIncrements drive =
      noisy_increments(part, start, length, rows, sds, noise ? noise->seed : 0, seconds_of(arguments, rows));

  if (part.reversed()) report.notes.push_back(reversed_note(part));
  const double turned = part.turning().angle(start + length) - part.turning().angle(start);
  report.notes.push_back(roll_text(part, {start, start + length}, {0, turned}));
  if (noise) report.notes.push_back(drawn_text(drive, sds));
  add_log(report, file, format_log(drive.log), arguments.force);
  return report;
}

}  // namespace rollfix::app
