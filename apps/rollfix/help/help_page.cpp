#include "rollfix/help/help_page.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/program.hpp"
#include "rollfix/version.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

struct Group {
  std::string_view name;
  std::vector<std::string_view> options;
};

/// Of all commands; what is in none is a test's failure.
const std::vector<Group>& groups() {
  static const std::vector<Group> all = {
      {"Part",
       {"--catalog", "--loop", "--layer", "--gap", "--outer", "--open", "--corner-angle", "--smooth", "--unit",
        "--allow-crossing", "--mirror", "--bridge", "--lean"}},
      {"Log",
       {"--reading", "--touch", "--clear", "--approach", "--log", "--roll", "--at", "--columns", "--wrapped",
        "--skip-bad", "--direction", "--batch", "--once", "--again", "--idle-timeout", "--baud", "--samples",
        "--seconds"}},
      {"Files", {"--decimal"}},
      {"Finger", {"--finger", "--odometer", "--may-overlap"}},
      {"Noise", {"--noise", "--prior", "--robust", "--heading", "--pose", "--squeezed", "--seed"}},
      {"Roll",
       {"--start", "--length", "--rotation", "--part-rotation", "--stays", "--contact-angle", "--contact", "--pin",
        "--jaw-rotation", "--squeeze", "--wheel", "--friction", "--margin", "--clearance", "--limit", "--duration",
        "--travel"}},
      {"Search", {"--tolerance", "--facing", "--budget", "--march", "--step", "--jobs", "--without-index"}},
      {"Output",
       {"-o", "--force", "--json", "--jsonl", "--verbose", "--explain", "--map", "--certify", "--every", "--on-change",
        "--quiet"}},
      {"General", {"--config", "--no-config", "--help", "--version"}}};
  return all;
}

}  // namespace

std::string name_of(const CLI::Option& option) {
  const std::vector<std::string>& names = option.get_lnames();
  if (!names.empty()) return "--" + names.front();
  return option.get_snames().empty() ? option.get_name(true) : "-" + option.get_snames().front();
}

void group_options(CLI::App& command) {
  for (CLI::Option* option : command.get_options([](const CLI::Option* one) { return one->nonpositional(); })) {
    for (const Group& group : groups()) {
      const bool holds_it =
          std::find(group.options.begin(), group.options.end(), name_of(*option)) != group.options.end();
      if (holds_it) option->group(std::string(group.name));
    }
  }
}

namespace {

// Narrower no table of options can be read, wider no paragraph.
constexpr std::size_t kLeastWidth = 40;
constexpr std::size_t kMostWidth = 120;
constexpr std::size_t kUsualWidth = 80;

/// Pieces joined by blanks, and by `turn` where the line is full, which leaves room for its first line.
std::string joined(const std::vector<std::string>& pieces, std::size_t width, std::size_t used,
                   const std::string& turn) {
  const std::size_t room = turn.find('\n');
  const std::size_t indent = turn.size() - room - 1;
  std::string result;
  for (const std::string& piece : pieces) {
    const bool is_first = result.empty();
    if (!is_first && used + 1 + piece.size() + room > width) {
      result += turn;
      used = indent;
    } else if (!is_first) {
      result += ' ';
      ++used;
    }
    result += piece;
    used += piece.size();
  }
  return result;
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (const std::string_view word : split(text, ' ')) {
    if (!word.empty()) words.emplace_back(word);
  }
  return words;
}

/// A paragraph in lines of at most so many characters, all but the first after as many blanks; a longer word has a line
/// of its own.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  return joined(words_of(text), width, indent, "\n" + std::string(indent, ' '));
}

/// A command's words, an option with its value one piece, and what a shell does next another.
std::vector<std::string> pieces_of_command(std::string_view line) {
  std::vector<std::string> pieces;
  for (const std::string& word : words_of(line)) {
    const bool is_option = word.size() > 1 && word.front() == '-' &&
                           std::isalpha(static_cast<unsigned char>(word[word.size() > 2 ? 2 : 1])) != 0;
    const bool is_next = word == "&&" || word == "|" || word == ">";
    if (pieces.empty() || is_option || is_next) {
      pieces.push_back(word);
    } else {
      pieces.back() += ' ' + word;
    }
  }
  return pieces;
}

