#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "log/mirrored.hpp"
#include "rollfix/arguments/arguments.hpp"
#include "rollfix/error.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/simulate/simulation.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr std::string_view kWheelPrefix = "wheel,";
// A typed --start of a squeezed wheel means the place within this share of the perimeter where it can be squeezed.
constexpr double kMeant = 0.02;

bool is_wheel(const std::string& finger) { return finger.substr(0, kWheelPrefix.size()) == kWheelPrefix; }

void require_rig(const SimulateArguments& arguments) {
  const std::vector<std::string>& fingers = arguments.fingers;
  if (fingers.size() != 2 || fingers[0] != "jaw" || !is_wheel(fingers[1])) {
    std::string found;
    for (const std::string& finger : fingers) found += " --finger " + finger;
    throw InputError(fmt::format(
        "simulate: expected a jaw and a wheel on a pin, --finger jaw --finger wheel,r=RADIUS in this order, found{}",
        found.empty() ? " no --finger" : found));
  }
  if (!arguments.lengths.empty() || !arguments.rotation.empty() || !arguments.part_rotation.empty()) {
    const char* const option = !arguments.lengths.empty()    ? "--length"
                               : !arguments.rotation.empty() ? "--rotation"
                                                             : "--part-rotation";
    throw InputError(
        fmt::format("simulate: {} is of fingers that roll as told; a wheel on a pin rolls as its pin moves: "
                    "--pin DX,DY, and --jaw-rotation",
                    option));
  }
  if (arguments.pin.empty()) {
    throw InputError(arguments.squeeze ? "simulate: expected --pin DX, how far the pin moves along the jaw, found none"
                                       : "simulate: expected --pin DX,DY, how far the pin moves in the "
                                         "jaw's frame, found none");
  }
  const std::size_t starts = arguments.starts.size();
  if (starts != 2 && !(arguments.squeeze && starts == 1)) {
    throw InputError(fmt::format("simulate: expected --start twice, the jaw's first{}, found it {} times",
                                 arguments.squeeze ? ", or once, the jaw's" : "", starts));
  }
  if (arguments.contact_angles.size() > 1) throw InputError("--contact-angle is of the wheel alone; give it once");
  if (arguments.contacts.size() > 1) throw InputError("--contact is of the jaw alone; give it once");
}

WheelSensors read_sensors(const std::string& text) {
  if (text.empty() || text == "skin") return WheelSensors::skin;
  if (text == "encoder") return WheelSensors::encoder;
  if (text == "pin") return WheelSensors::pin;
  throw InputError(fmt::format("--wheel {}: expected skin, encoder or pin, what is measured of the wheel", text));
}

/// --pin as typed: how far along the jaw and away from it.
Vec2 read_pin(const SimulateArguments& arguments, const std::string& unit) {
  const std::string what = "--pin " + arguments.pin;
  const std::vector<std::string_view> fields = split(arguments.pin, ',');
  const std::size_t expected = arguments.squeeze ? 1 : 2;
  if (fields.size() != expected) {
    throw InputError(fmt::format("{}: expected {}, found {} numbers", what,
                                 arguments.squeeze
                                     ? "DX alone, because a squeezed wheel finds its own way across the jaw"
                                     : "DX,DY, as in --pin 0.3,-0.1",
                                 fields.size()));
  }
  return {read_length(fields[0], what, unit), expected == 1 ? 0 : read_length(fields[1], what, unit)};
}

std::string listed(const std::vector<double>& places, int decimals) {
  std::string text;
  for (std::size_t k = 0; k < places.size(); ++k) {
    text += (k == 0 ? "" : k + 1 == places.size() ? " and " : ", ") + fixed(places[k], decimals);
  }
  return text;
}

