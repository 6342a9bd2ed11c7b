#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/files.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/part.hpp"
#include "rollfix/question.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"
#include "rollfix/units.hpp"
#include "text/number.hpp"  // IWYU pragma: export  written_length, written_angle

namespace rollfix::app {

// Numbers on the command line. `what` begins an error: "--start 5x". All throw InputError.

/// A finite number.
double read_number(std::string_view text, const std::string& what);

/// A finite length, in the part's unit: bare, or with a unit as in 8mm, where the part's (empty: not known) is known.
double read_length(std::string_view text, const std::string& what, const std::string& part_unit);

/// The fields between the commas of an argument: at least `least`, at most `most`. `expected` is the message where
/// there are others, behind `what`; {} stands for "3 numbers" in it.
std::vector<std::string_view> fields_of(std::string_view text, const std::string& what, std::size_t least,
                                        std::size_t most, const char* expected);

/// A whole number of at least `least`.
std::size_t read_count(std::string_view text, const std::string& what, std::size_t least);

// A gyroscope's figures as its datasheet has them. `what` is what messages call the argument. Both throw InputError
// with the forms that are known.

/// A rate or a bias: 10deg/h, 0.01deg/s, 5deg/min, or radians per second as a bare number. In radians per second.
double read_rate(std::string_view text, const std::string& what);

/// An angle random walk: 0.3deg/sqrt(h), 0.005deg/sqrt(s), also written as a rate's noise density, 0.005deg/s/sqrt(Hz);
/// or radians per square root of a second as a bare number. In radians per square root of a second.
double read_walk(std::string_view text, const std::string& what);

/// --travel as typed: a length either way, or BACK,FORWARD. `unit`: the part's. Throws InputError.
Interval read_travel(const std::string& text, const std::string& unit);

/// Half a unit of the last digit of an angle as typed, radians.
double half_unit_of_angle(const std::string& angle);

/// --reading as typed, each LENGTH,TURN or LENGTH_A,LENGTH_B,TURN, with how far their digits may be off. A turn that
/// was likely meant in degrees is told in the notes. Throws InputError.
Measurements read_readings(const std::vector<std::string>& readings, const Part& part, std::vector<std::string>& notes);

/// PART and the options that say how to take it, as typed; empty: not given.
struct PartArgument {
  std::string part;
  std::string corner_angle;
  std::string smooth;
  std::string loop;
  std::string gap;
  std::string layer;
  std::string unit;
  std::string decimal;
  bool open = false;
  bool outer = false;
  bool allow_crossing = false;
};

/// Adds PART and these options to a command.
void add_part_argument(CLI::App& command, PartArgument& argument);

/// Adds the options alone, but --loop.
void add_load_arguments(CLI::App& command, PartArgument& argument);
/// What they say. Throws InputError: an option that is not what it should be.
LoadOptions read_load_options(const PartArgument& argument);

/// Adds --decimal, unless the command has it.
void add_decimal_argument(CLI::App& command, std::string& decimal);
/// Whether that says that numbers have commas. Throws InputError: neither a comma nor a point.
std::optional<bool> has_decimal_comma(const std::string& decimal);

/// Adds --unit alone.
void add_unit_argument(CLI::App& command, std::string& unit);

/// The part and what its file says besides. Throws InputError: no PART, an option that is not what it should be, or
/// what rollfix::load_part throws.
LoadedPart load(const PartArgument& argument);
/// Throws InputError: none is given.
void require_part(const PartArgument& argument);

/// Of a drawing what it holds besides the part: its other loops.
std::vector<Outline> other_loops(const LoadedPart& loaded);

/// The part alone, and what else its drawing holds where that is asked for. What the user should know of how it was
/// taken is added to the notes.
Part load_part(const PartArgument& argument, std::vector<std::string>& notes, std::vector<Outline>* others = nullptr);

/// That a part was given clockwise, and what follows from it.
std::string reversed_note(const Part& part);

/// --catalog FILE, instead of a PART.
void add_catalog_argument(CLI::App& command, std::string& argument);

/// Throws InputError: a PART and a catalog, neither, or what says how a PART is loaded next to a catalog.
void require_part_or_catalog(const std::string& command, const PartArgument& part, const std::string& catalog);

/// Throws InputError: --prior was given, where it is asked which part it is.
void require_no_prior(const std::string& prior);

/// Adds --finger to a command. It can be typed twice: two fingers.
void add_finger_argument(CLI::App& command, std::vector<std::string>& fingers);

/// The fingers as typed, none or up to `most`: disk,r=R, jaw, or an outline. Where two are meant and one is given, both
/// are alike. `unit`: the part's, empty where it is not known; a finger's drawing in another is converted to it. Throws
/// InputError: no such finger, or too many.
std::vector<Finger> read_fingers(const std::vector<std::string>& fingers, std::size_t most, const std::string& unit);

/// Whether this means a wheel without skin: "wheel,r=0.4".
bool names_wheel(const std::string& text);

/// Its radius. Throws InputError: not of this form, not above 0.
double read_wheel(const std::string& text, const std::string& unit);

/// Whether a finger is the outline of a file or of the gallery: "pad.csv", "gallery:stadium", and not "disc,r=0.1".
bool names_outline(const std::string& text);

/// Throws InputError where one is no disk; `what` says for what it must be.
void require_disks(const std::vector<Finger>& fingers, const std::string& what);

/// Places on fingers, --contact-angle `of_disks` or --contact of others. What is typed once is of every finger that can
/// have it, what is typed twice of one each. Throws InputError where there are too few of those.
void require_owners(const std::vector<std::string>& typed, const std::vector<Finger>& fingers, bool of_disks);

/// That it is not known where such a finger can touch a part.
std::string no_reach_note(const Finger& finger);

/// Of --friction: a coefficient for each of so many fingers, typed once for all or once for each.
std::vector<double> read_coefficients(const std::string& text, std::size_t fingers);

/// -o and --force.
struct OutputArgument {
  std::string file;  // empty: not given; "-": stdout
  bool force = false;
};

void add_output_argument(CLI::App& command, OutputArgument& argument, const std::string& meaning);

/// Throws InputError when -o can't be followed: an ending that no figure has, stdout where JSON goes already, or what
/// require_writable throws. `besides`: what else the command takes, for the message.
void require_figure_output(const OutputArgument& argument, bool json, std::string_view besides = "");

/// Adds the figure to the report as -o says. On stdout (-o -) it is SVG and takes the place of the data, whose first
/// line is narrated.
void add_figure(const OutputArgument& argument, const Svg& figure, Report& report);

/// The same of a table.
void add_table(const OutputArgument& argument, const std::string& table, Report& report);

/// The same where -o may also name a saved part, a file that ends in .json, or the outline as numbers, .csv.
void require_part_output(const OutputArgument& argument, bool json);

/// Adds what -o asks for, if it is given: the part, its outline as numbers, or a figure of it.
void add_part_output(const OutputArgument& argument, const Part& part, const std::function<Svg()>& figure,
                     Report& report);

/// What is known of how the part lies, as typed: at most one of both.
struct PoseArguments {
  std::string heading;
  std::string pose;
};

/// Adds --heading and --pose.
void add_pose_arguments(CLI::App& command, PoseArguments& arguments);

/// --heading or --pose as typed. Throws InputError.
std::optional<PosePrior> read_pose(const PoseArguments& arguments, const std::string& unit);

/// How a log is to be read, as typed; empty: not given.
struct LogArguments {
  std::string columns;
  std::string wrapped;
  std::string decimal;
  bool skip_bad = false;

