#pragma once

#include "arrays.hpp"
#include "fingers.hpp"
#include "rollfix/question.hpp"

namespace rollfix::python {

/// The solution as Python holds it: an AnswerHandle, a TouchAnswerHandle or a HoldAnswerHandle.
py::object handle_of(Solution solution, const Question& question);

}  // namespace rollfix::python
