#pragma once

#include "handles.hpp"

namespace rollfix::python {

/// What pickle keeps of an answer: its part, its fingers, and all else as bytes.
py::tuple answer_state(const AnswerHandle& handle);
AnswerHandle answer_from_state(const PartHandle& part, const py::tuple& fingers, const py::bytes& bytes);

}  // namespace rollfix::python
