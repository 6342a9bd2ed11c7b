#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::app {

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
