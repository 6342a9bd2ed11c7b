#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/arguments/part_argument.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::app {

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

}  // namespace rollfix::app
