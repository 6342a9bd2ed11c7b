#pragma once

#include <functional>
#include <string>
#include <vector>

#include "files/json/fields.hpp"
#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/question.hpp"

namespace rollfix::app {

/// The part that a name means.
using PartOf = std::function<Part(const std::string& name)>;

/// The question of a JSON object: docs/json.md, "A batch of problems". `like` holds what the object does not say. What
/// the user should know is added to the notes. Throws InputError: a field that is not known, or not what it should be,
/// and what `read_question` throws.
Question question_from_json(const Json& object, const RollArguments& like, const PartOf& part_of,
                            std::vector<std::string>& notes);

}  // namespace rollfix::app
