#include <fmt/format.h>

#include <cmath>

#include "archive.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "rollfix/files.hpp"

namespace rollfix::python {
namespace {

/// Of an answer with noise; none of one without.
template <class Value>
py::object with_noise(const PlacementHandle& placement, const Value& value) {
  if (!placement.answer->weighing) return py::none();
  return array_of(value);
}

py::object number(double value) { return std::isfinite(value) ? py::object(py::float_(value)) : py::none(); }

py::array_t<double> roots_of(const PlacementHandle& placement) {
  const std::size_t fingers = placement.answer->finger_count();
  return rows_of(placement->roots, fingers, [&](const PerFinger<double>& root, double* out) {
    for (const double s : root) *out++ = s;
  });
}

py::tuple pivots_of(const PerFinger<Pivot>& pivots) {
  const auto one = [](const Pivot& pivot) {
    return py::make_tuple(py::make_tuple(pivot.start.lo, pivot.start.hi), py::make_tuple(pivot.end.lo, pivot.end.hi));
  };
  return pivots.size() == 1 ? one(pivots[0]) : py::make_tuple(one(pivots[0]), one(pivots[1]));
}

/// [finger][reading] and [finger][reading][which finger's length]; NaN where it is undefined.
py::object per_turn(const PlacementHandle& placement) {
  const auto& lists = placement->sensitivity.per_turn;
  if (lists[0].empty()) return py::none();
  return rows_of(lists, lists[0].size(), [](const ShortList<double>& list, double* out) {
    for (const double value : list) *out++ = value;
  });
}

py::object per_length(const PlacementHandle& placement) {
  const auto& lists = placement->sensitivity.per_length;
  if (lists[0].empty()) return py::none();
  const std::size_t fingers = lists.size();
  const std::size_t readings = lists[0].size();
  const auto flat = rows_of(lists, readings * fingers, [](const ShortList<PerFinger<double>>& list, double* out) {
    for (const PerFinger<double>& one : list) {
      for (const double value : one) *out++ = value;
    }
  });
  return flat.attr("reshape")(fingers, readings, fingers);
}

py::object pose_of(const PlacementHandle& placement) {
  if (!placement->pose_residual) return py::none();
  return array_of(placement->pose);
}

py::object document_of(const PlacementHandle& placement) {
  const py::object document = py::module_::import("json").attr("loads")(format_answer(*placement.answer, Layout::line));
  return document["placements"][py::int_(placement.index)];
}

/// Of one finger for each of many places.
py::object may_hold(const PlacementHandle& placement, const Numbers& places) {
  const Boundary boundary = placement.answer->part.boundary();
  const double* const s = places.data();
  for (py::ssize_t k = 0; k < places.size(); ++k) {
    if (!std::isfinite(s[k])) throw InputError(fmt::format("s: expected finite places, found {}", s[k]));
  }
  if (placement.answer->finger_count() == 2) {
    if (places.size() == 2) return py::bool_(placement->contains(boundary, {s[0], s[1]}));
    throw InputError(fmt::format("s: expected a pair of places, one of each finger, found {}", places.size()));
  }
  if (places.ndim() == 0) return py::bool_(placement->contains(boundary, s[0]));
  py::array_t<bool> result(std::vector<py::ssize_t>(places.shape(), places.shape() + places.ndim()));
  for (py::ssize_t k = 0; k < places.size(); ++k) result.mutable_data()[k] = placement->contains(boundary, s[k]);
  return result;
}

/// "<Placement crossing: start 0.5760, end 1.5737>".
std::string text_of(const PlacementHandle& placement) {
  const auto places = [](const PerFinger<double>& each) {
    return each.size() == 1 ? fmt::format("{:.4f}", each[0]) : fmt::format("({:.4f}, {:.4f})", each[0], each[1]);
  };
  const std::string probability =
      std::isfinite(placement->probability) ? fmt::format(", probability {:.3f}", placement->probability) : "";
  return fmt::format("<Placement {}: start {}, end {}{}>", name_of(placement->kind), places(placement->start),
                     places(placement->end), probability);
}

using Class = py::class_<PlacementHandle>;

void bind_place(Class& placement) {
  placement.def_property_readonly(
      "kind", [](const PlacementHandle& one) { return name_of(one->kind); },
      "str: 'crossing', 'touching', 'stretch' or 'corner'.");
  placement.def_property_readonly(
      "start", [](const PlacementHandle& one) { return array_of(one->start); },
      "ndarray, (fingers,): s of the first contacts, length, in [0, P).");
  placement.def_property_readonly(
      "end", [](const PlacementHandle& one) { return array_of(one->end); },
      "ndarray, (fingers,): s of the contacts at the last reading, in [0, P).");
  placement.def_property_readonly(
      "extent", [](const PlacementHandle& one) { return array_of(one->extent); },
      "ndarray, (fingers, 2): the connected set of starts that fit; hi may exceed P.");
  placement.def_property_readonly(
      "whole_loop",
      [](const PlacementHandle& one) {
        return one->whole_loop[0] && (one->whole_loop.size() == 1 || one->whole_loop[1]);
      },
      "bool: the extent is all of a closed boundary (of two fingers: of both).");
  placement.def_property_readonly("roots", &roots_of,
                                  "ndarray, (n, fingers): every start in the extent that fits exactly.");
  placement.def_property_readonly(
      "error", [](const PlacementHandle& one) { return number(one->error); },
      "float or None: bound on |start - exact root|, length; None where not simple.");
  placement.def_property_readonly(
      "point", [](const PlacementHandle& one) { return array_of(one->point); },
      "ndarray, (fingers, 2): x and y of the first contacts in the part's frame.");
  placement.def_property_readonly(
      "tangent", [](const PlacementHandle& one) { return array_of(one->tangent); },
      "ndarray, (fingers,): the boundary's direction there, radians, in (-pi, pi].");
  placement.def_property_readonly(
      "residual", [](const PlacementHandle& one) { return one->residual; },
      "float: largest deviation of the turn at `start`, radians, eqs. (4), (8), (9).");
}

void bind_details(Class& placement) {
  placement.def_property_readonly("per_turn", &per_turn,
                                  "ndarray, (fingers, readings), or None: d start / d turn, length per radian.");
  placement.def_property_readonly("per_length", &per_length,
                                  "ndarray, (fingers, readings, fingers), or None: d start / d length.");
  placement.def_property_readonly(
      "pivot",
      [](const PlacementHandle& one) -> py::object {
        if (!one->pivot) return py::none();
        return pivots_of(*one->pivot);
      },
      "tuple or None: of a corner ((lo, hi), (lo, hi)), the tangent's range at both ends of the roll, radians.");
  placement.def_property_readonly(
      "family",
      [](const PlacementHandle& one) -> py::object {
        if (one.answer->finger_count() == 1 || one->kind != Kind::stretch) return py::none();
        return rows_of(one->family, 2, [](const PerFinger<double>& pair, double* out) {
          out[0] = pair[0];
          out[1] = pair[1];
        });
      },
      "ndarray, (n, 2), or None: of two fingers' stretch a line of pairs through all of it, unwrapped.");
  placement.def_property_readonly("pose", &pose_of,
                                  "ndarray, (rows, 3), or None: the part's x, y, heading at each row of the log.");
  placement.def_property_readonly(
      "direction",
      [](const PlacementHandle& one) -> py::object {
        if (!one.answer->either_way) return py::none();
        return py::str(one->clockwise ? "cw" : "ccw");
      },
      "str or None: with direction='either', which way round lengths count here: 'ccw' or 'cw'.");
  placement.def_property_readonly(
      "contradicted", [](const PlacementHandle& one) { return one->is_contradicted; },
      "bool: without noise: other rows of the log, or the contacts in the world, contradict it.");
}

void bind_weight(Class& placement) {
  placement.def_property_readonly(
      "probability", [](const PlacementHandle& one) { return number(one->probability); },
      "float or None: with noise, of the roll having started here.");
  placement.def_property_readonly(
      "mean", [](const PlacementHandle& one) { return with_noise(one, one->mean); },
      "ndarray, (fingers,), or None: with noise, of the first contacts.");
  placement.def_property_readonly(
      "sd", [](const PlacementHandle& one) { return with_noise(one, one->sd); },
      "ndarray, (fingers,), or None: with noise, their standard deviations, length.");
  placement.def_property_readonly(
      "covariance",
      [](const PlacementHandle& one) -> py::object {
        return one.answer->finger_count() == 2 ? with_noise(one, one->covariance) : py::none();
      },
      "ndarray, (2, 2), or None: of two fingers with noise, length^2.");
  placement.def_property_readonly(
      "interval", [](const PlacementHandle& one) { return with_noise(one, one->interval); },
      "ndarray, (fingers, 2), or None: holds 95 % of its probability; hi may exceed P.");
  placement.def_property_readonly(
      "end_mean", [](const PlacementHandle& one) { return with_noise(one, one->end_mean); },
      "ndarray, (fingers,), or None: with noise, of where the contacts are now.");
  placement.def_property_readonly(
      "end_sd", [](const PlacementHandle& one) { return with_noise(one, one->end_sd); },
      "ndarray, (fingers,), or None: its standard deviation, length.");
  placement.def_property_readonly(
      "pose_mean",
      [](const PlacementHandle& one) -> py::object {
        if (!one->pose_spread) return py::none();
        const Pose& pose = one->pose_spread->mean;
        return array_of(std::vector<double>{pose.x, pose.y, pose.heading});
      },
      "ndarray, (3,), or None: with noise, the part's x, y, heading at the first contact.");
  placement.def_property_readonly(
      "pose_covariance",
      [](const PlacementHandle& one) -> py::object {
        return one->pose_spread ? py::object(array_of(one->pose_spread->covariance)) : py::none();
      },
      "ndarray, (3, 3), or None: of that; length^2, length times radians, radians^2.");
}

}  // namespace

void bind_placement(py::module_& module) {
  Class placement(
      module, "Placement",
      "One place (of two fingers: one pair of places) where the roll can have started.\n\n"
      "What is of a finger has an entry for each. Arrays can't be written to. Lengths are in the part's\n"
      "unit, angles in radians; s runs along the stored outline. The names are those of the JSON document.");
  bind_place(placement);
  bind_details(placement);
  bind_weight(placement);
  placement.def(
      "contains", &may_hold, py::arg("s"),
      "bool: whether the roll can have started at s: in `interval` with noise, else in `extent`, across s = 0\n"
      "as anywhere else. Of two fingers s is a pair; of one it may be an array, and so is the answer then.");
  placement.def("to_dict", &document_of, "Its entry of `placements` in the JSON document.");
  placement.def("__eq__", [](const PlacementHandle& one, const py::object& other) {
    return py::isinstance<PlacementHandle>(other) && bytes_of(*one) == bytes_of(*other.cast<const PlacementHandle&>());
  });
  placement.def("__hash__", [](const PlacementHandle& one) { return py::hash(py::bytes(bytes_of(*one))); });
  placement.def("__repr__", &text_of);
  placement.def(py::pickle(
      [](const PlacementHandle& one) { return py::make_tuple(answer_state({one.answer}), one.index); },
      [](const py::tuple& state) {
        const auto answer = state[0].cast<py::tuple>();
        return PlacementHandle{answer_from_state(answer[0].cast<const PartHandle&>(), answer[1], answer[2]).answer,
                               state[1].cast<std::size_t>()};
      }));
}

}  // namespace rollfix::python
