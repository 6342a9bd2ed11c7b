#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>

#include "rollfix/draw.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/part.hpp"

namespace rollfix::app {

/// -o and --force.
struct OutputArgument {
  std::string file;  // empty: not given; "-": stdout
  bool force = false;
};

void add_output_argument(CLI::App& command, OutputArgument& argument, const std::string& meaning);

/// Throws InputError when -o can't be followed: an ending that no figure has, stdout where JSON goes already, or what
/// require_writable throws. `besides`: what else the command takes, for the message.
void require_figure_output(const OutputArgument& argument, bool json, std::string_view besides = "");

/// Adds the figure to the report as -o says. On stdout (-o -) it is SVG and takes the place of the data, whose first
/// line is narrated.
void add_figure(const OutputArgument& argument, const Svg& figure, Report& report);

/// The same of a table.
void add_table(const OutputArgument& argument, const std::string& table, Report& report);

/// The same where -o may also name a saved part, a file that ends in .json, or the outline as numbers, .csv.
void require_part_output(const OutputArgument& argument, bool json);

/// Adds what -o asks for, if it is given: the part, its outline as numbers, or a figure of it.
void add_part_output(const OutputArgument& argument, const Part& part, const std::function<Svg()>& figure,
                     Report& report);

}  // namespace rollfix::app
