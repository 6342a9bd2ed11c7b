#include "rollfix/arguments/arguments.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "rollfix/error.hpp"
#include "rollfix/help/help_page.hpp"
#include "rollfix/program.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUsualFile = "rollfix.toml";

/// A key with its values, and where it stands.
struct Setting {
  std::string command;  // the one it is for; empty: for all
  std::string key;
  std::vector<std::string> values;
  std::string where;
};

/// What is of one run and not of a robot.
constexpr std::array<std::string_view, 6> kOfOneRun = {"force", "help", "version", "config", "no-config", "certify"};

/// An option or argument that is called so; null where the command has none.
const CLI::Option* option_of(const CLI::App& command, const std::string& key) {
  if (std::find(kOfOneRun.begin(), kOfOneRun.end(), key) != kOfOneRun.end()) return nullptr;
  for (const CLI::Option* option : command.get_options()) {
    if (option->nonpositional() ? name_of(*option) == "--" + key : lower_case(option->get_name(true)) == key) {
      return option;
    }
  }
  return nullptr;
}

bool takes_settings(const CLI::App& command) { return command.get_option_no_throw("--config") != nullptr; }

bool is_switch(const CLI::Option& option) { return option.get_expected_min() == 0; }

/// The keys of a table as they stand in the file.
std::vector<std::pair<std::string, const toml::node*>> in_their_order(const toml::table& table) {
  std::vector<std::pair<std::string, const toml::node*>> keys;
  for (const auto& [key, value] : table) keys.emplace_back(std::string(key.str()), &value);
  std::stable_sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) {
    const toml::source_position& one = a.second->source().begin;
    const toml::source_position& other = b.second->source().begin;
    return std::make_pair(one.line, one.column) < std::make_pair(other.line, other.column);
  });
  return keys;
}

std::string place_of(const toml::node& node, const std::string& file) {
  return fmt::format("{}:{}", file, node.source().begin.line);
}

/// What would be typed for it: "contact=0.002,angle=0.2deg" for a table within a line.
std::string typed(const toml::node& value, const std::string& key, const std::string& where) {
  if (const auto* const text = value.as_string()) return text->get();
  if (const auto* const whole = value.as_integer()) return fmt::format("{}", whole->get());
  if (const auto* const number = value.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* const is_so = value.as_boolean()) return is_so->get() ? "true" : "false";
  const toml::table* const table = value.as_table();
  if (table == nullptr || !table->is_inline()) {
    throw InputError(fmt::format("{}: {}: expected a text, a number, true or false, or a list of them, found {}", where,
                                 key,
                                 value.is_table()   ? "a section"
                                 : value.is_array() ? "a list"
                                                    : "a date or time"));
  }
  std::vector<std::string> fields;
  for (const auto& [name, field] : in_their_order(*table)) {
    fields.push_back(fmt::format("{}={}", name, typed(*field, key, where)));
  }
  return fmt::format("{}", fmt::join(fields, ","));
}

std::vector<std::string> typed_values(const toml::node& value, const std::string& key, const std::string& where) {
  if (!value.is_array()) return {typed(value, key, where)};
  std::vector<std::string> values;
  for (const toml::node& one : *value.as_array()) values.push_back(typed(one, key, where));
  return values;
}

/// Throws InputError, with what was likely meant where a value stands without quotes.
[[noreturn]] void refuse(const toml::parse_error& error, const std::string& text, const std::string& file) {
  const std::size_t number = error.source().begin.line;
  const std::vector<std::string_view> lines = split(text, '\n');
  const std::string_view line = number <= lines.size() ? trimmed(lines[number - 1]) : "";
  const std::string where = fmt::format("{}:{}", file, number);
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos && !line.empty() && line.front() != '[') {
    throw InputError(fmt::format("{}: expected KEY = VALUE, found {}", where, shown(line)));
  }
  const std::string_view value = equals == std::string_view::npos ? "" : trimmed(line.substr(equals + 1));
  if (std::count(line.begin(), line.end(), '"') % 2 != 0) {
    throw InputError(fmt::format("{}: expected a text between two quotes, found {}", where, shown(line)));
  }
  const std::string why = fmt::format("{}: {}; found {}", where, lower_case(error.description()), shown(line));
  if (value.empty() || value.find_first_of("\"'[{") != std::string_view::npos) throw InputError(why);
  const std::string_view bare = trimmed(value.substr(0, value.find('#')));
  throw InputError(fmt::format("{}: expected a text in quotes, {} = \"{}\", found {}", where,
                               trimmed(line.substr(0, equals)), shown(bare), shown(bare)));
}

