#pragma once

#include <CLI/CLI.hpp>

namespace rollfix::app {

/// Makes help pages start with what the command does and its worked examples (kept in the command's footer), list its
/// options by what they are about, and fit the terminal.
void set_help_style(CLI::App& program);

/// "rollfix catalog build".
std::string full_name_of(const CLI::App& app);

/// "rollfix catalog build DIR|LIST [OPTIONS]".
std::string usage_of(const CLI::App& app);

}  // namespace rollfix::app
