#include "rollfix/touch.hpp"

#include <cmath>

#include "arrays.hpp"
#include "bindings.hpp"
#include "rollfix/files.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

/// `approaches`, (n, 4): x, y and the direction's two components; none: all around.
std::string next_touch_document(const TouchAnswerHandle& handle, const Numbers& approaches) {
  std::vector<Approach> ways;
  for (py::ssize_t k = 0; k < approaches.shape(0); ++k) {
    ways.push_back({{approaches.at(k, 0), approaches.at(k, 1)}, std::atan2(approaches.at(k, 3), approaches.at(k, 2))});
  }
  const Unlocked others_may_run;
  return format_next_touch(*handle.answer, next_touch(*handle.answer, ways), Layout::line);
}

}  // namespace

void bind_touch(py::module_& module) {
  py::class_<TouchAnswerHandle>(module, "TouchAnswer")
      .def_property_readonly("part", [](const TouchAnswerHandle& handle) { return PartHandle(handle.answer->part); })
      .def("document", [](const TouchAnswerHandle& handle) { return format_touches(*handle.answer, Layout::line); })
      .def("certificate",
           [](const TouchAnswerHandle& handle, const std::optional<std::size_t>& budget) {
             return certified([&] { return certificate_of(*handle.answer, budget); });
           })
      .def("next_touch", &next_touch_document);
}

}  // namespace rollfix::python
