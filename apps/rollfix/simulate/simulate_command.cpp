#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numbers>
#include <string_view>

#include "log/mirrored.hpp"
#include "rollfix/arguments/arguments.hpp"
#include "rollfix/error.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/program.hpp"
#include "rollfix/simulate/simulation.hpp"
#include "rollfix/solve.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

bool is_stdout(const std::string& file) { return file == "-"; }

}  // namespace

double orientation_at(const Part& part, double s, const SimulateArguments& arguments, std::size_t finger) {
  const std::vector<std::string>& typed = arguments.contact_angles;  // one may speak for both fingers
  const double contact_angle =
      typed.empty() ? 0 : written_angle(typed[std::min(finger, typed.size() - 1)], "--contact-angle");
  // Off an open part there is no tangent; the roll will say so.
  if (!part.closed() && !(s >= 0 && s <= part.perimeter())) return 0;
  // u + psi is the direction from the finger's centre to the contact: a right angle left of the tangent.
  return part.tangent(s) + std::numbers::pi / 2 - contact_angle;
}

std::string roll_text(const Part& part, const std::vector<double>& s, const std::vector<double>& angle) {
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("rolled from s = {} over length {}{}; the tangent turned by {} deg", fixed(s.front(), decimals),
                     fixed(s.back() - s.front(), decimals), behind(part.unit()), degrees(angle.back() - angle.front()));
}

std::optional<SimulatedNoise> read_simulated_noise(const SimulateArguments& arguments, const std::string& unit) {
  const std::optional<Noise> noise = read_noise(arguments.noise, unit);
  if (!noise && !arguments.seed.empty()) throw InputError("--seed is of --noise: give that as well");
  if (!noise) return std::nullopt;
  return SimulatedNoise{*noise, arguments.seed.empty() ? 0 : read_count(arguments.seed, "--seed", 0)};
}

std::string roll_error_text(const Finger& finger, const RollError& error) {
  std::string text =
      fmt::format("the contact went {:.6g} % farther than the finger was rolled", 100 * error.slip + 0.0);  // no -0
  if (error.radius != 0) text += fmt::format("; its radius really is {:.9g}", finger.length_per_u() + error.radius);
  return text;
}

std::string beyond_reach_note(const Part& part, const Finger& finger, const std::vector<double>& s,
                              const std::string& name) {
  if (!has_reach(finger)) return no_reach_note(finger);
  const auto [least, most] = std::minmax_element(s.begin(), s.end());
  const auto obstruction =
      obstruction_of(part, reach_of(part, finger), s.front(), {*least - s.front(), *most - s.front()});
  return obstruction ? fmt::format("{}can't do this roll: {}", name, about(*obstruction, part)) : "";
}

void add_reach_note(Report& report, const std::string& note) {
  if (!note.empty()) report.notes.push_back(note);
}

Log in_mirror(Log log, const std::vector<Finger>& seen) {
  for (std::size_t k = 0; k < log.fingers.size(); ++k) {
    FingerRows& rows = log.fingers[k];
    const Finger& finger = *finger_of(seen, k);
    for (double& u : rows.u) u = mirrored_u(finger, u);
    for (double& x : rows.x) x = 0.0 - x;  // no -0
    for (double& psi : rows.psi) psi = mirrored_psi(&finger, psi);
  }
  return log;
}

void require_writable_log(const std::string& file, bool force) {
  if (is_stdout(file)) return;
  constexpr std::array<std::string_view, 6> kOfTables = {"", ".csv", ".txt", ".tsv", ".dat", ".log"};
  const std::string ending = ending_of(file);
  if (std::find(kOfTables.begin(), kOfTables.end(), ending) == kOfTables.end()) {
    throw InputError(fmt::format("-o {0}: a log is a table, expected a name as in {1}.csv, found the ending {2}", file,
                                 file.substr(0, file.size() - ending.size()), ending));
  }
  require_writable(file, force);
}

void add_log(Report& report, const std::string& file, const std::string& text, bool force) {
  if (is_stdout(file)) {
    report.data = text;
    return;
  }
  report.files.push_back({file, text, force});
  report.notes.push_back(fmt::format("wrote {}", file));
}

namespace {

constexpr const char* kSimulateExamples = R"(Examples:
  rollfix simulate gallery:ellipse --finger disk,r=0.3 --start 1 --length 1.5 -o ellipse-roll.csv
  rollfix simulate gallery:spline --finger disk,r=0.1 --start 4 --length -0.8 --samples 11
  rollfix simulate gallery:cam --finger disk,r=0.2 --start 3 --rotation 200deg
A wheel with a gyroscope on a course: its distances and turns from row to row
  rollfix simulate gallery:cam --odometer --start 1 --length 12 --samples 400 --seconds 60 --noise angle=0.1deg,drift=60deg/h
Two fingers on a part that is free to move, in one log or in two:
  rollfix simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --length 1.5 --length -0.8 -o both.csv
  rollfix simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --length 1 --length 2 -o a.csv -o b.csv
  rollfix simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --length 1 --length 0 --part-rotation 20deg
  rollfix simulate gallery:cam --finger jaw --finger disk,r=0.3 --start 1 --start 4 --length 1 --length 2
A jaw and a wheel on a pin, which the robot moves; the part turns as it must:
  rollfix simulate gallery:ellipse --finger jaw --finger wheel,r=0.4 --start 2.4 --start 6.3 --pin -0.4,-0.15
  rollfix simulate gallery:ellipse --finger jaw --finger wheel,r=0.4 --start 2.4 --pin 0.2 --squeeze --wheel pin
)";

