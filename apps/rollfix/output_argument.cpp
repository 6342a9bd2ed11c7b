#include "rollfix/output_argument.hpp"

#include <fmt/format.h>

#include "rollfix/draw/save.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/usage.hpp"

namespace rollfix::app {

void add_output_argument(CLI::App& command, OutputArgument& argument, const std::string& meaning) {
  command.add_option("-o", argument.file, meaning)->type_name("FILE");
  add_switch(command, "--force", argument.force, "replace files that exist");
}

void require_figure_output(const OutputArgument& argument, bool json) {
  if (argument.file.empty()) return;
  if (argument.file == "-") {
    if (json) throw InputError("-o - and --json both go to standard output: give the figure the name of a file");
    return;
  }
  figure_format(argument.file);
  require_writable(argument.file, argument.force);
}

void add_figure(const OutputArgument& argument, const Svg& figure, Report& report) {
  if (argument.file == "-") {
    report.notes.push_back(report.data.substr(0, report.data.find('\n')));
    report.data = figure.str();
    return;
  }
  report.files.push_back({argument.file, encode(figure, figure_format(argument.file))});
  report.notes.push_back(fmt::format("wrote {}", argument.file));
}

}  // namespace rollfix::app
