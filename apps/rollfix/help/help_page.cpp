#include "rollfix/help/help_page.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "rollfix/help/option_groups.hpp"
#include "rollfix/help/wrapped.hpp"

namespace rollfix::app {
namespace {

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

}  // namespace rollfix::app
