#pragma once

#include <cstddef>
#include <optional>

#include "rollfix/watch_stop.hpp"

namespace rollfix::app {

/// Lets a few notes through at once and then one now and then, so that a broken sensor does not flood the screen.
class NoteLimit {
 public:
  static constexpr std::size_t kAtOnce = 3;
  static constexpr std::chrono::seconds kOneMoreEvery{5};

  /// Nothing: leave this note out. Otherwise how many were left out since the last one that was told.
  std::optional<std::size_t> allow(Clock::time_point now);

 private:
  std::size_t told_ = 0;  // lately
  std::size_t left_out_ = 0;
  Clock::time_point last_{};
};

}  // namespace rollfix::app
