#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "rollfix/answer/answer.hpp"
#include "rollfix/arguments/part_argument.hpp"

namespace rollfix::app {

/// What `locate` and `advise` are given of a roll, as typed; empty: not given.
struct RollArguments {
  PartArgument part;
  std::vector<std::string> readings;
  std::vector<std::string> logs;
  std::vector<std::string> fingers;
  std::string roll;
  std::string facing;
  std::string instants;
  std::string tolerance;
  std::string budget;
  std::string noise;
  std::string prior;
  bool robust = false;
};

/// Adds PART, --reading, --log, --roll, --finger, --tolerance, --noise, --prior and --robust to a command.
void add_roll_arguments(CLI::App& command, RollArguments& arguments);
/// Adds --noise alone.
void add_noise_argument(CLI::App& command, std::string& noise);
/// Adds --log and --roll alone.
void add_log_arguments(CLI::App& command, std::vector<std::string>& logs, std::string& roll);
/// Adds --noise, --prior and --robust.
void add_noise_arguments(CLI::App& command, std::string& noise, std::string& prior, bool& robust);

/// The problem that is meant, every argument read once. What the user should know of how it was taken is added to the
/// notes. Throws InputError.
Problem read_problem(const RollArguments& arguments, std::vector<std::string>& notes);

/// --noise as typed; nothing where it is not. Throws InputError.
std::optional<Noise> read_noise(const std::string& text);
/// --prior as typed. Throws InputError.
std::optional<Prior> read_prior(const std::string& text);

/// One roll of what --log names: one file of one finger or of two, or two files of one each. Of a file with several
/// rolls the one that --roll names, from 1; the last where it is empty, because that is where the finger is now.
/// Throws InputError.
Log read_roll(const std::vector<std::string>& paths, const std::string& roll, std::vector<std::string>& notes);

}  // namespace rollfix::app
