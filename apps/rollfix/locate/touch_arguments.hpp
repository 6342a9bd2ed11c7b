#pragma once

#include <string>
#include <vector>

#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/question.hpp"

namespace rollfix::app {

/// Adds --touch and --clear.
void add_touch_arguments(CLI::App& command, std::vector<std::string>& touches, RollArguments& arguments);

/// Whether a file, or standard input, begins as a table of touches does.
bool is_table_of_touches(const std::string& path, const RollArguments& arguments);

/// Whether touches are meant: --touch, or one --log whose columns are x and y without those of a roll.
bool are_touches(const std::vector<std::string>& touches, const RollArguments& arguments);

// `unit`: the part's, empty where it is not known.

/// Adds touches and paths on which nothing was felt: of --touch and --clear, or of the table that --log is, if it is no
/// log of rolls that is read already. Throws InputError.
void add_touches(const std::vector<std::string>& touches, const RollArguments& arguments, const std::string& unit,
                 Measurements& measured, std::vector<std::string>& notes);
/// X,Y or X,Y,NORMAL. Throws InputError.
MeasuredTouch read_touch(const std::string& text, const std::string& unit);
/// --clear of rolls, with rows those of all logs. Throws InputError.
void add_clear(const RollArguments& arguments, TouchProblem& problem);
/// --tolerance LENGTH or LENGTH,ANGLE. Throws InputError.
TouchTolerance read_touch_tolerance(const std::string& text, const std::string& unit);

}  // namespace rollfix::app
