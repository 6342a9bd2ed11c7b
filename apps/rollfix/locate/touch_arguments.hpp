#pragma once

#include <string>
#include <vector>

#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix::app {

/// Adds --touch and --clear.
void add_touch_arguments(CLI::App& command, std::vector<std::string>& touches, RollArguments& arguments);

/// Whether a file, or standard input, begins as a table of touches does.
bool is_table_of_touches(const std::string& path, const RollArguments& arguments);

/// Whether touches are meant: --touch, or one --log whose columns are x and y without those of a roll.
bool are_touches(const std::vector<std::string>& touches, const RollArguments& arguments);

/// The touches and what is known of them. `others`: see load_part. Throws InputError, also for options that only a roll
/// has a use for.
TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments,
                                std::vector<std::string>& notes, std::vector<Outline>* others);
/// The same on a part that is there already.
TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments, Part part,
                                std::vector<std::string>& notes);

// `unit`: the part's, empty where it is not known.

/// X,Y or X,Y,NORMAL. Throws InputError.
MeasuredTouch read_touch(const std::string& text, const std::string& unit);
/// --tolerance LENGTH or LENGTH,ANGLE. Throws InputError.
TouchTolerance read_touch_tolerance(const std::string& text, const std::string& unit);

}  // namespace rollfix::app
