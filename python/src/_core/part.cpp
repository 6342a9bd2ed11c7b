#include <fmt/format.h>

#include <iterator>
#include <optional>
#include <string>

#include "archive.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/units.hpp"
#include "signals.hpp"
#include "text/units.hpp"
#include "work/pulse.hpp"

namespace rollfix::python {
namespace {

// From here on another thread can use the interpreter meanwhile.
constexpr py::ssize_t kManyPlaces = 1000;

LoadOptions load_options(const py::dict& options) {
  LoadOptions result;
  const auto get = [&](const char* name) { return options.contains(name) ? py::object(options[name]) : py::none(); };
  const auto length = [&](const char* name) -> std::optional<Length> {
    const py::object value = get(name);
    if (value.is_none()) return std::nullopt;
    return Length(value.cast<double>());
  };
  result.points.open = options.contains("open") && options["open"].cast<bool>();
  result.points.corner_angle = get("corner_angle").cast<std::optional<double>>();
  result.points.smooth = length("smooth");
  result.points.unit = options.contains("unit") ? options["unit"].cast<std::string>() : "";
  result.loop = get("loop").cast<std::optional<std::size_t>>();
  result.gap = length("gap");
  result.outer = options.contains("outer") && options["outer"].cast<bool>();
  if (options.contains("decimal_comma") && options["decimal_comma"].cast<bool>()) result.points.decimal_comma = true;
  result.layer = options.contains("layer") ? options["layer"].cast<std::string>() : "";
  result.saved_name = true;
  result.allow_crossing = options.contains("allow_crossing") && options["allow_crossing"].cast<bool>();
  return result;
}

PartHandle load(const std::string& source, const py::dict& options) {
  const LoadOptions chosen = load_options(options);
  const Unlocked others_may_run;
  return PartHandle(load_part(source, chosen));
}

/// As a points file that holds them: the same checks, the same part.
PartHandle from_points(const Numbers& points, const std::string& name, const py::dict& options) {
  const LoadOptions chosen = load_options(options);
  std::string text;
  for (py::ssize_t k = 0; k < points.shape(0); ++k) {
    fmt::format_to(std::back_inserter(text), "{} {}\n", points.at(k, 0), points.at(k, 1));
  }
  const Unlocked others_may_run;
  return PartHandle(load_points(text, name, chosen));
}

/// Curves by the control points of Bezier pieces, one after the other.
PartHandle from_pieces(const std::vector<Numbers>& pieces, const std::string& name, bool closed,
                       const std::string& unit, bool allow_crossing, double gap) {
  Outline outline;
  outline.name = name;
  outline.closed = closed;
  outline.unit = unit;
  outline.gap = gap;
  for (const Numbers& piece : pieces) {
    std::vector<Vec2> points;
    for (py::ssize_t k = 0; k < piece.shape(0); ++k) points.emplace_back(piece.at(k, 0), piece.at(k, 1));
    outline.curves.emplace_back(Bezier(std::move(points)));
  }
  const Unlocked others_may_run;
  return PartHandle(Part(std::move(outline), {allow_crossing}));
}

/// The function at each place, in an array of that shape, with `width` numbers a place behind it (0: one, no axis).
template <class At>
py::array_t<double> each(const PartHandle& handle, const Numbers& places, py::ssize_t width, const At& at) {
  const Part part = handle.part();
  std::vector<py::ssize_t> shape(places.shape(), places.shape() + places.ndim());
  if (width > 0) shape.push_back(width);
  py::array_t<double> result(shape);
  const double* in = places.data();
  double* out = result.mutable_data();
  const py::ssize_t count = places.size();
  const py::ssize_t step = width > 0 ? width : 1;
  for (py::ssize_t k = 0; k < count; ++k) {
    if (!std::isfinite(in[k])) throw InputError(fmt::format("s: expected finite places, found {}", in[k]));
  }
  const auto work = [&] {
    for (py::ssize_t k = 0; k < count; ++k) {
      beat();
      at(part, in[k], out + k * step);
    }
  };
  if (count < kManyPlaces) {
    work();
  } else {
    const Unlocked others_may_run;
    work();
  }
  return result;
}

/// Of places in arrays of one shape.
py::array_t<double> distances(const PartHandle& handle, const Numbers& s, const Numbers& t) {
  const Part part = handle.part();
  py::array_t<double> result(std::vector<py::ssize_t>(s.shape(), s.shape() + s.ndim()));
  for (py::ssize_t k = 0; k < s.size(); ++k) result.mutable_data()[k] = part.distance(s.data()[k], t.data()[k]);
  return result;
}

py::dict samples(const PartHandle& handle) {
  const std::vector<BoundarySample> all = samples_of(handle.part());
  const auto column = [&](const auto& value) {
    std::vector<double> values;
    for (const BoundarySample& one : all) values.push_back(value(one));
    return array_of(std::move(values));
  };
  py::dict result;
  result["s"] = column([](const BoundarySample& one) { return one.s; });
  result["x"] = column([](const BoundarySample& one) { return one.point.x(); });
  result["y"] = column([](const BoundarySample& one) { return one.point.y(); });
  result["tangent"] = column([](const BoundarySample& one) { return one.tangent; });
  result["curvature"] = column([](const BoundarySample& one) { return one.curvature; });
  return result;
}

py::tuple part_state(const PartHandle& handle) {
  const LoadedPart& loaded = *handle.loaded();
  std::vector<Loop> loops = loaded.loops;
  return py::make_tuple(loaded.part.name(), format_part(loaded.part), py::bytes(bytes_of(loops)), loaded.loop,
                        loaded.unit, loaded.notes);
}

PartHandle part_from_state(const py::tuple& state) {
  LoadedPart loaded{parse_part(state[1].cast<std::string>(), state[0].cast<std::string>()), "", {}, 0, {}};
  read_bytes(std::string(state[2].cast<py::bytes>()), loaded.loops);
  loaded.loop = state[3].cast<std::size_t>();
  loaded.unit = state[4].cast<std::string>();
  loaded.notes = state[5].cast<std::vector<std::string>>();
  return PartHandle(std::move(loaded));
}

/// The usual name of a unit of length, such as "in" of "inches"; "" stays. Throws InputError, which begins with the
/// argument's name.
std::string unit_of_length(const std::string& given, const std::string& argument) {
  if (given.empty()) return given;
  const std::optional<Unit> unit = unit_named(given);
  if (unit && unit->dimension == Dimension::length) return std::string(unit->name);
  throw InputError(fmt::format("{}: expected a unit of length: {}, found {}", argument, unit_names(Dimension::length),
                               py::repr(py::str(given)).cast<std::string>()));
}

py::list shapes() {
  py::list result;
  for (const GalleryShape& shape : gallery_shapes()) {
    py::dict parameters;
    for (const GalleryParameter& one : shape.parameters) {
      parameters[py::str(one.name)] = py::make_tuple(one.default_value, one.meaning, allowed_values(one));
    }
    result.append(py::make_tuple(shape.name, shape.formula, parameters));
  }
  return result;
}

void bind_facts(py::class_<PartHandle>& part) {
  part.def_property_readonly("name", [](const PartHandle& handle) { return handle.part().name(); });
  part.def_property_readonly("unit", [](const PartHandle& handle) { return handle.part().unit(); });
  part.def_property_readonly("closed", [](const PartHandle& handle) { return handle.part().closed(); });
  part.def_property_readonly("reversed", [](const PartHandle& handle) { return handle.part().reversed(); });
  part.def_property_readonly("perimeter", [](const PartHandle& handle) { return handle.part().perimeter(); });
  part.def_property_readonly("total_turn", [](const PartHandle& handle) { return handle.part().total_turn(); });
  part.def_property_readonly("turns", [](const PartHandle& handle) { return handle.part().turns(); });
  part.def_property_readonly("inflections",
                             [](const PartHandle& handle) { return array_of(handle.part().inflections()); });
  part.def_property_readonly("vertices", [](const PartHandle& handle) { return array_of(handle.part().vertices()); });
  part.def_property_readonly("corners", [](const PartHandle& handle) {
    return rows_of(handle.part().corners(), 2, [](const Corner& corner, double* out) {
      out[0] = corner.s;
      out[1] = corner.turn;
    });
  });
  part.def_property_readonly("notes", [](const PartHandle& handle) { return handle.loaded()->notes; });
  part.def_property_readonly("is_open_for_use", &PartHandle::is_open_for_use);
  part.def("close", &PartHandle::close);
  part.def("is_same", [](const PartHandle& one, const PartHandle& other) {
    if (one.loaded() == other.loaded()) return true;
    return one.part().name() == other.part().name() && format_part(one.part()) == format_part(other.part());
  });
  part.def("save", [](const PartHandle& handle, const std::string& path) { save_part(handle.part(), path); });
  part.def("samples", &samples);
  part.def(py::pickle(&part_state, &part_from_state));
}

}  // namespace

void bind_part(py::module_& module) {
  py::class_<PartHandle> part(module, "Part");
  bind_facts(part);
  part.def("point", [](const PartHandle& handle, const Numbers& s) {
    return each(handle, s, 2, [](const Part& of, double at, double* out) {
      const Vec2 point = of.point(at);
      out[0] = point.x();
      out[1] = point.y();
    });
  });
  part.def("turning", [](const PartHandle& handle, const Numbers& s) {
    return each(handle, s, 0, [](const Part& of, double at, double* out) { *out = of.turning().angle(at); });
  });
  part.def("curvature", [](const PartHandle& handle, const Numbers& s) {
    return each(handle, s, 0, [](const Part& of, double at, double* out) { *out = of.turning().curvature(at); });
  });
  part.def("tangent", [](const PartHandle& handle, const Numbers& s) {
    return each(handle, s, 0, [](const Part& of, double at, double* out) { *out = of.tangent(at); });
  });
  part.def("distance", &distances);
  module.def("load_part", &load);
  module.def("part_from_points", &from_points);
  module.def("part_from_pieces", &from_pieces);
  module.def("unit_of_length", &unit_of_length);
  module.def("gallery_shapes", &shapes);
}

}  // namespace rollfix::python
