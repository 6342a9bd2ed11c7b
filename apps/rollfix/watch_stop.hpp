#pragma once

#include <chrono>

namespace rollfix::app {

using Clock = std::chrono::steady_clock;
using Deadline = Clock::time_point;

/// As long as it lives, SIGINT and SIGTERM only leave a mark, so that the program can end cleanly; a second one of them
/// ends it at once. One at a time.
class StopSignal {
 public:
  /// Throws InternalError when the system refuses.
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  bool came() const;

  /// Waits until `descriptor` can be read, the deadline, or a signal; true: it can be read, or is at its end.
  bool wait_readable(int descriptor, Deadline deadline) const;

  /// Waits until the deadline or a signal.
  void sleep(Deadline deadline) const;
};

}  // namespace rollfix::app
