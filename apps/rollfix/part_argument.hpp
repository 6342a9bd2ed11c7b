#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "rollfix/part/part.hpp"

namespace rollfix::app {

/// PART and the options that say how to take it.
struct PartArgument {
  std::string part;
  std::string corner_angle;  // as typed; empty: the default
  bool open = false;
  bool allow_crossing = false;
};

/// Adds PART, --open, --corner-angle and --allow-crossing to a command.
void add_part_argument(CLI::App& command, PartArgument& argument);

/// The part. Throws InputError: no PART, what load_outline and Part throw, a .json file that is no gallery shape,
/// or an option for points with a shape that is not made of points.
Part load_part(const PartArgument& argument);

/// That a part was given clockwise, and what follows from it.
std::string reversed_note(const Part& part);

}  // namespace rollfix::app
