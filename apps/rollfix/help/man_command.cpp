#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/commands.hpp"
#include "rollfix/help/help_page.hpp"
#include "rollfix/usage.hpp"
#include "rollfix/version.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kManExamples = R"(Examples:
  rollfix man > rollfix.1
  rollfix man | man -l -
)";

constexpr const char* kEndOfPage = R"(.SH FILES
.TP
.B rollfix.toml
in the current folder, or the file of \fB\-\-config\fR: options of a robot, KEY = VALUE in each line. Keys are options by
their names, and \fBpart\fR; those below the name of a command, as in \fB[watch]\fR, are for that alone. What is typed
counts. Files are relative to the folder of the one that names them. \fB\-\-no\-config\fR heeds none.
.SH EXIT STATUS
.TP
.B 0
complete, and something fits; or the command did what it was asked
.TP
.B 1
complete, and nothing fits
.TP
.B 2
bad usage or bad input
.TP
.B 3
incomplete: the search could not decide everything within its budget, or there was not enough memory
.TP
.B 4
internal error: please report it
)";

/// Text as roff takes it for text.
std::string roff(std::string_view text) {
  std::string result;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) result += "\\&";
    if (c == '-' || c == '\\') result += '\\';
    result += c == '\\' ? 'e' : c;
    begins_line = c == '\n';
  }
  return result;
}

std::string entry(const std::string& name, const std::string& value, const std::string& meaning) {
  return fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(name), value.empty() ? "" : " \\fI" + roff(value) + "\\fR",
                     roff(meaning));
}

std::string options_of(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options([](const CLI::Option* one) { return !one->nonpositional(); })) {
    text += entry(option->get_name(true), "", option->get_description());
  }
  for (const char* const group : kOptionGroups) {
    const auto is_of_group = [group](const CLI::Option* option) {
      return option->nonpositional() && option->get_group() == group;
    };
    const std::vector<const CLI::Option*> options = command.get_options(is_of_group);
    if (options.empty()) continue;
    text += fmt::format(".PP\n{}:\n", group);
    for (const CLI::Option* option : options) {
      text += entry(option->get_name(false, true), option->get_expected_min() == 0 ? "" : option->get_type_name(),
                    option->get_description());
    }
  }
  return text;
}

/// The paragraphs and examples of a command's footer.
std::string footer_of(const CLI::App& command) {
  std::string text;
  bool is_example = false;
  const std::string footer = command.get_footer();
  for (std::string_view rest = footer; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const bool was_example = is_example;
    is_example = line.substr(0, 2) == "  ";
    if (is_example != was_example) text += is_example ? ".nf\n" : ".fi\n.PP\n";
    if (!line.empty()) text += roff(line) + '\n';
  }
  return text + (is_example ? ".fi\n" : "");
}

std::string section_of(const CLI::App& command) {
  std::string text = fmt::format(".SS {}\n{}\n.PP\n\\fB{}\\fR\n", roff(full_name_of(command)),
                                 roff(command.get_description()), roff(usage_of(command)));
  text += options_of(command);
  if (!command.get_footer().empty()) text += ".PP\n" + footer_of(command);
  for (const CLI::App* part : command.get_subcommands([](const CLI::App*) { return true; })) text += section_of(*part);
  return text;
}

std::string man_page(const CLI::App& program) {
  std::string text = fmt::format(".TH ROLLFIX 1 \"\" \"rollfix {}\" \"User Commands\"\n", kVersion);
  text += ".SH NAME\nrollfix \\- where a rolling finger touches a part of known outline\n";
  text += ".SH SYNOPSIS\n.B rollfix\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n";
  text +=
      fmt::format(".SH DESCRIPTION\n{}\n.PP\n{}.SH COMMANDS\n", roff(program.get_description()), footer_of(program));
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    text += section_of(*command);
  }
  return text + kEndOfPage;
}

}  // namespace

void add_man_command(CLI::App& program, Command& chosen, const std::function<void(CLI::App&)>& describe) {
  CLI::App* command = program.add_subcommand("man", "Prints the manual page, for man.");
  command->footer(kManExamples);
  command->callback([&chosen, describe] {
    chosen = [describe] {
      CLI::App everything;
      describe(everything);
      Report report;
      report.data = man_page(everything);
      return report;
    };
  });
}

}  // namespace rollfix::app
