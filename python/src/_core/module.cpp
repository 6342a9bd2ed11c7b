#include <pybind11/pybind11.h>

#include "bindings.hpp"
#include "made.hpp"
#include "rollfix/error.hpp"
#include "rollfix/version.hpp"

PYBIND11_MODULE(_core, module) {
  namespace py = pybind11;
  using namespace rollfix::python;
  module.doc() = "The C++ of rollfix. Use the package `rollfix`, which checks and documents.";
  py::register_exception<rollfix::InputError>(module, "InputError", PyExc_ValueError).attr("__doc__") =
      "What was given can't be worked with. The message is one line: what was expected, what was found, and the cure.";
  py::register_exception<rollfix::InternalError>(module, "InternalError", PyExc_RuntimeError).attr("__doc__") =
      "A computation broke a promise of its own: a mistake in rollfix, worth a report.";
  module.attr("__version__") = rollfix::kVersion;
  bind_part(module);
  bind_log(module);
  bind_placement(module);
  bind_answer(module);
  bind_question(module);
  bind_many(module);
  bind_rolls(module);
  bind_reach(module);
  bind_watch(module);
  bind_touch(module);
  bind_hold(module);
  bind_plan(module);
  bind_catalog(module);
  let_be_pickled(module);
}