/// The settings of a section, and below it.
void add_settings(const toml::table& section, const std::string& command, const std::string& file,
                  std::vector<Setting>& settings) {
  for (const auto& [name, value] : in_their_order(section)) {
    const std::string where = place_of(*value, file);
    const toml::table* const below = value->as_table();
    if (below == nullptr || below->is_inline()) {
      settings.push_back({command, name, typed_values(*value, name, where), where});
    } else if (command.empty()) {
      add_settings(*below, name, file, settings);
    } else {
      throw InputError(
          fmt::format("{}: expected a key of a command, as in [watch], found {}.{}", where, command, name));
    }
  }
}

std::vector<Setting> read_file(const std::string& file) {
  const std::string text(without_mark(read_text(file)));
  std::vector<Setting> settings;
  try {
    add_settings(toml::parse(text), "", file, settings);
  } catch (const toml::parse_error& error) {
    refuse(error, text, file);
  }
  return settings;
}

/// Throws InputError: no command knows such a key, or none has such a name.
void require_known(const Setting& setting, const CLI::App& program) {
  std::set<std::string> commands;
  std::set<std::string> keys;
  bool is_known = false;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App* one) { return takes_settings(*one); })) {
    commands.insert(command->get_name());
    if (!setting.command.empty() && command->get_name() != setting.command) continue;
    is_known = is_known || option_of(*command, setting.key) != nullptr;
    for (const CLI::Option* option : command->get_options()) {
      const std::string name = option->nonpositional() ? name_of(*option) : "--" + lower_case(option->get_name(true));
      if (name.size() > 2 && option_of(*command, name.substr(2)) != nullptr) keys.insert(name.substr(2));
    }
  }
  const auto known = [](const std::string& typed, const std::set<std::string>& names) {
    return known_names(typed, std::vector<std::string>(names.begin(), names.end()));
  };
  if (!setting.command.empty() && commands.count(setting.command) == 0) {
    throw InputError(fmt::format("{}: there is no command '{}' that takes settings; {}", setting.where, setting.command,
                                 known(setting.command, commands)));
  }
  if (is_known) return;
  throw InputError(
      fmt::format("{}: there is no setting '{}'; {}", setting.where, setting.key, known(setting.key, keys)));
}

/// What is typed, and what of a file does not go with it, or is of what it replaces.
const std::map<std::string, std::set<std::string>>& replaced_by() {
  static const std::map<std::string, std::set<std::string>> all = {
      {"part", {"catalog", "loop", "layer", "gap", "open", "corner-angle", "smooth", "allow-crossing", "mirror"}},
      {"catalog",
       {"part", "loop", "layer", "outer", "gap", "open", "corner-angle", "smooth", "allow-crossing", "unit", "prior"}},
      {"reading", {"log", "batch", "roll", "at", "columns", "wrapped", "skip-bad", "heading", "pose", "map"}},
      {"log", {"reading", "batch"}},
      {"batch", {"reading", "log", "roll", "at", "map"}},
      {"march", {"noise", "prior", "robust", "heading", "pose", "facing", "budget", "mirror", "map", "explain"}},
      {"heading", {"pose"}},
      {"pose", {"heading"}},
      {"every", {"on-change"}},
      {"on-change", {"every"}},
      {"open", {"bridge"}},
      {"bridge", {"open"}}};
  return all;
}

bool is_typed(const CLI::App& command, const std::string& key) {
  const CLI::Option* const option = option_of(command, key);
  return option != nullptr && option->count() > 0;
}

bool is_replaced(const CLI::App& command, const Setting& setting, bool names_part) {
  if (is_typed(command, setting.key)) return true;
  return std::any_of(replaced_by().begin(), replaced_by().end(), [&](const auto& one) {
    const auto& [typed, replaced] = one;
    const bool is_of_catalogs = typed == "catalog" && command.get_name() == "identify";
    if (replaced.count(setting.key) == 0 || !(is_typed(command, typed) || is_of_catalogs)) return false;
    return typed != "part" || names_part || setting.key == "catalog";  // else they are of all parts
  });
}

/// The same file as seen from here.
std::string beside(const std::string& file, const std::string& settings_file) {
  const fs::path folder = fs::path(settings_file).parent_path();
  if (folder.empty() || file == "-" || file.find(':') != std::string::npos || fs::path(file).is_absolute()) return file;
  return (folder / file).string();
}

std::string value_as_typed(const Setting& setting, const std::string& value, const std::string& file) {
  constexpr std::array<std::string_view, 5> kFiles = {"part", "log", "catalog", "batch", "map"};
  const bool is_file = std::find(kFiles.begin(), kFiles.end(), setting.key) != kFiles.end() && value != "loops";
  return is_file || (setting.key == "finger" && names_outline(value)) ? beside(value, file) : value;
}

