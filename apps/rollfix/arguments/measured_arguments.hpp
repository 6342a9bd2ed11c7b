#pragma once

#include <string>
#include <vector>

#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/question.hpp"

// What was measured, as typed and from files. `unit`: the part's, empty where it is not known. All throw InputError.
namespace rollfix::app {

/// Whether a wheel without skin is among the fingers.
bool has_wheel(const RollArguments& arguments);

/// Readings, one roll, several rolls of a part at rest, logs of several fingers, touches, whichever are given.
Measurements read_measurements(const std::vector<std::string>& touches, const RollArguments& arguments,
                               const Part& part, std::vector<std::string>& notes);

/// --reading, or the roll of --log that --roll chooses.
Measurements read_one_roll(const RollArguments& arguments, const Part& part, std::vector<std::string>& notes);

}  // namespace rollfix::app
