#pragma once

#include <CLI/CLI.hpp>
#include <iosfwd>
#include <string>
#include <vector>

#include "rollfix/arguments/arguments.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/part.hpp"
#include "rollfix/question.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::app {

/// The answers to many problems, a JSON object in each line of the file, in order, on all cores: docs/json.md lists the
/// fields. They go to `out` as they come. `like` holds what a line does not say. What is wrong with a line is its
/// answer; the exit code remembers it. Throws InputError: a file that can't be read, a part that can't be loaded, an
/// output that can't be written to.
Report locate_batch(const RollArguments& like, const std::string& file, bool explain, std::ostream& out);

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

/// Adds the certificate of an answer as a file of this name, or, where it is "-", in place of the data. The exit code
/// says where it leaves something unproved. Throws InputError: what certificates can't be of.
void add_certificate(const std::string& file, bool force, const Problem& problem, const Answer& answer, Report& report);

/// The same of an answer to touches.
void add_certificate(const std::string& file, bool force, const TouchProblem& problem, const TouchAnswer& answer,
                     Report& report);

/// The same of three and more fingers, and of fingers beside wheels.
void add_certificate(const std::string& file, bool force, const HoldProblem& problem, const HoldAnswer& answer,
                     Report& report);

/// Throws InputError where --certify can't be followed, before any work.
void require_certificate(const std::string& file, bool force, bool json, const std::string& output);

/// --map as typed: files of points in the part's frame, or "loops", the other loops of its drawing.
void add_map_argument(CLI::App& command, std::vector<std::string>& maps);

/// Throws InputError where --map can't be followed: no log or no finger, or -o that is no table.
void require_map_output(const std::vector<std::string>& maps, const std::string& file, bool force, bool json,
                        bool has_log, bool has_finger);

/// These points in the world, by every placement's pose, as CSV: placement,set,x,y, one block for each placement. A
/// placement's pose is that of the log's last row; with noise and one finger, under which the part rests, the mean of
/// what all rows say. A stretch has none. Throws InputError: a file that can't be read, "loops" where there are none, a
/// log without the fingers' centres.
std::string mapped_points(const Answer& answer, const std::vector<std::string>& maps,
                          const std::vector<Outline>& others, std::vector<std::string>& notes);

}  // namespace rollfix::app
