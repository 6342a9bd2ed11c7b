#include <fmt/format.h>

#include <boost/algorithm/string/replace.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/help/help_page.hpp"
#include "rollfix/program.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kCompletionExamples = R"(Examples:
  rollfix completion bash > ~/.local/share/bash-completion/completions/rollfix
  rollfix completion zsh > ~/.zfunc/_rollfix    # where fpath has ~/.zfunc
)";

using Options = std::vector<const CLI::Option*>;

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

Options options_of_command(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}

/// Commands that have none of their own, with those behind which they stand: "catalog build".
void add_leaves(const CLI::App& app, const std::string& before, std::map<std::string, const CLI::App*>& leaves) {
  for (const CLI::App* command : commands_of(app)) {
    const std::string name = before + command->get_name();
    if (commands_of(*command).empty()) leaves[name] = command;
    add_leaves(*command, name + " ", leaves);
  }
}

/// "ccw cw either" of ccw|cw|either; empty where an option takes anything.
std::string words_of(const CLI::Option& option) {
  const std::string type = option.get_expected_min() == 0 ? "" : option.get_type_name();
  const bool is_list =
      type.find('|') != std::string::npos && type.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string::npos;
  return is_list ? boost::replace_all_copy(type, "|", " ") : "";
}

std::string names(const std::vector<const CLI::App*>& commands) {
  std::string text;
  for (const CLI::App* command : commands) text += (text.empty() ? "" : " ") + command->get_name();
  return text;
}

std::string bash_script(const CLI::App& program) {
  std::map<std::string, const CLI::App*> leaves;
  add_leaves(program, "", leaves);
  std::map<std::string, std::string> words;  // of options, of all commands
  std::string options;
  for (const auto& [name, command] : leaves) {
    std::string list;
    for (const CLI::Option* option : options_of_command(*command)) {
      list += (list.empty() ? "" : " ") + name_of(*option);
      if (!words_of(*option).empty() && words_of(*option).size() > words[name_of(*option)].size()) {
        words[name_of(*option)] = words_of(*option);
      }
    }
    options += fmt::format("    '{}') options='{}' ;;\n", name, list);
  }
  std::string values;
  for (const auto& [option, list] : words) {
    if (!list.empty())
      values += fmt::format("    {}) COMPREPLY=($(compgen -W '{}' -- \"$current\")); return ;;\n", option, list);
  }
  std::string first =
      fmt::format("    1:*) COMPREPLY=($(compgen -W '{} --help --version' -- \"$current\")); return ;;\n",
                  names(commands_of(program)));
  std::string group;
  for (const CLI::App* command : commands_of(program)) {
    const std::vector<const CLI::App*> own = commands_of(*command);
    if (own.empty()) continue;
    first += fmt::format("    2:{}) COMPREPLY=($(compgen -W '{} --help' -- \"$current\")); return ;;\n",
                         command->get_name(), names(own));
    group += (group.empty() ? "" : "|") + command->get_name();
  }
  return fmt::format(R"(# bash completion of rollfix, as "rollfix completion bash" prints it
_rollfix() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]}} options
  COMPREPLY=()
  case $COMP_CWORD:$command in
{}  esac
  case $previous in
{}  esac
  case $command in {}) command="$command ${{COMP_WORDS[2]}}" ;; esac
  case $command in
{}  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  else
    COMPREPLY=($(compgen -f -- "$current"))
  fi
}}
complete -o filenames -F _rollfix rollfix
)",
                     first, values, group, options);
}

/// Inside of '...', and of the brackets of a specification.
std::string zsh_text(std::string text) {
  boost::replace_all(text, "'", "'\\''");
  for (const char* const mark : {"[", "]", ":"}) boost::replace_all(text, mark, std::string("\\") + mark);
  return text;
}

std::string zsh_arguments(const CLI::App& command, const std::string& indent) {
  std::string text = indent + "_arguments";
  for (const CLI::Option* option : options_of_command(command)) {
    const std::string value = words_of(*option).empty() ? "_files" : "(" + words_of(*option) + ")";
    const bool takes_value = option->get_expected_min() > 0;
    text += fmt::format(" \\\n{}  '*{}[{}]{}'", indent, name_of(*option), zsh_text(option->get_description()),
                        takes_value ? fmt::format(":{}:{}", zsh_text(option->get_type_name()), value) : "");
  }
  return text + fmt::format(" \\\n{}  '*:file:_files'\n", indent);
}

std::string zsh_commands(const CLI::App& app, const std::string& indent) {
  std::string list;
  std::string cases;
  for (const CLI::App* command : commands_of(app)) {
    list += fmt::format("{}  '{}:{}'\n", indent, command->get_name(), zsh_text(command->get_description()));
    cases += fmt::format("{}  {})\n{}{}    ;;\n", indent, command->get_name(),
                         commands_of(*command).empty() ? zsh_arguments(*command, indent + "    ")
                                                       : zsh_commands(*command, indent + "    "),
                         indent);
  }
  return fmt::format(
      "{0}local -a commands=(\n{1}{0})\n{0}if (( CURRENT == 2 )); then\n{0}  _describe command commands\n{0}  return\n"
      "{0}fi\n{0}shift words\n{0}(( CURRENT-- ))\n{0}case $words[1] in\n{2}{0}esac\n",
      indent, list, cases);
}

std::string zsh_script(const CLI::App& program) {
  return fmt::format(
      "#compdef rollfix\n# zsh completion, as \"rollfix completion zsh\" prints it\n_rollfix() {{\n{}}}\n"
      "_rollfix \"$@\"\n",
      zsh_commands(program, "  "));
}

}  // namespace

void add_completion_command(CLI::App& program, Command& chosen, const std::function<void(CLI::App&)>& describe) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("completion", "Prints what completes command lines in a shell.");
  command->footer(kCompletionExamples);
  command->add_option("SHELL", *shell, "bash or zsh")->type_name("");
  command->callback([&chosen, shell, describe] {
    chosen = [shell, describe] {
      if (*shell != "bash" && *shell != "zsh") {
        throw InputError(
            fmt::format("completion: expected bash or zsh, found {}", shell->empty() ? "nothing" : *shell));
      }
      CLI::App everything;
      describe(everything);
      Report report;
      report.data = *shell == "bash" ? bash_script(everything) : zsh_script(everything);
      return report;
    };
  });
}

}  // namespace rollfix::app
