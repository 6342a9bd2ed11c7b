#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace rollfix::app {

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

}  // namespace rollfix::app
