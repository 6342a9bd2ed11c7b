#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "rollfix/output/report.hpp"
#include "rollfix/part.hpp"

namespace rollfix::app {

/// --march and --step as typed.
struct MarchArguments {
  bool march = false;
  std::string step;
};

void add_march_arguments(CLI::App& command, MarchArguments& arguments);

/// h, 0 where none is given. Throws InputError: a step that is not above 0, or that is given without --march.
double read_step(const MarchArguments& arguments);

/// A reading of one finger, or of two: a length for each.
struct MarchReading {
  std::vector<double> length;
  double turn = 0;
};

/// What `locate --march` is asked. The paper's algorithm takes one reading of one finger, eqs. (4) and (5), or two of
/// two, eqs. (8) and (9); what further readings say of its answers is looked up.
struct MarchQuestion {
  std::vector<MarchReading> readings;  // all of one finger, or all of two
  double tolerance = 0;                // radians, for the further readings
  double step = 0;                     // the paper's h, in the curves' parameter; 0: the largest that is exact
  bool json = false;
};

/// As `locate` answers, but by the algorithm that the paper publishes, with its counts.
/// Throws InputError for what the paper excludes (lines, arcs, corners, continua), for too few readings, and for two
/// fingers on an open part.
Report locate_by_march(const Part& part, const MarchQuestion& question);

}  // namespace rollfix::app
