#include <algorithm>
#include <memory>

#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/part_argument.hpp"
#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/commands.hpp"
#include "rollfix/error.hpp"
#include "rollfix/simulate/simulation.hpp"
#include "rollfix/usage.hpp"

namespace rollfix::app {
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

/// An option that is typed once for each finger.
void add_repeated(CLI::App& command, const std::string& name, std::vector<std::string>& values, const char* type,
                  const std::string& meaning) {
  command.add_option(name, values, meaning)->type_name(type)->allow_extra_args(false);
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
  add_repeated(*command, "--start", arguments->starts, "S",
               "where the first contact is: arc length along the stored outline; twice for two fingers");
  add_repeated(*command, "--length", arguments->lengths, "L",
               "how far to roll, negative for backwards; twice for two fingers, of which one may stay (0)");
  command->add_option("--rotation", arguments->rotation, "or how far to turn the finger, negative for backwards")
      ->type_name("ANGLE");
  command
      ->add_option("--part-rotation", arguments->part_rotation,
                   "how far the part turns meanwhile; two fingers only; default 0")
      ->type_name("ANGLE");
  add_repeated(*command, "--contact-angle", arguments->contact_angles, "ANGLE",
               "where on the finger the first contact is; default 0; once for both fingers or for each");
  add_repeated(*command, "--contact", arguments->contacts, "U",
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
  add_repeated(*command, "-o", arguments->files, "FILE",
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
