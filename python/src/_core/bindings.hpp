#pragma once

#include <pybind11/pybind11.h>
#include <string>
#include <tuple>
#include <utility>

#include "arrays.hpp"
#include "fingers.hpp"
#include "handles.hpp"
#include "rollfix/files.hpp"
#include "rollfix/question.hpp"
#include "signals.hpp"

namespace rollfix::python {

/// What pickle keeps of an answer: its part, its fingers, and all else as bytes.
py::tuple answer_state(const AnswerHandle& handle);
AnswerHandle answer_from_state(const PartHandle& part, const py::tuple& fingers, const py::bytes& bytes);

/// The solution as Python holds it: an AnswerHandle, a TouchAnswerHandle or a HoldAnswerHandle.
py::object handle_of(Solution solution, const Question& question);

/// Of what `make` certifies: the document, whether it proves everything, and if not what in it says where.
template <class Make>
std::tuple<std::string, bool, std::string> certified(const Make& make) {
  const Unlocked others_may_run;
  CertificateText one = make();
  return {std::move(one.text), one.complete, std::move(one.where)};
}

// One function for each file: what it adds to the module.

void bind_part(pybind11::module_& module);
void bind_log(pybind11::module_& module);
void bind_question(pybind11::module_& module);
void bind_answer(pybind11::module_& module);
void bind_placement(pybind11::module_& module);
void bind_many(pybind11::module_& module);
void bind_rolls(pybind11::module_& module);
void bind_reach(pybind11::module_& module);
void bind_watch(pybind11::module_& module);
void bind_touch(pybind11::module_& module);
void bind_hold(pybind11::module_& module);
void bind_plan(pybind11::module_& module);
void bind_catalog(pybind11::module_& module);

}  // namespace rollfix::python
