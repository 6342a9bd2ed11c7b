#include <fmt/format.h>

#include <array>
#include <numbers>
#include <optional>
#include <utility>

#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/simulate/simulation.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::app {
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
