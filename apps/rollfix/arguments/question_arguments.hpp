#pragma once

#include <string>
#include <vector>

#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/question.hpp"

namespace rollfix::app {

// What was measured, as typed and from files. `unit`: the part's, empty where it is not known. All throw InputError.

/// Whether a wheel without skin is among the fingers.
bool has_wheel(const RollArguments& arguments);

/// Readings, one roll, several rolls of a part at rest, logs of several fingers, touches, whichever are given.
Measurements read_measurements(const std::vector<std::string>& touches, const RollArguments& arguments,
                               const Part& part, std::vector<std::string>& notes);

/// --reading, or the roll of --log that --roll chooses.
Measurements read_one_roll(const RollArguments& arguments, const Part& part, std::vector<std::string>& notes);

// From what is typed to what the library is asked: numbers and structs. What goes with what is the library's to say.

/// What is asked of PART by touches, rolls, and logs of several fingers and of wheels, every argument read once. What
/// the user should know of how it was taken is added to the notes. `others`, where asked for: see load_part. Throws
/// InputError.
Question read_question(const std::vector<std::string>& touches, const RollArguments& arguments,
                       std::vector<std::string>& notes, std::vector<Outline>* others = nullptr);
/// The same on a part that is there already.
Question read_question(const std::vector<std::string>& touches, const RollArguments& arguments, Part part,
                       std::vector<std::string>& notes);

// Of commands that take one roll, or touches alone.

/// One roll, as `read_roll` chooses it, or readings. Throws InputError.
Problem read_problem(const RollArguments& arguments, std::vector<std::string>& notes,
                     std::vector<Outline>* others = nullptr);
Problem read_problem(const RollArguments& arguments, Part part, std::vector<std::string>& notes);

/// Touches without rolling. Throws InputError.
TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments,
                                std::vector<std::string>& notes, std::vector<Outline>* others);
TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments, Part part,
                                std::vector<std::string>& notes);

}  // namespace rollfix::app
