#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "rollfix/contact/log.hpp"

namespace rollfix::app {

/// One roll of what --log names: a log for each finger.
struct ChosenRoll {
  std::vector<Log> logs;
  std::string note;  // which of several it is; empty where there is one
};

/// Adds --roll to a command.
void add_roll_argument(CLI::App& command, std::string& roll);

/// What --log names: one file of one finger or of two, or two files of one each. Of a file with several rolls the one
/// that --roll names, from 1; the last where it is empty, because that is where the finger is now. Throws InputError.
ChosenRoll read_roll(const std::vector<std::string>& paths, const std::string& roll);

}  // namespace rollfix::app
