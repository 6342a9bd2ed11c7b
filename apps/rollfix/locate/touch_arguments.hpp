#pragma once

#include <string>
#include <vector>

#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix::app {

/// Whether touches are meant: --touch, or one --log whose columns are x and y without those of a roll.
bool are_touches(const std::vector<std::string>& touches, const RollArguments& arguments);

/// The touches and what is known of them. `others`: see load_part. Throws InputError, also for options that only a roll
/// has a use for.
TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments,
                                std::vector<std::string>& notes, std::vector<Outline>* others);

}  // namespace rollfix::app
