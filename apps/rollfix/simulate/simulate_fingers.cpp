#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <utility>

#include "log/mirrored.hpp"
#include "rollfix/arguments/arguments.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/output/table.hpp"
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

// ---- two fingers

namespace {

void require_two(const std::vector<std::string>& values, const char* option) {
  if (values.size() == 2) return;
  throw InputError(fmt::format("simulate: expected {} twice for two fingers, finger a's first, found it {}", option,
                               values.empty()       ? "nowhere"
                               : values.size() == 1 ? "once"
                                                    : fmt::format("{} times", values.size())));
}

void require_at_most_two(const std::vector<std::string>& values, const char* option) {
  if (values.size() <= 2) return;
  throw InputError(fmt::format("simulate: {} is given {} times, expected at most two fingers", option, values.size()));
}

void require_two_fingers(const SimulateArguments& arguments) {
  if (arguments.fingers.empty()) {
    throw InputError("simulate: expected --finger, as in --finger disk,r=0.1, once or for each of two fingers");
  }
  require_at_most_two(arguments.fingers, "--finger");
  require_at_most_two(arguments.contact_angles, "--contact-angle");
  require_at_most_two(arguments.contacts, "--contact");
  require_two(arguments.starts, "--start");
  if (!arguments.rotation.empty()) {
    throw InputError("simulate: --rotation is of one finger; two fingers take --length twice, and --part-rotation");
  }
  require_two(arguments.lengths, "--length");
}

FreeFinger plan_of(const SimulateArguments& arguments, const Part& part, const Finger& seen, std::size_t which) {
  FreeFinger finger;
  finger.finger = arguments.mirror ? mirrored(seen) : seen;
  finger.start = read_length(arguments.starts[which], "--start", part.unit());
  finger.distance = read_length(arguments.lengths[which], "--length", part.unit());
  if (seen.is_disk()) {
    finger.psi = orientation_at(part, finger.start, arguments, which);
  } else if (const std::vector<std::string>& typed = arguments.contacts; !typed.empty()) {
    const double u = read_length(typed[std::min(which, typed.size() - 1)], "--contact", part.unit());
    finger.u = arguments.mirror ? mirrored_u(seen, u) : u;
  }
  return finger;
}

FreePlan plan_of(const SimulateArguments& arguments, const Part& part, const std::vector<Finger>& fingers) {
  FreePlan plan;
  for (const std::size_t which : {0U, 1U}) {
    plan.fingers[which] = plan_of(arguments, part, *finger_of(fingers, which), which);
  }
  if (!arguments.part_rotation.empty()) plan.part_rotation = written_angle(arguments.part_rotation, "--part-rotation");
  if (!arguments.samples.empty()) plan.rows = read_count(arguments.samples, "--samples", 2);
  return plan;
}

std::string part_text(const Part& part, const Roll& roll) {
  const int decimals = decimals_for(part.perimeter());
  const Pose& first = roll.pose.front();
  const Pose& last = roll.pose.back();
  return fmt::format("the part turned by {} deg and its frame's origin moved by ({}, {})",
                     degrees(last.heading - first.heading), fixed(last.x - first.x, decimals),
                     fixed(last.y - first.y, decimals));
}

void add_overlap_note(const Part& part, const std::vector<Finger>& fingers, const Roll& roll, Report& report) {
  const auto overlap = overlap_of(roll, *finger_of(fingers, 0), *finger_of(fingers, 1));
  if (!overlap) return;
  report.notes.push_back(fmt::format(
      "the fingers overlap, by {} in row {} of the log: locate leaves out such a roll, unless --may-overlap "
      "says that they are at different heights",
      rough(overlap->depth) + behind(part.unit()), overlap->row + 1));
}

void add_logs(Report& report, const std::vector<std::string>& files, const Log& log, bool force) {
  if (files.size() == 2) {
    for (const std::size_t which : {0U, 1U}) add_log(report, files[which], format_log(one_finger(log, which)), force);
  } else {
    add_log(report, files.empty() ? "-" : files.front(), format_log(log), force);
  }
}

}  // namespace

void require_logs_of_two(const std::vector<std::string>& files, bool force) {
  require_at_most_two(files, "-o");
  if (files.size() == 2 && (files[0] == files[1] || files[0] == "-" || files[1] == "-")) {
    throw InputError(
        fmt::format("-o {} -o {}: expected the names of two files, one for each finger, or one -o for both fingers",
                    files[0], files[1]));
  }
  for (const std::string& file : files) require_writable_log(file, force);
}

void report_two(const SimulateArguments& arguments, const Part& part, const std::vector<Finger>& fingers,
                const PerFinger<std::string>& names, const NoisyRoll& noisy, const Log& log, Report& report) {
  const Roll& roll = noisy.truth;
  if (part.reversed()) report.notes.push_back(reversed_note(part));
  for (const std::size_t which : {0U, 1U}) {
    report.notes.push_back(names[which] + " " + roll_text(part, roll.s[which], roll.angle[which]));
  }
  for (const std::size_t which : {0U, 1U}) {
    add_reach_note(report,
                   beyond_reach_note(part, *finger_of(fingers, which), roll.s[which], "a real " + names[which] + " "));
  }
  add_overlap_note(part, fingers, roll, report);
  report.notes.push_back(part_text(part, roll));
  for (std::size_t which = 0; which < 2 && !arguments.noise.empty(); ++which) {
    report.notes.push_back(names[which] + ": " + roll_error_text(*finger_of(fingers, which), noisy.error[which]));
  }
  add_logs(report, arguments.files, log, arguments.force);
}

Report simulate_two(const SimulateArguments& arguments) {
  require_two_fingers(arguments);
  require_logs_of_two(arguments.files, arguments.force);
  Report report;
  const Part part = load_part(arguments.part, report.notes);
  const std::optional<SimulatedNoise> noise = read_simulated_noise(arguments, part.unit());
  const std::vector<Finger> fingers = read_fingers(arguments.fingers, 2, part.unit());
  require_owners(arguments.contact_angles, fingers, true);
  require_owners(arguments.contacts, fingers, false);
  const FreePlan plan = plan_of(arguments, part, fingers);
  NoisyRoll noisy;
  if (noise) {
    noisy = noisy_roll_free(part, plan, noise->noise, noise->seed);
  } else {
    noisy.truth = roll_free(part, plan);
    noisy.log = noisy.truth.log;
  }
  // What rolls on the drawn outline is what a mirror shows of the fingers.
  const std::vector<Finger> seen{plan.fingers[0].finger, plan.fingers[1].finger};
  report_two(arguments, part, seen, {"finger a", "finger b"}, noisy,
             arguments.mirror ? in_mirror(noisy.log, seen) : noisy.log, report);
  return report;
}

}  // namespace rollfix::app
