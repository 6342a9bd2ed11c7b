#include "rollfix/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/help/help_page.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

/// The command that was typed, of a command that has some the one of those.
const CLI::App& chosen_of(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return chosen.empty() ? app : chosen_of(*chosen.front());
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) names.push_back(option->get_name(false, true));
  }
  std::vector<std::string> single;
  for (const std::string& name : names) {
    std::size_t start = 0;
    for (std::size_t comma = name.find(','); comma != std::string::npos; comma = name.find(',', start)) {
      single.push_back(name.substr(start, comma - start));
      start = comma + 1;
    }
    single.push_back(name.substr(start));
  }
  return single;
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

bool is_option(const std::string& argument) { return argument.size() > 1 && argument.front() == '-'; }

/// What other programs call an option of these; empty where none of them has such a name.
std::string meant_by(const std::string& name, const std::vector<std::string>& known) {
  constexpr std::array<std::array<const char*, 2>, 15> kOtherNames = {{{"--output", "-o"},
                                                                       {"--out", "-o"},
                                                                       {"--outfile", "-o"},
                                                                       {"--svg", "-o"},
                                                                       {"--png", "-o"},
                                                                       {"--pdf", "-o"},
                                                                       {"--plot", "-o"},
                                                                       {"--figure", "-o"},
                                                                       {"--measurement", "--reading"},
                                                                       {"--radius", "--finger"},
                                                                       {"--tol", "--tolerance"},
                                                                       {"--units", "--unit"},
                                                                       {"--silent", "--quiet"},
                                                                       {"-q", "--quiet"},
                                                                       {"--sigma", "--noise"}}};
  for (const auto& [other, own] : kOtherNames) {
    if (name == other && std::find(known.begin(), known.end(), own) != known.end()) return own;
  }
  return "";
}

std::string known_options(const std::string& name, const CLI::App& command) {
  const std::vector<std::string> names = option_names(command);
  const std::string meant = meant_by(name, names);
  if (meant.empty()) return known_names(name, names);
  return fmt::format("did you mean '{}'? Known are: {}", meant, fmt::join(names, ", "));
}

[[noreturn]] void refuse_option(const CLI::App& command, const std::string& argument) {
  const std::string name = argument.substr(0, argument.find('='));
  const std::string known = known_options(name, command);
  if (command.get_parent() != nullptr)
    throw InputError(fmt::format("{} has no option {}; {}", command.get_name(), name, known));
  throw InputError(fmt::format("there is no option {} in front of a command, only behind it; {}", name, known));
}

}  // namespace

CLI::Option* add_switch(CLI::App& command, const std::string& name, bool& value, const std::string& meaning) {
  return command.add_flag(name, value, meaning)->disable_flag_override();
}

void add_repeated_option(CLI::App& command, const std::string& name, std::vector<std::string>& values, const char* type,
                         const std::string& meaning) {
  command.add_option(name, values, meaning)->type_name(type)->allow_extra_args(false);
}

void refuse_leftovers(const CLI::App& program) {
  const CLI::App& command = chosen_of(program);
  const bool is_program = &command == &program;
  const std::vector<std::string> own = program.remaining(false);
  const std::vector<std::string> leftovers = program.remaining(true);
  for (const std::string& argument : leftovers) {
    if (is_option(argument)) refuse_option(own.empty() ? command : program, argument);
  }
  if (leftovers.empty()) return;
  if (leftovers.front() == "help") {
    const std::string whose = is_program ? "" : full_name_of(command).substr(program.get_name().size());
    throw InputError(fmt::format("there is no command 'help'; did you mean 'rollfix{} --help'?", whose));
  }
  if (is_program && leftovers.front() == "version") {
    throw InputError("there is no command 'version'; did you mean 'rollfix --version'?");
  }
  if (is_program) {
    throw InputError(fmt::format("there is no command '{}'; {}", leftovers.front(),
                                 known_names(leftovers.front(), command_names(program))));
  }
  throw InputError(fmt::format("{}: '{}' is one argument too many; quote names with blanks, and see {} --help",
                               command.get_name(), leftovers.front(), full_name_of(command)));
}

std::string explain(const CLI::ParseError& error) {
  std::string text = error.what();
  const std::string option = text.substr(0, text.find(':'));
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr) return text;
  if (text.find("missing") != std::string::npos)
    return fmt::format("{}: expected a value behind it, found none", option);
  const std::size_t override_mark = text.find(" was given a disallowed flag override");
  if (override_mark != std::string::npos) return fmt::format("--{} takes no value", text.substr(0, override_mark));
  if (text.find("At Most") != std::string::npos) return fmt::format("{} is given more than once", option);
  return text;
}

}  // namespace rollfix::app
