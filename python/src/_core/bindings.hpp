#pragma once

#include <pybind11/pybind11.h>

// One function for each file: what it adds to the module.
namespace rollfix::python {

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