/// The wheel's first contact where it is squeezed: the place that is meant by the second --start, or the only one.
double squeezed_start(const SimulateArguments& arguments, const Part& part, double radius, double s) {
  const std::vector<double> places = squeezed_places(part, radius, s);
  const int decimals = decimals_for(part.perimeter());
  if (places.empty()) {
    throw InputError(
        fmt::format("simulate: expected a place where the wheel can be squeezed against the jaw at s = {}, "
                    "found none in a stable grip; start the jaw elsewhere, or take another wheel",
                    fixed(s, decimals)));
  }
  if (arguments.starts.size() == 1) {
    if (places.size() == 1) return places.front();
    throw InputError(fmt::format("simulate: the wheel can be squeezed at s = {}: choose by a second --start",
                                 listed(places, decimals)));
  }
  const double wanted = read_length(arguments.starts[1], "--start", part.unit());
  const double nearest = *std::min_element(places.begin(), places.end(), [&](double one, double other) {
    return part.distance(one, wanted) < part.distance(other, wanted);
  });
  if (part.distance(nearest, wanted) <= kMeant * part.perimeter()) return nearest;
  throw InputError(fmt::format("simulate: --start {}: the wheel can't be squeezed there, expected a place near s = {}",
                               arguments.starts[1], listed(places, decimals)));
}

RigPlan plan_of(const SimulateArguments& arguments, const Part& part, double radius) {
  Vec2 pin = read_pin(arguments, part.unit());
  RigPlan plan;
  plan.radius = radius;
  plan.squeezed = arguments.squeeze;
  plan.start[0] = read_length(arguments.starts[0], "--start", part.unit());
  plan.start[1] = arguments.squeeze ? squeezed_start(arguments, part, radius, plan.start[0])
                                    : read_length(arguments.starts[1], "--start", part.unit());
  plan.psi = orientation_at(part, plan.start[1], arguments, 0);
  if (!arguments.contacts.empty()) plan.u = read_length(arguments.contacts[0], "--contact", part.unit());
  if (!arguments.samples.empty()) plan.rows = read_count(arguments.samples, "--samples", 2);
  double turn = arguments.jaw_rotation.empty() ? 0 : written_angle(arguments.jaw_rotation, "--jaw-rotation");
  if (arguments.mirror) {  // on the drawn outline rolls what a mirror shows
    plan.u = mirrored_u(jaw(), plan.u);
    pin.x() = 0.0 - pin.x();
    turn = 0.0 - turn;
  }
  plan.pin = [pin](double time) { return Vec2(time * pin); };
  plan.jaw = [turn](double time) { return Pose{0, 0, time * turn}; };
  return plan;
}

/// That the jaw's contact went to and fro: where the wheel is in the centre of curvature of the part's opposite side.
void add_turning_note(const RigPlan& plan, const Roll& roll, Report& report) {
  if (!plan.squeezed) return;
  const std::vector<double>& s = roll.s[0];
  for (std::size_t k = 2; k < s.size(); ++k) {
    if ((s[k] - s[k - 1]) * (s[k - 1] - s[k - 2]) >= 0) continue;
    report.notes.push_back(
        fmt::format("the jaw's contact turned back in row {} of the log: there it is in the centre "
                    "of curvature of the part at the wheel's contact",
                    k));
    return;
  }
}

}  // namespace

bool is_of_rig(const SimulateArguments& arguments) {
  return !arguments.pin.empty() || !arguments.jaw_rotation.empty() || !arguments.wheel.empty() || arguments.squeeze ||
         std::any_of(arguments.fingers.begin(), arguments.fingers.end(), is_wheel);
}

Report simulate_rig(const SimulateArguments& arguments) {
  require_rig(arguments);
  require_logs_of_two(arguments.files, arguments.force);
  const WheelSensors sensors = read_sensors(arguments.wheel);
  Report report;
  const Part part = load_part(arguments.part, report.notes);
  const std::optional<SimulatedNoise> noise = read_simulated_noise(arguments, part.unit());
  const std::string as_disk = "disk," + arguments.fingers[1].substr(kWheelPrefix.size());
  const std::vector<Finger> fingers = read_fingers({arguments.fingers[0], as_disk}, 2, part.unit());
  const RigPlan plan = plan_of(arguments, part, fingers[1].disk()->radius);
  NoisyRoll noisy;
  if (noise) {
    noisy = noisy_roll_rig(part, plan, noise->noise, noise->seed);
  } else {
    noisy.truth = roll_rig(part, plan);
    noisy.log = noisy.truth.log;
  }
  const Log log = sensed_by(sensors, arguments.mirror ? in_mirror(noisy.log, fingers) : noisy.log);
  add_turning_note(plan, noisy.truth, report);
  report_two(arguments, part, fingers, {"the jaw", "the wheel"}, noisy, log, report);
  return report;
}

}  // namespace rollfix::app
