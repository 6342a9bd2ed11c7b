#include "rollfix/program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <boost/system/system_error.hpp>
#include <cctype>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <new>
#include <ostream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "rollfix/arguments/arguments.hpp"
#include "rollfix/error.hpp"
#include "rollfix/help/help_page.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/pulse.hpp"
#include "rollfix/version.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDescription =
    "Finds every place where a rolling finger may touch a curved part of known outline.";

constexpr const char* kProgramExamples = R"(Examples:
  rollfix demo                                      # the main job; it writes the files used below
  rollfix inspect wing.csv -o part.svg              # what a part is
  rollfix locate wing.csv --reading 60.1,5.12deg    # where can this roll have started?
  rollfix locate wing.csv --log wing-roll.csv --finger disk,r=10
  rollfix simulate gallery:cam --finger disk,r=0.2 --start 0.5 --length 1 -o roll.csv
  rollfix watch wing.csv --finger disk,r=10 --noise contact=0.1,angle=0.1deg --log wing-roll.csv --once
)";

bool is_long_option_without_value(std::string_view argument) {
  return argument.size() > 2 && argument.substr(0, 2) == "--" && argument.find('=') == std::string_view::npos;
}

/// A minus and a digit or a point; also -inf and -nan, so that the error is about the number.
bool starts_like_a_negative_number(std::string_view argument) {
  if (argument.size() < 2 || argument.front() != '-') return false;
  const std::string_view rest = argument.substr(1);
  const auto second = static_cast<unsigned char>(rest.front());
  return std::isdigit(second) != 0 || second == '.' || rest.substr(0, 3) == "inf" || rest.substr(0, 3) == "nan";
}

/// Makes of an option followed by a negative number one argument: --reading -0.5,1 becomes --reading=-0.5,1, which
/// can't be taken for another option.
std::vector<std::string> with_negative_values_attached(const std::vector<std::string>& arguments) {
  std::vector<std::string> result;
  for (const std::string& argument : arguments) {
    const bool belongs_to_last = !result.empty() && is_long_option_without_value(result.back());
    if (belongs_to_last && starts_like_a_negative_number(argument)) {
      result.back() += "=" + argument;
    } else {
      result.push_back(argument);
    }
  }
  return result;
}

/// "inspect, locate or demo".
std::string names_of_commands(CLI::App& program) {
  std::string names;
  const std::vector<CLI::App*> commands = program.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* command : commands) {
    names += (names.empty() ? "" : command == commands.back() ? " or " : ", ") + command->get_name();
  }
  return names;
}

/// What all commands have in common.
struct Common {
  bool quiet = false;
  SettingsArgument settings;
};

/// Adds that to the commands, and to the commands of commands.
void set_up(CLI::App& program, Common& common) {
  constexpr std::array<std::string_view, 8> kOfRobots = {"inspect",  "locate", "advise", "identify",
                                                         "simulate", "plan",   "teach",  "watch"};
  for (CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    command->allow_extras();
    command->group("Commands");
    add_switch(*command, "--quiet", common.quiet, "no notes on stderr; errors are still shown");
    const bool is_of_robots = std::find(kOfRobots.begin(), kOfRobots.end(), command->get_name()) != kOfRobots.end();
    if (is_of_robots) add_settings_argument(*command, common.settings);
    group_options(*command);
    set_up(*command, common);
  }
}

/// All commands, as pages and shells list them.
void describe(CLI::App& program);

/// Where the arguments begin with a command's name, that one alone: to describe the options of all takes longer than to
/// locate.
void add_commands(CLI::App& program, Command& chosen, const std::string& first, std::ostream& out, std::ostream& err) {
  const std::array<std::pair<const char*, std::function<void()>>, 13> commands = {{
      {"inspect", [&] { add_inspect_command(program, chosen); }},
      {"locate", [&] { add_locate_command(program, chosen, out); }},
      {"advise", [&] { add_advise_command(program, chosen); }},
      {"catalog", [&] { add_catalog_command(program, chosen); }},
      {"identify", [&] { add_identify_command(program, chosen); }},
      {"simulate", [&] { add_simulate_command(program, chosen); }},
      {"plan", [&] { add_plan_command(program, chosen); }},
      {"teach", [&] { add_teach_command(program, chosen); }},
      {"watch", [&] { add_watch_command(program, chosen, out, err); }},
      {"demo", [&] { add_demo_command(program, chosen); }},
      {"paper", [&] { add_paper_command(program, chosen); }},
      {"completion", [&] { add_completion_command(program, chosen, describe); }},
      {"man", [&] { add_man_command(program, chosen, describe); }},
  }};
  const auto is_first = [&](const auto& command) { return first == command.first; };
  const bool named = std::any_of(commands.begin(), commands.end(), is_first);
  for (const auto& command : commands) {
    if (!named || is_first(command)) command.second();
  }
}

