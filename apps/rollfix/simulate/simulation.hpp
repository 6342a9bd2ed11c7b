#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/arguments/arguments.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::app {

/// What `rollfix simulate` was given, as typed. Entry 0 of a list is finger a's, entry 1 finger b's.
struct SimulateArguments {
  PartArgument part;
  std::vector<std::string> fingers;
  std::vector<std::string> starts;
  std::vector<std::string> lengths;
  std::vector<std::string> contact_angles;
  std::vector<std::string> contacts;
  std::string noise;
  std::string seed;
  std::vector<std::string> files;
  std::string rotation;
  std::string part_rotation;
  std::string pin;
  std::string jaw_rotation;
  std::string wheel;
  std::string samples;
  std::string seconds;
  bool odometer = false;
  bool squeeze = false;
  bool mirror = false;
  bool force = false;
};

/// One finger on a part at rest.
Report simulate_one(const SimulateArguments& arguments);

/// A wheel with a gyroscope, which has no shape.
Report simulate_wheel(const SimulateArguments& arguments);

/// Two fingers on a part that is free to move.
Report simulate_two(const SimulateArguments& arguments);

/// A jaw and a wheel on a pin, which the robot moves: whatever speaks of a wheel or its pin.
bool is_of_rig(const SimulateArguments& arguments);
Report simulate_rig(const SimulateArguments& arguments);

/// psi of a finger whose first contact is at s, by --contact-angle; the part is not turned.
double orientation_at(const Part& part, double s, const SimulateArguments& arguments, std::size_t finger);

/// --noise as typed, and the seed of what is drawn; nothing without --noise. Throws InputError.
struct SimulatedNoise {
  Noise noise;
  std::uint64_t seed = 0;
};
std::optional<SimulatedNoise> read_simulated_noise(const SimulateArguments& arguments, const std::string& unit);

/// "slipped by 0.01 %; its radius really is 0.201": what was drawn for a whole roll.
std::string roll_error_text(const Finger& finger, const RollError& error);

/// "rolled from s = 1.0000 over length 2.0000; the tangent turned by 30.000 deg".
std::string roll_text(const Part& part, const std::vector<double>& s, const std::vector<double>& angle);

/// A note on a simulated roll that a real finger could not do, because it would hit the part elsewhere; empty when it
/// could, or a note that this is not known. `name` begins it: "", "finger a ".
std::string beyond_reach_note(const Part& part, const Finger& finger, const std::vector<double>& s,
                              const std::string& name);

/// Adds it, unless it is empty.
void add_reach_note(Report& report, const std::string& note);

/// The log of the same roll on the part face down. `seen`: what rolled on the drawn outline, the mirror's image of each
/// finger, or of both.
Log in_mirror(Log log, const std::vector<Finger>& seen);

/// Throws InputError unless these are at most two, and the names of two files, one for each finger, or of one for both.
void require_logs_of_two(const std::vector<std::string>& files, bool force);

/// Tells of a roll of two fingers what it was, what real fingers could not do, and the errors that were drawn, each
/// finger by its name; and adds its log, in one file or two.
void report_two(const SimulateArguments& arguments, const Part& part, const std::vector<Finger>& fingers,
                const PerFinger<std::string>& names, const NoisyRoll& noisy, const Log& log, Report& report);

/// Throws InputError when a log can't be written to this -o; stdout always can.
void require_writable_log(const std::string& file, bool force);

/// Adds a log to the report: as a file and a note, or as the data where it goes to stdout.
void add_log(Report& report, const std::string& file, const std::string& text, bool force);

}  // namespace rollfix::app
