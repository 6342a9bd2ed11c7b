#include <algorithm>
#include <cmath>

#include "archive.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "fingers.hpp"
#include "rollfix/files.hpp"

namespace rollfix::python {
namespace {

/// The probability density of a finger's first contact at s, per length; a pivot at a corner is a point, and not in it.
/// Pieces are in order and do not overlap; the last may go on across s = 0.
double density_at(const Density& density, const Boundary& boundary, double s) {
  const auto at = [&](double place) {
    auto next = std::upper_bound(density.begin(), density.end(), place,
                                 [](double value, const DensityPiece& piece) { return value < piece.s.lo; });
    while (next != density.begin()) {
      --next;
      if (next->s.width() > 0) return place <= next->s.hi ? next->probability / next->s.width() : 0.0;
    }
    return 0.0;
  };
  if (!boundary.closed && !(s >= 0 && s <= boundary.perimeter)) return 0;
  const double base = boundary.base(s);
  const double here = at(base);
  return here > 0 || !boundary.closed ? here : at(base + boundary.perimeter);
}

/// Pieces in order, as arrays: (n, 2) of s, (n,) of probability.
py::object density_of(const AnswerHandle& handle, std::size_t finger) {
  const Answer& answer = *handle.answer;
  if (!answer.weighing || finger >= answer.weighing->density.size()) return py::none();
  const Density& density = answer.weighing->density[finger];
  std::vector<double> probability;
  for (const DensityPiece& piece : density) probability.push_back(piece.probability);
  return py::make_tuple(rows_of(density, 2,
                                [](const DensityPiece& piece, double* out) {
                                  out[0] = piece.s.lo;
                                  out[1] = piece.s.hi;
                                }),
                        array_of(std::move(probability)));
}

/// Walks the pieces once for many places.
py::array_t<double> density_each(const AnswerHandle& handle, std::size_t finger, const Numbers& places) {
  const Answer& answer = *handle.answer;
  std::vector<py::ssize_t> shape(places.shape(), places.shape() + places.ndim());
  py::array_t<double> result(shape);
  const Density& density = answer.weighing.value().density[finger];
  const Boundary boundary = answer.part.boundary();
  double* out = result.mutable_data();
  for (py::ssize_t k = 0; k < places.size(); ++k) out[k] = density_at(density, boundary, places.data()[k]);
  return result;
}

py::array_t<double> readings_of(const AnswerHandle& handle) {
  const Answer& answer = *handle.answer;
  const std::size_t fingers = answer.finger_count();
  return rows_of(answer.readings, fingers + 1, [&](const Reading& reading, double* out) {
    for (const double length : reading.length) *out++ = length;
    *out = reading.turn;
  });
}

py::array_t<double> pivots_of(const AnswerHandle& handle) {
  return rows_of(handle.answer->readings, 1, [](const Reading& reading, double* out) { *out = reading.pivot; });
}

std::string whole_document(const AnswerHandle& handle, bool explain) {
  return format_answer(*handle.answer, Layout::line, explain);
}

py::object facing_of(const AnswerHandle& handle) {
  const std::optional<double>& facing = handle.answer->facing;
  return facing ? py::object(py::float_(*facing)) : py::none();
}

}  // namespace

py::tuple answer_state(const AnswerHandle& handle) {
  const Answer& answer = *handle.answer;
  return py::make_tuple(PartHandle(answer.part), fingers_to(answer.fingers), py::bytes(bytes_of(answer)));
}

AnswerHandle answer_from_state(const PartHandle& part, const py::tuple& fingers, const py::bytes& bytes) {
  Answer answer{part.part(), fingers_from(fingers)};
  read_bytes(std::string(bytes), answer);
  return {std::make_shared<const Answer>(std::move(answer))};
}

void bind_answer(py::module_& module) {
  py::class_<AnswerHandle>(module, "Answer")
      .def("__len__", [](const AnswerHandle& handle) { return handle.answer->placements.size(); })
      .def("placement",
           [](const AnswerHandle& handle, std::size_t k) {
             if (k >= handle.answer->placements.size()) throw py::index_error("placement");
             return PlacementHandle{handle.answer, k};
           })
      .def_property_readonly("part", [](const AnswerHandle& handle) { return PartHandle(handle.answer->part); })
      .def_property_readonly("status", [](const AnswerHandle& handle) { return name_of(handle.answer->status); })
      .def_property_readonly("verdict", [](const AnswerHandle& handle) { return handle.answer->verdict.text(); })
      .def_property_readonly("fingers", [](const AnswerHandle& handle) { return handle.answer->finger_count(); })
      .def_property_readonly("has_noise",
                             [](const AnswerHandle& handle) { return handle.answer->weighing.has_value(); })
      .def_property_readonly("readings", &readings_of)
      .def_property_readonly("facing", &facing_of)
      .def_property_readonly("tolerance", [](const AnswerHandle& handle) { return handle.answer->tolerance.value; })
      .def_property_readonly("finger_arguments",
                             [](const AnswerHandle& handle) { return fingers_to(handle.answer->fingers); })
      .def_property_readonly("mirrored", [](const AnswerHandle& handle) { return handle.answer->mirrored; })
      .def_property_readonly("strays", [](const AnswerHandle& handle) { return handle.answer->strays; })
      .def_property_readonly("starts",
                             [](const AnswerHandle& handle) {
                               return rows_of(handle.answer->placements, handle.answer->finger_count(),
                                              [](const Placement& placement, double* out) {
                                                for (const double s : placement.start) *out++ = s;
                                              });
                             })
      .def_property_readonly("pose_time", [](const AnswerHandle& handle) { return array_of(handle.answer->pose_time); })
      .def_property_readonly("pivots", &pivots_of)
      .def_property_readonly("notes", [](const AnswerHandle& handle) { return notes_of(*handle.answer); })
      .def("density_pieces", &density_of)
      .def("density", &density_each)
      .def("document", &whole_document)
      .def("certificate",
           [](const AnswerHandle& handle, const std::optional<std::size_t>& budget) {
             return certified([&] { return certificate_of(*handle.answer, budget); });
           })
      .def_property_readonly("either_way", [](const AnswerHandle& handle) { return handle.answer->either_way; })
      .def("bytes", [](const AnswerHandle& handle) { return py::bytes(bytes_of(*handle.answer)); })
      .def("state", &answer_state);
  module.def("answer_from_state", &answer_from_state);
}

}  // namespace rollfix::python