/// The program with the command of that name, or else with all.
void set_up(CLI::App& program, Command& chosen, const std::string& first, std::ostream& out, std::ostream& err,
            Common& common) {
  set_help_style(program);
  program.description(kDescription);
  program.name("rollfix");
  program.footer(kProgramExamples);
  program.set_version_flag("--version", std::string("rollfix ") + kVersion);
  program.require_subcommand(0, 1);
  add_commands(program, chosen, first, out, err);
  // What the parser does not know is refused here, with better words.
  program.allow_extras();
  group_options(program);
  set_up(program, common);
}

void describe(CLI::App& program) {
  static Common nobody;
  static Command none;
  set_up(program, none, "", std::cout, std::cerr, nobody);
}

/// What an empty variable of a shell leaves behind: --noise "$NOISE". Throws InputError.
void refuse_empty_values(const std::vector<std::string>& arguments) {
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string& argument = arguments[k];
    const bool is_option = argument.size() > 1 && argument[0] == '-';
    const bool ends_empty = is_option && argument.substr(0, 2) == "--" && argument.back() == '=';
    const bool is_followed = is_option && k + 1 < arguments.size() && arguments[k + 1].empty();
    if (!ends_empty && !is_followed) continue;
    throw InputError(
        fmt::format("{}: expected a value behind it, found an empty one", argument.substr(0, argument.find('='))));
  }
}

void parse(CLI::App& program, const std::vector<std::string>& arguments) {
  refuse_empty_values(arguments);
  std::vector<std::string> reversed = with_negative_values_attached(arguments);
  std::reverse(reversed.begin(), reversed.end());
  program.parse(std::move(reversed));
  refuse_leftovers(program);
}

/// What the arguments, and a file of settings where there is one, ask for.
struct Asked {
  Command command{};
  Settings settings{};
  bool quiet = false;

  void parse(CLI::App& program, std::vector<std::string> arguments, std::ostream& out, std::ostream& err,
             bool with_settings) {
    Common common;
    set_up(program, command, arguments.empty() ? "" : arguments.front(), out, err, common);
    app::parse(program, arguments);
    if (!command) throw InputError("expected a command: " + names_of_commands(program) + "; see rollfix --help");
    const CLI::App& typed = *program.get_subcommands().front();
    if (with_settings && typed.get_option_no_throw("--config") != nullptr) {
      settings = read_settings(typed, common.settings, describe);
      arguments.insert(arguments.end(), settings.arguments.begin(), settings.arguments.end());
      if (!settings.arguments.empty()) app::parse(program, arguments);
    }
    quiet = common.quiet;
  }
};

/// Runs it; what takes long says on a terminal what is being done. What is told line by line, as by watch, is not
/// written over.
Report carried_out(const Command& command, bool shows_progress) {
  constexpr double kPatience = 0.5;  // seconds
  ProgressLine line(shows_progress);
  if (!line.is_shown()) return command();
  const Pulse pulse([&](const char* doing) {
    if (doing == nullptr || line.seconds() < kPatience) return;
    line.show(fmt::format("rollfix: {}, {:.0f} s", doing, line.seconds()));
  });
  return command();
}

int code(ExitCode exit_code) { return static_cast<int>(exit_code); }

/// Whether an argument is a file's name, by itself or with its option: -oFILE, --log=FILE.
bool names(const std::string& argument, const std::string& file) {
  const auto is_same = [&](const std::string& name) {
    std::error_code error;
    return fs::equivalent(name, file, error) && !error;
  };
  const bool has_letter = argument.size() > 2 && argument.substr(0, 2) == "-o";
  return is_same(argument) || is_same(argument.substr(argument.find('=') + 1)) ||
         (has_letter && is_same(argument.substr(2)));
}

