#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <iosfwd>

#include "rollfix/output/report.hpp"

namespace rollfix::app {

/// Each adds a command to the program; when it is the one that was typed, `chosen` becomes it.
void add_inspect_command(CLI::App& program, Command& chosen);
void add_advise_command(CLI::App& program, Command& chosen);
void add_catalog_command(CLI::App& program, Command& chosen);
void add_identify_command(CLI::App& program, Command& chosen);
void add_simulate_command(CLI::App& program, Command& chosen);
void add_plan_command(CLI::App& program, Command& chosen);
void add_teach_command(CLI::App& program, Command& chosen);
void add_demo_command(CLI::App& program, Command& chosen);
void add_paper_command(CLI::App& program, Command& chosen);

/// These are about all commands, which `describe` adds to a program.
void add_completion_command(CLI::App& program, Command& chosen, const std::function<void(CLI::App&)>& describe);
void add_man_command(CLI::App& program, Command& chosen, const std::function<void(CLI::App&)>& describe);

/// These print while they run: data to `out`, narration to `err`.
void add_locate_command(CLI::App& program, Command& chosen, std::ostream& out);
void add_watch_command(CLI::App& program, Command& chosen, std::ostream& out, std::ostream& err);

}  // namespace rollfix::app
