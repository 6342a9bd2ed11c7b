#pragma once

#include "handles.hpp"
#include "rollfix/pulse.hpp"

namespace rollfix::python {

/// Throws what a signal's handler raises, such as KeyboardInterrupt. In Python's main thread alone: no other hears
/// them.
inline void hear_signals() {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// While it lives other threads can use the interpreter, and Ctrl-C ends what is computed.
class Unlocked {
 public:
  Unlocked() : pulse_([](const char* /*doing*/) { hear_signals(); }) {}

 private:
  py::gil_scoped_release others_may_run_;
  Pulse pulse_;
};

/// For `go_on`, by the thread that waits: signals, such as Ctrl-C, are looked at, and `progress` is told unless None.
inline bool goes_on(const py::object& progress, std::size_t done) {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!progress.is_none()) progress(done);
  return true;
}

}  // namespace rollfix::python