void add_setting(const Setting& setting, const CLI::Option& option, Settings& settings) {
  const auto add = [&](std::string argument, std::string shown_as) {
    settings.arguments.push_back(std::move(argument));
    settings.origins.push_back({std::move(shown_as), setting.where});
  };
  const std::string name = "--" + setting.key;
  // A list is of what can be given more than once, or else the numbers of one value: at = [1, 2.5].
  const bool is_one = !is_switch(option) && option.get_items_expected_max() == 1 && setting.values.size() > 1;
  const std::vector<std::string> joined = {fmt::format("{}", fmt::join(setting.values, ","))};
  for (const std::string& value : is_one ? joined : setting.values) {
    if (is_switch(option)) {
      if (value != "true" && value != "false") {
        throw InputError(fmt::format("{}: {}: expected true or false, found {}", setting.where, setting.key, value));
      }
      if (value == "true") add(name, name);
      continue;
    }
    const std::string typed = value_as_typed(setting, value, settings.file);
    if (option.nonpositional()) {
      add(fmt::format("{}={}", name, typed), name);
    } else {
      add(typed, typed);
    }
  }
}

}  // namespace

std::vector<std::string> Settings::notes() const {
  if (arguments.empty()) return {};
  std::string text = file + ":";
  for (const std::string& argument : arguments) {
    const bool is_option = argument.rfind("--", 0) == 0;
    const std::size_t equals = is_option ? argument.find('=') : std::string::npos;
    text += ' ' + (equals == std::string::npos
                       ? quoted_for_shell(argument)
                       : argument.substr(0, equals) + ' ' + quoted_for_shell(argument.substr(equals + 1)));
  }
  return {text};
}

std::string Settings::with_origins(const std::string& message) const {
  // What is known stands behind what is told.
  const std::string head = message.substr(0, message.find(" Known are: "));
  const auto tells_of = [&](const std::string& argument) {
    const std::size_t at = head.find(argument);
    if (at == std::string::npos) return false;
    const char next = at + argument.size() < head.size() ? head[at + argument.size()] : ' ';
    return next != '-' && std::isalnum(static_cast<unsigned char>(next)) == 0;
  };
  std::set<std::string> told;
  for (const Origin& origin : origins) {
    if (tells_of(origin.argument)) told.insert(fmt::format("{} is from {}", origin.argument, origin.where));
  }
  if (told.empty()) return message;
  return fmt::format("{} ({}){}", head, fmt::join(told, ", "), message.substr(head.size()));
}

void add_settings_argument(CLI::App& command, SettingsArgument& argument) {
  command
      .add_option("--config", argument.file,
                  "options of a robot, KEY = VALUE in each line: part, finger, noise, columns, unit and all others by "
                  "their names; the command line overrides it; default rollfix.toml, if it exists")
      ->type_name("FILE");
  add_switch(command, "--no-config", argument.none, "ignore rollfix.toml");
}

Settings read_settings(const CLI::App& command, const SettingsArgument& argument,
                       const std::function<void(CLI::App&)>& describe) {
  Settings settings;
  if (argument.none) {
    if (argument.file.empty()) return settings;
    throw InputError("--config and --no-config: expected one of them, found both");
  }
  settings.file = argument.file.empty() ? kUsualFile : argument.file;
  std::error_code ignored;
  if (argument.file.empty() && !fs::is_regular_file(settings.file, ignored)) return {};

  const std::vector<Setting> all = read_file(settings.file);
  CLI::App program;
  const bool names_part = std::any_of(all.begin(), all.end(), [](const Setting& one) { return one.key == "part"; });
  const auto is_for_this = [&](const Setting& one) { return one.command == command.get_name(); };
  for (const Setting& setting : all) {
    const bool is_of_another = !setting.command.empty() && !is_for_this(setting);
    const CLI::Option* const option = is_of_another ? nullptr : option_of(command, setting.key);
    if (option == nullptr) {
      if (program.get_subcommands([](const CLI::App*) { return true; }).empty()) describe(program);
      require_known(setting, program);
      continue;
    }
    const bool is_said_for_this =
        setting.command.empty() && std::any_of(all.begin(), all.end(), [&](const Setting& one) {
          return is_for_this(one) && one.key == setting.key;
        });
    if (!is_said_for_this && !is_replaced(command, setting, names_part)) add_setting(setting, *option, settings);
  }
  return settings;
}

}  // namespace rollfix::app
