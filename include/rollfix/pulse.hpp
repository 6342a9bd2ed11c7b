#pragma once

// To stop what takes long, or to show that it goes on.
//
//     std::size_t beats = 0;
//     {
//       const Pulse pulse([&](const char*) { ++beats; });  // of this thread; what it throws ends the computation
//       solve({load_part("gallery:ellipse,a=2,b=1"), Reading(1.0, 0.5)});
//     }
//     Pulse::current() == nullptr;  // true

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <chrono>
#include <functional>
#include <utility>

namespace rollfix {

/// While one lives, long computations of its thread, and of threads that they start, look up every 20 ms or so: `beat`
/// is called by its thread with what is being done, in a few words, or with nullptr. What it throws ends the
/// computation and comes out of it.
class Pulse {
 public:
  using Beat = std::function<void(const char* doing)>;

  explicit Pulse(Beat beat) : beat_(std::move(beat)), outer_(current_) { current_ = this; }
  ~Pulse() { current_ = outer_; }
  Pulse(const Pulse&) = delete;
  Pulse& operator=(const Pulse&) = delete;

  /// That of this thread; nullptr: nobody wants to know.
  static Pulse* current() { return current_; }

  /// By inner loops, every millisecond or more often.
  void count() {
    if (++calls_ % kCalls == 0) look_up();
  }
  /// Calls `beat` unless it was called a moment ago.
  void look_up();

 private:
  friend class Doing;
  static constexpr unsigned kCalls = 8;

  static constinit thread_local Pulse* current_;
  Beat beat_;
  Pulse* outer_;
  unsigned calls_ = 0;
  const char* doing_ = nullptr;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace rollfix
