#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "rollfix/files.hpp"
#include "rollfix/inspect.hpp"
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

/// A flag without a value.
CLI::Option* add_switch(CLI::App& command, const std::string& name, bool& value, const std::string& meaning);

/// An option that is typed once for each finger.
void add_repeated_option(CLI::App& command, const std::string& name, std::vector<std::string>& values, const char* type,
                         const std::string& meaning);

/// Throws InputError for whatever the parser left over: an unknown option or command, with the nearest valid one,
/// or a word too many.
void refuse_leftovers(const CLI::App& program);

/// What a parse error means, in one line.
std::string explain(const CLI::ParseError& error);

/// What `inspect` says of a part, for people.
std::string inspect_text(const Inspection& outcome, const LoadedPart& loaded);

/// The whole program: `arguments` are those after its name, the result is the exit code. Data goes to `out`,
/// narration to `err`; on an error one line to `err` and nothing else.
int run(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err);

/// The command that these arguments ask for, ready to run. Throws InputError.
Command command_of(const std::vector<std::string>& arguments);

}  // namespace rollfix::app
