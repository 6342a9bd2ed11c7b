#include <fmt/format.h>

#include <optional>

#include "rollfix/contact/free_part.hpp"
#include "rollfix/error.hpp"
#include "rollfix/finger_argument.hpp"
#include "rollfix/simulation.hpp"
#include "rollfix/table.hpp"
#include "rollfix/typed_number.hpp"

namespace rollfix::app {
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
  require_at_most_two(arguments.files, "-o");
  require_two(arguments.starts, "--start");
  if (!arguments.rotation.empty()) {
    throw InputError("simulate: --rotation is of one finger; two fingers take --length twice, and --part-rotation");
  }
  require_two(arguments.lengths, "--length");
  const std::vector<std::string>& files = arguments.files;
  if (files.size() == 2 && (files[0] == files[1] || files[0] == "-" || files[1] == "-")) {
    throw InputError(
        fmt::format("-o {} -o {}: expected the names of two files, one for each finger, or one -o for both fingers",
                    files[0], files[1]));
  }
}

FreeFinger finger_of(const SimulateArguments& arguments, const Part& part, const Finger& disk, std::size_t which) {
  FreeFinger finger;
  finger.disk = *disk.disk();
  finger.start = read_number(arguments.starts[which], "--start");
  finger.distance = read_number(arguments.lengths[which], "--length");
  finger.psi = orientation_at(part, finger.start, arguments, which);
  return finger;
}

FreePlan plan_of(const SimulateArguments& arguments, const Part& part, const FingerPair& fingers) {
  FreePlan plan;
  plan.a = finger_of(arguments, part, fingers[0], 0);
  plan.b = finger_of(arguments, part, fingers[1], 1);
  if (!arguments.part_rotation.empty()) plan.part_rotation = read_angle(arguments.part_rotation, "--part-rotation");
  if (!arguments.samples.empty()) plan.rows = read_count(arguments.samples, "--samples", 2);
  return plan;
}

std::string part_text(const Part& part, const FreeRoll& roll) {
  const int decimals = decimals_for(part.perimeter());
  const Pose& first = roll.pose.front();
  const Pose& last = roll.pose.back();
  return fmt::format("the part turned by {} deg and its frame's origin moved by ({}, {})",
                     degrees(last.heading - first.heading), fixed(last.x - first.x, decimals),
                     fixed(last.y - first.y, decimals));
}

void add_logs(Report& report, const std::vector<std::string>& files, const PairLog& log) {
  if (files.size() == 2) {
    add_log(report, files[0], format_log(log.a));
    add_log(report, files[1], format_log(log.b));
  } else {
    add_log(report, files.empty() ? "-" : files.front(), format_pair_log(log));
  }
}

}  // namespace

Report simulate_two(const SimulateArguments& arguments) {
  require_two_fingers(arguments);
  for (const std::string& file : arguments.files) require_writable_log(file, arguments.force);
  const std::optional<SimulatedNoise> noise = read_simulated_noise(arguments);
  if (!arguments.contact.empty())
    throw InputError("--contact is of one finger with an outline; disks have --contact-angle");
  const std::vector<Finger> disks = read_fingers(arguments.fingers, 2);
  require_disks(disks, "simulate with two fingers");
  const FingerPair fingers{disks.front(), disks.back()};
  Report report;
  const Part part = load_part(arguments.part, report.notes);
  const FreePlan plan = plan_of(arguments, part, fingers);
  NoisyFreeRoll noisy;
  if (noise) {
    noisy = noisy_roll_free(part, plan, noise->noise, noise->seed);
  } else {
    noisy.truth = roll_free(part, plan);
    noisy.log = noisy.truth.log;
  }
  const FreeRoll& roll = noisy.truth;

  if (part.reversed()) report.notes.push_back(reversed_note(part));
  report.notes.push_back("finger a " + roll_text(part, roll.s, roll.angle_a));
  report.notes.push_back("finger b " + roll_text(part, roll.t, roll.angle_b));
  add_reach_note(report, beyond_reach_note(part, fingers[0], roll.s, "a real finger a "));
  add_reach_note(report, beyond_reach_note(part, fingers[1], roll.t, "a real finger b "));
  report.notes.push_back(part_text(part, roll));
  if (noise) {
    report.notes.push_back("finger a: " + roll_error_text(fingers[0], noisy.error[0]));
    report.notes.push_back("finger b: " + roll_error_text(fingers[1], noisy.error[1]));
  }
  add_logs(report, arguments.files, noisy.log);
  return report;
}

}  // namespace rollfix::app