std::string wrapped_command(std::string_view line, std::size_t width) {
  constexpr std::string_view kRemark = "  # ";
  const std::size_t remark = line.find(kRemark, 2);
  if (line.size() <= width) return std::string(line);
  if (remark != std::string_view::npos) {
    return "  # " + wrapped(line.substr(remark + kRemark.size()), width, 4) + "\n" +
           wrapped_command("  " + std::string(trimmed(line.substr(0, remark))), width);
  }
  return "  " + joined(pieces_of_command(line), width, 2, " \\\n      ");
}

/// How many characters a line of the terminal has, as COLUMNS or the terminal itself says; 80 where neither does.
std::size_t terminal_width() {
  std::size_t width = 0;
  if (const char* const columns = std::getenv("COLUMNS")) {
    const std::string_view digits = columns;
    std::from_chars(digits.data(), digits.data() + digits.size(), width);
  }
  winsize size = {};
  if (width == 0 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) width = size.ws_col;
  return width == 0 ? kUsualWidth : std::clamp(width, kLeastWidth, kMostWidth);
}

/// A page's examples, in which what a shell reads begins with two blanks: such a line goes on after a backslash, and
/// what is said of it stands above it; all others are paragraphs.
std::string wrapped_examples(std::string_view text, std::size_t width) {
  std::string result;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    result += line.substr(0, 2) == "  " ? wrapped_command(line, width) : wrapped(line, width, 0);
    result += '\n';
  }
  return result;
}

class HelpPage : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string /*name*/, CLI::AppFormatMode mode) const override {
    return fmt::format("{}\n\n{}\nUsage: {}\n{}{}{}", wrapped(app->get_description(), terminal_width(), 0),
                       wrapped_examples(app->get_footer(), terminal_width()), usage_of(*app), make_positionals(app),
                       options_by_group(app), make_subcommands(app, mode));
  }

  std::string options_by_group(const CLI::App* app) const {
    std::string text;
    for (const char* const group : kOptionGroups) {
      const std::vector<const CLI::Option*> options = app->get_options(
          [group](const CLI::Option* option) { return option->nonpositional() && option->get_group() == group; });
      if (!options.empty()) text += make_group(group, false, options);
    }
    return text;
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    // A positional argument is its own type, and the line of usage says whether it can be left out.
    const std::string value = !is_positional                         ? make_option_opts(option)
                              : option->get_items_expected_max() > 1 ? " ..."
                                                                     : "";
    return entry(make_option_name(option, is_positional) + value, option->get_description());
  }

  std::string make_subcommand(const CLI::App* command) const override {
    return entry(command->get_name(), command->get_description());
  }

 private:
  static constexpr std::size_t kColumn = 28;  // where what is said of an option begins

  static std::string entry(const std::string& name, const std::string& meaning) {
    const std::string head = fmt::format("  {:<{}}", name, kColumn - 2);
    const std::string gap = head.size() > kColumn || head.back() != ' ' ? "\n" + std::string(kColumn, ' ') : "";
    return head + gap + wrapped(meaning, terminal_width(), kColumn) + '\n';
  }
};

}  // namespace

void set_help_style(CLI::App& program) { program.formatter(std::make_shared<HelpPage>()); }

std::string full_name_of(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name() : full_name_of(*app.get_parent()) + " " + app.get_name();
}

std::string usage_of(const CLI::App& app) {
  std::string usage = full_name_of(app);
  if (!app.get_subcommands([](const CLI::App*) { return true; }).empty()) usage += " COMMAND";
  for (const CLI::Option* option : app.get_options([](const CLI::Option* one) { return one->get_positional(); })) {
    usage += " " + option->get_name(true);
  }
  return usage + " [OPTIONS]";
}

// ---- all pages

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