  bool any() const { return !columns.empty() || !wrapped.empty() || skip_bad; }
};

/// What `locate` and `advise` are given of a roll, as typed; empty: not given.
struct RollArguments {
  PartArgument part;
  std::vector<std::string> readings;
  std::vector<std::string> logs;
  std::vector<std::string> clear;
  std::vector<std::string> fingers;
  std::string roll;
  LogArguments reading;
  std::string facing;
  std::string instants;
  std::string tolerance;
  std::string budget;
  std::string noise;
  std::string prior;
  std::string squeezed;
  PoseArguments pose;
  std::string direction;
  bool mirror = false;
  bool robust = false;
  bool may_overlap = false;
};

/// Adds PART, --reading, --log, --roll, --finger, --tolerance, --noise, --prior, --robust, --heading, --pose, --mirror
/// and --direction to a command. `takes_either`: the last one may be `either`.
void add_roll_arguments(CLI::App& command, RollArguments& arguments, bool takes_either = false);
/// The same without PART.
void add_felt_arguments(CLI::App& command, RollArguments& arguments, bool takes_either = false);
/// Adds --squeezed.
void add_squeezed_argument(CLI::App& command, std::string& squeezed);
/// Adds --noise alone.
void add_noise_argument(CLI::App& command, std::string& noise);
/// Adds --log, --roll, --columns, --wrapped and --skip-bad alone.
void add_log_arguments(CLI::App& command, std::vector<std::string>& logs, std::string& roll, LogArguments& reading);
/// Adds --mirror and --direction.
void add_side_arguments(CLI::App& command, bool& mirror, std::string& direction, bool takes_either = false);
/// Whether --direction says that lengths count against the outline. Throws InputError: neither ccw nor cw.
bool counts_clockwise(const std::string& direction);
/// Adds --skip-bad.
void add_skip_argument(CLI::App& command, LogArguments& reading);
/// Tells of the rows that were left out, and of what else the log holds.
void add_log_notes(const Log& log, std::vector<std::string>& notes);
/// Adds --columns and --wrapped alone.
void add_reading_arguments(CLI::App& command, LogArguments& reading);
/// Adds --noise, --prior and --robust.
void add_noise_arguments(CLI::App& command, std::string& noise, std::string& prior, bool& robust);

// `unit`: the part's, empty where it is not known.

/// --noise as typed; nothing where it is not. Throws InputError.
std::optional<Noise> read_noise(const std::string& text, const std::string& unit);
/// --prior as typed. Throws InputError.
std::optional<Prior> read_prior(const std::string& text, const std::string& unit);
/// --columns, --wrapped and --skip-bad as typed, and the part's unit. Throws InputError.
LogOptions read_log_options(const LogArguments& reading, const std::string& unit);

/// One roll of what --log names: one file of one finger or of two, or two files of one each. Of a file with several
/// rolls the one that --roll names, from 1; the last where it is empty, because that is where the finger is now.
/// Throws InputError.
Log read_roll(const std::vector<std::string>& paths, const std::string& roll, const LogOptions& options,
              std::vector<std::string>& notes);

// What was measured, as typed and from files. `unit`: the part's, empty where it is not known. All throw InputError.

/// Whether a wheel without skin is among the fingers.
bool has_wheel(const RollArguments& arguments);

/// Readings, one roll, several rolls of a part at rest, logs of several fingers, touches, whichever are given.
Measurements read_measurements(const std::vector<std::string>& touches, const RollArguments& arguments,
                               const Part& part, std::vector<std::string>& notes);

/// --reading, or the roll of --log that --roll chooses.
Measurements read_one_roll(const RollArguments& arguments, const Part& part, std::vector<std::string>& notes);

// From what is typed to what the library is asked: numbers and structs. What goes with what is the library's to say.

/// What is asked of PART by touches, rolls, and logs of several fingers and of wheels, every argument read once. What
/// the user should know of how it was taken is added to the notes. `others`, where asked for: see load_part. Throws
/// InputError.
Question read_question(const std::vector<std::string>& touches, const RollArguments& arguments,
                       std::vector<std::string>& notes, std::vector<Outline>* others = nullptr);
/// The same on a part that is there already.
Question read_question(const std::vector<std::string>& touches, const RollArguments& arguments, Part part,
                       std::vector<std::string>& notes);

// Of commands that take one roll, or touches alone.

/// One roll, as `read_roll` chooses it, or readings. Throws InputError.
Problem read_problem(const RollArguments& arguments, std::vector<std::string>& notes,
                     std::vector<Outline>* others = nullptr);
Problem read_problem(const RollArguments& arguments, Part part, std::vector<std::string>& notes);

/// Touches without rolling. Throws InputError.
TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments,
                                std::vector<std::string>& notes, std::vector<Outline>* others);
TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments, Part part,
                                std::vector<std::string>& notes);

/// --config and --no-config.
struct SettingsArgument {
  std::string file;
  bool none = false;
};

/// What a file says of a command line.
struct Settings {
  struct Origin {
    std::string argument;  // "--finger", or PART as it is written
    std::string where;     // "rollfix.toml:3"
  };

  std::string file{};                    // empty: there is none
  std::vector<std::string> arguments{};  // as if they were typed
  std::vector<Origin> origins{};         // of each

  /// "rollfix.toml: wing.csv --finger disk,r=10", where anything is taken from it.
  std::vector<std::string> notes() const;
  /// A message with where that stands of which it tells.
  std::string with_origins(const std::string& message) const;
};

/// Adds --config and --no-config to a command that takes its options from a file as well.
void add_settings_argument(CLI::App& command, SettingsArgument& argument);

/// What rollfix.toml, or the file of --config, adds to what was typed: options by their names, and part for PART; those
/// below the name of a command, [watch], are for that alone. What was typed counts, and what goes with it alone is
/// left out. Files are relative to the folder of the one that names them. `describe` adds all commands to a program.
/// Throws InputError: no such file, or what is not known there, with its line.
Settings read_settings(const CLI::App& command, const SettingsArgument& argument,
                       const std::function<void(CLI::App&)>& describe);

/// Adds --touch and --clear.
void add_touch_arguments(CLI::App& command, std::vector<std::string>& touches, RollArguments& arguments);

/// Whether a file, or standard input, begins as a table of touches does.
bool is_table_of_touches(const std::string& path, const RollArguments& arguments);

/// Whether touches are meant: --touch, or one --log whose columns are x and y without those of a roll.
bool are_touches(const std::vector<std::string>& touches, const RollArguments& arguments);

// `unit`: the part's, empty where it is not known.

/// Adds touches and paths on which nothing was felt: of --touch and --clear, or of the table that --log is, if it is no
/// log of rolls that is read already. Throws InputError.
void add_touches(const std::vector<std::string>& touches, const RollArguments& arguments, const std::string& unit,
                 Measurements& measured, std::vector<std::string>& notes);
/// X,Y or X,Y,NORMAL. Throws InputError.
MeasuredTouch read_touch(const std::string& text, const std::string& unit);
/// --clear of rolls, with rows those of all logs. Throws InputError.
void add_clear(const RollArguments& arguments, TouchProblem& problem);
/// --tolerance LENGTH or LENGTH,ANGLE. Throws InputError.
TouchTolerance read_touch_tolerance(const std::string& text, const std::string& unit);

}  // namespace rollfix::app
