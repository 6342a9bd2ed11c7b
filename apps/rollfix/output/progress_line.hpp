#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>

namespace rollfix::app {

/// A line on the terminal of stderr that is written over again and again, and is gone in the end.
class ProgressLine {
 public:
  explicit ProgressLine(bool is_wanted = true) : is_shown_(is_wanted && isatty(STDERR_FILENO) != 0) {}
  ~ProgressLine() {
    if (width_ > 0) std::fprintf(stderr, "\r%*s\r", static_cast<int>(width_), "");
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool is_shown() const { return is_shown_; }
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  void show(const std::string& line) {
    if (!is_shown_ || line == last_) return;
    last_ = line;
    std::fprintf(stderr, "\r%-*s", static_cast<int>(width_), line.c_str());
    std::fflush(stderr);
    width_ = std::max(width_, line.size());
  }

 private:
  bool is_shown_;
  std::string last_;
  std::size_t width_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace rollfix::app
