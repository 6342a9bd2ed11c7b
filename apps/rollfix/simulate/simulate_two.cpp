#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "log/mirrored.hpp"
#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/typed.hpp"
#include "rollfix/error.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/simulate/simulation.hpp"
#include "rollfix/solve.hpp"

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
