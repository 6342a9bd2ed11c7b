#pragma once

#include <string>
#include <vector>

#include "rollfix/locate/locate_touches.hpp"

namespace rollfix::app {

/// Whether --roll all is given, and there are contacts besides one roll: several rolls that share the part's pose, or
/// rolls and touches. Throws InputError: a log that can't be read.
bool are_contacts(const std::vector<std::string>& touches, const RollArguments& arguments);

/// `locate` of several rolls, and of touches besides: the poses that fit all. Throws InputError.
Report locate_rolls(const std::vector<std::string>& touches, const RollArguments& arguments, const TouchOutput& output);

}  // namespace rollfix::app
