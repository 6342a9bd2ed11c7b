#include "rollfix/help/option_groups.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

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

}  // namespace rollfix::app