/// Whatever speaks of a second finger, or of a part that moves.
bool is_of_two(const SimulateArguments& arguments) {
  const std::size_t most =
      std::max({arguments.fingers.size(), arguments.starts.size(), arguments.lengths.size(),
                arguments.contact_angles.size(), arguments.contacts.size(), arguments.files.size()});
  return most > 1 || !arguments.part_rotation.empty();
}

void add_rig_arguments(CLI::App& command, SimulateArguments& arguments) {
  command
      .add_option("--pin", arguments.pin,
                  "of a jaw and a wheel (--finger jaw --finger wheel,r=R): how far the wheel's pin moves in the jaw's "
                  "frame, DX along the jaw and DY towards its body; with --squeeze DX alone")
      ->type_name("DX,DY");
  command
      .add_option("--jaw-rotation", arguments.jaw_rotation,
                  "of a jaw and a wheel: how far the jaw turns meanwhile, and the pin with it; default 0")
      ->type_name("ANGLE");
  add_switch(command, "--squeeze", arguments.squeeze,
             "of a jaw and a wheel: a spring presses the pin on the part, across the jaw, so that the wheel's normal "
             "passes through the jaw's contact; the second --start may be left out");
  command
      .add_option("--wheel", arguments.wheel,
                  "of a jaw and a wheel: what the wheel's log has: skin (u, psi, x, y), encoder (psi, x, y) or pin "
                  "(x, y); default skin")
      ->type_name("SENSORS");
}

}  // namespace

void add_simulate_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = program.add_subcommand("simulate",
                                             "Writes the tactile log of a finger that rolls on a part, or of two on a "
                                             "part that is free to move.");
  command->footer(kSimulateExamples);
  add_part_argument(*command, arguments->part);
  add_finger_argument(*command, arguments->fingers);
  add_repeated_option(*command, "--start", arguments->starts, "S",
                      "where the first contact is: arc length along the stored outline; twice for two fingers");
  add_repeated_option(*command, "--length", arguments->lengths, "L",
                      "how far to roll, negative for backwards; twice for two fingers, of which one may stay (0)");
  command->add_option("--rotation", arguments->rotation, "or how far to turn the finger, negative for backwards")
      ->type_name("ANGLE");
  command
      ->add_option("--part-rotation", arguments->part_rotation,
                   "how far the part turns meanwhile; two fingers only; default 0")
      ->type_name("ANGLE");
  add_repeated_option(*command, "--contact-angle", arguments->contact_angles, "ANGLE",
                      "where on the finger the first contact is; default 0; once for both fingers or for each");
  add_repeated_option(
      *command, "--contact", arguments->contacts, "U",
      "where on a jaw or an outline the first contact is, arc length; default 0, for an open outline its "
      "middle; once for both fingers or for each");
  add_rig_arguments(*command, *arguments);
  add_noise_argument(*command, arguments->noise);
  command->add_option("--seed", arguments->seed, "seed of the random errors of --noise; default 0")->type_name("N");
  add_switch(*command, "--odometer", arguments->odometer,
             "in place of --finger: a wheel with a gyroscope, whose log has time, distance and dturn");
  command->add_option("--seconds", arguments->seconds, "how long a wheel takes; default 1 for each row")
      ->type_name("T");
  command->add_option("--samples", arguments->samples, "rows of the log, at equal times; default 101")->type_name("N");
  add_repeated_option(*command, "-o", arguments->files, "FILE",
                      "the log, - for stdout, which is the default; twice: a log for each of two fingers");
  add_switch(*command, "--mirror", arguments->mirror,
             "the part lies face down; --start and --length are still along the outline as it was drawn");
  add_switch(*command, "--force", arguments->force, "replace files that exist");
  command->callback([arguments, &chosen] {
    chosen = [arguments] {
      if (is_of_rig(*arguments)) return simulate_rig(*arguments);
      if (arguments->odometer) return simulate_wheel(*arguments);
      if (!arguments->seconds.empty()) {
        throw InputError("--seconds is of a wheel with a gyroscope: give --odometer, or leave it out");
      }
      return is_of_two(*arguments) ? simulate_two(*arguments) : simulate_one(*arguments);
    };
  });
}

}  // namespace rollfix::app