/// Throws InputError: a file would be written over what was read: two of the arguments name it.
void require_no_input(const std::vector<OutputFile>& files, const std::vector<std::string>& arguments) {
  for (const OutputFile& file : files) {
    std::error_code error;
    if (!fs::is_regular_file(file.path, error)) continue;
    const auto is_named = [&](const std::string& argument) { return names(argument, file.path); };
    if (std::count_if(arguments.begin(), arguments.end(), is_named) < 2) continue;
    throw InputError(fmt::format("{}: was read, and would be written over: give another name", file.path));
  }
}

void tell(const std::vector<std::string>& narration, std::ostream& notes) {
  for (const std::string& note : narration) notes << "rollfix: " << plain(with_options(note)) << '\n' << std::flush;
}

/// `notes`: where the narration goes.
void deliver(const Report& report, std::ostream& out, std::ostream& notes) {
  write_files(report.files);
  if (report.notes_first) tell(report.notes, notes);
  out << report.data << std::flush;
  if (!out) throw InputError("standard output can't be written to");
  if (!report.notes_first) tell(report.notes, notes);
}

/// What is known stands on a line of its own.
void set_known_names_apart(std::string& message) {
  constexpr std::string_view kMark = " Known are: ";
  std::size_t at = message.find(kMark);
  if (at == std::string::npos) return;
  const std::size_t length = kMark.size();
  std::size_t from = at;
  if (from > 0 && message[from - 1] == ';') --from;
  message.replace(from, at + length - from, "\n  Known are: ");
}

/// An error is one line, whatever is in the names that it quotes, and does nothing to a terminal; and one of what would
/// be known.
int fail(std::ostream& err, std::string message, ExitCode exit_code) {
  message = plain(message, ' ');
  set_known_names_apart(message);
  err << "rollfix: " << with_options(message) << '\n';
  return code(exit_code);
}

}  // namespace

Command command_of(const std::vector<std::string>& arguments) {
  CLI::App program;
  Asked asked;
  asked.parse(program, arguments, std::cout, std::cerr, false);
  return asked.command;
}

int run(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err) {
  CLI::App program;
  std::ostream notes(err.rdbuf());
  Asked asked;
  try {
    asked.parse(program, arguments, out, notes, true);
    if (asked.quiet) notes.rdbuf(nullptr);  // what is written to it goes nowhere
    // What prints as it goes begins with where its options are from.
    const bool is_live = !arguments.empty() && arguments.front() == "watch";
    const std::vector<std::string> settings = asked.settings.notes();
    if (is_live) tell(settings, notes);
    Report report = carried_out(asked.command, !asked.quiet && !is_live);
    if (!is_live) report.notes.insert(report.notes.begin(), settings.begin(), settings.end());
    std::vector<std::string> all = arguments;
    all.insert(all.end(), asked.settings.arguments.begin(), asked.settings.arguments.end());
    require_no_input(report.files, all);
    deliver(report, out, notes);
    return code(report.exit_code);
  } catch (const CLI::Success& request) {  // --help, --version
    const int exit_code = program.exit(request, out, err);
    out << std::flush;
    return out ? exit_code : fail(err, "standard output can't be written to", ExitCode::bad_input);
  } catch (const CLI::ParseError& error) {
    return fail(err, asked.settings.with_origins(explain(error)), ExitCode::bad_input);
  } catch (const InputError& error) {
    return fail(err, asked.settings.with_origins(with_options(error.what())), ExitCode::bad_input);
  } catch (const boost::system::system_error& error) {
    return fail(err, std::string("the system refuses what this needs: ") + error.what(), ExitCode::bad_input);
  } catch (const std::bad_alloc&) {
    return fail(err, "there is not enough memory for this: nothing was decided; ask for less, or give it more",
                ExitCode::incomplete);
  } catch (const std::exception& error) {
    return fail(err, std::string("internal error, please report it: ") + error.what(), ExitCode::internal_error);
  }
}

}  // namespace rollfix::app
