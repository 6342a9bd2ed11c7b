#pragma once

#include "handles.hpp"

namespace rollfix::python {

/// For `go_on`, by the thread that waits: signals, such as Ctrl-C, are looked at, and `progress` is told unless None.
inline bool goes_on(const py::object& progress, std::size_t done) {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!progress.is_none()) progress(done);
  return true;
}

}  // namespace rollfix::python
