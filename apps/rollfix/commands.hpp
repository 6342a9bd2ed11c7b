#pragma once

#include <CLI/CLI.hpp>

#include "rollfix/report.hpp"

namespace rollfix::app {

/// Each adds a command to the program; when it is the one that was typed, `chosen` becomes it.
void add_inspect_command(CLI::App& program, Command& chosen);
void add_locate_command(CLI::App& program, Command& chosen);
void add_simulate_command(CLI::App& program, Command& chosen);
void add_teach_command(CLI::App& program, Command& chosen);
void add_demo_command(CLI::App& program, Command& chosen);

}  // namespace rollfix::app
