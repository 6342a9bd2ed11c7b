#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "rollfix/output/report.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::app {

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
