#include "rollfix/part.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "fingers.hpp"
#include "rollfix/files.hpp"
#include "rollfix/inspect.hpp"
#include "rollfix/solve.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

Reach reach_on(const PartHandle& handle, const py::object& given) {
  const Part part = handle.part();
  const Finger finger = finger_from(given);
  if (!has_reach(finger)) throw InputError("finger: where a finger can touch is known of disks and jaws only");
  const Unlocked others_may_run;
  return reach_of(part, finger);
}

py::array_t<bool> contains(const Reach& reach, const Numbers& places) {
  std::vector<py::ssize_t> shape(places.shape(), places.shape() + places.ndim());
  py::array_t<bool> result(shape);
  bool* out = result.mutable_data();
  for (py::ssize_t k = 0; k < places.size(); ++k) {
    if (!std::isfinite(places.data()[k])) throw InputError("s: expected finite places");
    out[k] = reach.contains(places.data()[k]);
  }
  return result;
}

std::string inspect_document(const PartHandle& handle, const py::object& given) {
  const std::shared_ptr<const LoadedPart> loaded = handle.loaded();
  const std::optional<Finger> finger = given.is_none() ? std::nullopt : std::optional<Finger>(finger_from(given));
  const Unlocked others_may_run;
  return format_inspection(inspect(loaded->part, finger), *loaded, Layout::line);
}

}  // namespace

void bind_reach(py::module_& module) {
  py::class_<Reach>(module, "Reach",
                    "Where a finger can touch a part without entering it anywhere.\n\n"
                    "See docs/reach.md. Lengths are in the part's unit; s runs along the stored outline.")
      .def_property_readonly(
          "arcs", [](const Reach& reach) { return array_of(reach.arcs); },
          "ndarray, (n, 2): along these the finger can roll; lo in [0, P), hi may exceed P.")
      .def_property_readonly(
          "gaps", [](const Reach& reach) { return array_of(reach.gaps()); }, "ndarray, (n, 2): there it can't touch.")
      .def_property_readonly("share", &Reach::share, "float: of the boundary's length that is within reach.")
      .def_property_readonly("is_whole", &Reach::is_whole, "bool: every place, and every pivot at corners.")
      .def_property_readonly(
          "decided", [](const Reach& reach) { return reach.decided; },
          "bool: False where a budget ran out; what is not decided counts as within reach.")
      .def_property_readonly(
          "slack", [](const Reach& reach) { return reach.slack; },
          "float: how deep it may enter and still counts as touching, length.")
      .def("contains", &contains, py::arg("s"), "Whether the finger can touch at s: an array of any shape.");
  module.def("reach_of", &reach_on);
  module.def("inspect", &inspect_document);
}

}  // namespace rollfix::python
