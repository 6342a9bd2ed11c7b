#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "archive.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "fingers.hpp"
#include "log/roll_rows.hpp"
#include "rollfix/log.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

LogOptions log_options(const py::dict& given) {
  LogOptions options;
  for (const py::handle one : given["columns"]) {
    const auto [column, name, unit] = one.cast<std::tuple<std::string, std::string, std::string>>();
    options.columns.push_back({column, name, unit});
  }
  options.unit = given["unit"].cast<std::string>();
  options.angles = given["angles"].cast<std::string>();
  options.wrapped = given["wrapped"].cast<std::optional<bool>>();
  options.skip_bad = given["skip_bad"].cast<bool>();
  if (given["decimal_comma"].cast<bool>()) options.decimal_comma = true;
  options.single_rows = given["single_rows"].cast<bool>();
  return options;
}

LogHandle handle_of(Log log) { return {std::make_shared<const Log>(std::move(log))}; }

std::vector<LogHandle> handles_of(std::vector<Log> logs) {
  std::vector<LogHandle> handles;
  for (Log& log : logs) handles.push_back(handle_of(std::move(log)));
  return handles;
}

std::vector<LogHandle> read_files(const std::vector<std::string>& paths, const py::dict& given) {
  const LogOptions options = log_options(given);
  const Unlocked others_may_run;
  if (paths.size() == 2) return {handle_of(read_log(paths[0], paths[1], options))};
  return handles_of(read_rolls(paths.at(0), options));
}

std::vector<LogHandle> read_text(const std::string& text, const std::string& name, const py::dict& given) {
  const LogOptions options = log_options(given);
  const Unlocked others_may_run;
  return handles_of(parse_rolls(text, name, options));
}

/// Of a wheel without skin: its u says nothing.
LogHandle read_pin(const std::string& from, const std::optional<std::string>& name, const py::dict& given) {
  const LogOptions options = log_options(given);
  const Unlocked others_may_run;
  return handle_of(std::move((name ? parse_pin_log(from, *name, options) : read_pin_log(from, options)).rows));
}

constexpr py::ssize_t kRowsAtOnce = 50000;

/// Columns as the text of a log: each number with as few digits as give it back, which are those of the file that it
/// was read from. So a table is a log like any other, with the same checks and the same rounding.
std::string table_text(const std::vector<std::string>& names, const std::vector<Numbers>& columns) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) text += (k == 0 ? "\"" : ",\"") + names[k] + "\"";
  const py::ssize_t rows = columns.empty() ? 0 : columns.front().size();
  for (py::ssize_t row = 0; row < rows; ++row) {
    if (row % kRowsAtOnce == 0) hear_signals();
    text += '\n';
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (k > 0) text += ',';
      fmt::format_to(std::back_inserter(text), "{}", columns[k].data()[row]);
    }
  }
  return text + '\n';
}

/// All columns by their names in a file, of two fingers u_a, u_b and so on. `added_up`: of increments their sums.
py::dict columns_of(const LogHandle& handle, bool added_up) {
  const Log& log = *handle.log;
  py::dict result;
  if (!log.time.empty()) result["time"] = array_of(log.time);
  for (std::size_t which = 0; which < log.fingers.size(); ++which) {
    const FingerRows& rows = log.fingers[which];
    const std::string suffix = log.fingers.size() == 1 ? "" : which == 0 ? "_a" : "_b";
    const auto add = [&](const char* name, const std::vector<double>& values) {
      if (!values.empty()) result[py::str(name + suffix)] = array_of(values);
    };
    if (log.kind == LogKind::increments && !added_up) {
      const Increments increments = increments_of(rows);
      add("distance", increments.distance);
      add("dturn", increments.dturn);
    } else {
      add("u", rows.u);
      add("psi", rows.psi);
      add("length", rows.length);
      add("turn", rows.turn);
    }
    add("x", rows.x);
    add("y", rows.y);
  }
  return result;
}

const char* kind_of(const LogHandle& handle) {
  switch (handle.log->kind) {
    case LogKind::contact:
      return "contact";
    case LogKind::travelled:
      return "travelled";
    case LogKind::increments:
      break;
  }
  return "increments";
}

}  // namespace

void bind_log(py::module_& module) {
  py::class_<LogHandle>(module, "Log")
      .def_property_readonly("rows", [](const LogHandle& handle) { return handle.log->rows(); })
      .def_property_readonly("fingers", [](const LogHandle& handle) { return handle.log->fingers.size(); })
      .def_property_readonly("name", [](const LogHandle& handle) { return handle.log->name; })
      .def_property_readonly("unit", [](const LogHandle& handle) { return handle.log->unit; })
      .def_property_readonly("kind", &kind_of)
      .def_property_readonly("skipped", [](const LogHandle& handle) { return handle.log->skipped; })
      .def_property_readonly("notes", [](const LogHandle& handle) { return handle.log->notes; })
      .def("columns", &columns_of)
      .def("text", [](const LogHandle& handle) { return format_log(*handle.log); })
      .def("is_same",
           [](const LogHandle& one, const LogHandle& two) { return bytes_of(*one.log) == bytes_of(*two.log); })
      .def("in_unit",
           [](const LogHandle& handle, const std::string& unit, const py::iterable& fingers) {
             return handle_of(in_unit(*handle.log, unit, fingers_from(fingers)));
           })
      .def("paired", [](const LogHandle& a, const LogHandle& b) { return handle_of(paired(*a.log, *b.log)); })
      .def(py::pickle([](const LogHandle& handle) { return py::bytes(bytes_of(*handle.log)); },
                      [](const py::bytes& bytes) {
                        Log log;
                        read_bytes(std::string(bytes), log);
                        return handle_of(std::move(log));
                      }));
  module.def("read_log_files", &read_files);
  module.def("read_log_text", &read_text);
  module.def("read_pin", &read_pin);
  module.def("parse_columns", [](const std::string& text) {
    std::vector<std::tuple<std::string, std::string, std::string>> columns;
    for (const ColumnSource& one : parse_columns(text)) columns.emplace_back(one.column, one.name, one.unit);
    return columns;
  });
  module.def("table_text", &table_text);
}

}  // namespace rollfix::python
