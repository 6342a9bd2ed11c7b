#include "rollfix/arguments/arguments.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "documents/documents.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/program.hpp"

namespace rollfix::app {

namespace {

// Saved parts and tables are known by their endings, which no figure has.

bool names_a_part(const OutputArgument& argument) {
  return std::filesystem::path(argument.file).extension() == ".json";
}

bool names_a_table(const OutputArgument& argument) {
  return std::filesystem::path(argument.file).extension() == ".csv";
}

}  // namespace

void add_output_argument(CLI::App& command, OutputArgument& argument, const std::string& meaning) {
  command.add_option("-o", argument.file, meaning)->type_name("FILE");
  add_switch(command, "--force", argument.force, "replace files that exist");
}

void require_figure_output(const OutputArgument& argument, bool json, std::string_view besides) {
  if (argument.file.empty()) return;
  if (argument.file == "-") {
    if (json) throw InputError("-o - and --json both go to standard output: give the figure the name of a file");
    return;
  }
  figure_format(argument.file, besides);
  require_writable(argument.file, argument.force);
}

void add_figure(const OutputArgument& argument, const Svg& figure, Report& report) {
  if (argument.file == "-") {
    report.notes.push_back(report.data.substr(0, report.data.find('\n')));
    report.data = figure.str();
    return;
  }
  report.files.push_back({argument.file, encode(figure, figure_format(argument.file)), argument.force});
  report.notes.push_back(fmt::format("wrote {}", argument.file));
}

void add_table(const OutputArgument& argument, const std::string& table, Report& report) {
  if (argument.file == "-") {
    report.notes.push_back(report.data.substr(0, report.data.find('\n')));
    report.data = table;
    return;
  }
  report.files.push_back({argument.file, table, argument.force});
  report.notes.push_back(fmt::format("wrote {}", argument.file));
}

void require_part_output(const OutputArgument& argument, bool json) {
  if (names_a_part(argument) || names_a_table(argument)) {
    require_writable(argument.file, argument.force);
  } else {
    require_figure_output(argument, json, ", the part's in .json, a table's of its outline in .csv");
  }
}

void add_part_output(const OutputArgument& argument, const Part& part, const std::function<Svg()>& figure,
                     Report& report) {
  if (argument.file.empty()) return;
  if (!names_a_part(argument) && !names_a_table(argument)) {
    add_figure(argument, figure(), report);
    return;
  }
  report.files.push_back(
      {argument.file, names_a_part(argument) ? format_part(part) : outline_table(part), argument.force});
  report.notes.push_back(fmt::format("wrote {}", argument.file));
}

}  // namespace rollfix::app
