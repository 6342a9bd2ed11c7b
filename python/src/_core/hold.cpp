#include "rollfix/hold.hpp"

#include <utility>

#include "bindings.hpp"
#include "handles.hpp"
#include "rollfix/files.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

/// How the wheel's pin moves next, as a document.
std::string next_pin_of(const HoldAnswerHandle& handle, const std::optional<std::pair<double, double>>& travel) {
  const Unlocked others_may_run;
  std::optional<Interval> range;
  if (travel) range = Interval{travel->first, travel->second};
  return format_next_pin(*handle.answer, next_pin(*handle.answer, range), Layout::line);
}

}  // namespace

void bind_hold(py::module_& module) {
  py::class_<HoldAnswerHandle>(module, "HoldAnswer")
      .def("document", [](const HoldAnswerHandle& handle) { return format_hold(*handle.answer, Layout::line); })
      .def("next_pin", &next_pin_of)
      .def("certificate", [](const HoldAnswerHandle& handle, const std::optional<std::size_t>& budget) {
        return certified([&] {
          HoldProblem problem = *handle.problem;
          if (budget) problem.budget = budget;
          return certificate_of(problem, *handle.answer);
        });
      });
}

}  // namespace rollfix::python
