#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>

namespace rollfix::app {

/// As long as it lives it says on a terminal's last line what the program does, once that has taken half a second.
/// Where standard error is no terminal it does nothing.
class ProgressLine {
 public:
  explicit ProgressLine(bool wanted);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

 private:
  void run();
  void show(double seconds);
  void clear();

  std::mutex mutex_;
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::size_t width_ = 0;  // of what is shown
  std::thread thread_;
};

}  // namespace rollfix::app
