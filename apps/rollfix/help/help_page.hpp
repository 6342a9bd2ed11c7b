#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <string>

namespace rollfix::app {

/// What options are about, in the order in which pages list them.
inline constexpr std::array kOptionGroups = {"Part", "Log",    "Files",  "Finger", "Noise",
                                             "Roll", "Search", "Output", "General"};

/// Puts each option of a command into its group.
void group_options(CLI::App& command);

/// What an option is called where it has one name: --log, or -o.
std::string name_of(const CLI::Option& option);

/// Makes help pages start with what the command does and its worked examples (kept in the command's footer), list its
/// options by what they are about, and fit the terminal.
void set_help_style(CLI::App& program);

/// "rollfix catalog build".
std::string full_name_of(const CLI::App& app);

/// "rollfix catalog build DIR|LIST [OPTIONS]".
std::string usage_of(const CLI::App& app);

}  // namespace rollfix::app
