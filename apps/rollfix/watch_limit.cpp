#include "rollfix/watch_limit.hpp"

#include <utility>

namespace rollfix::app {

std::optional<std::size_t> NoteLimit::allow(Clock::time_point now) {
  // Every interval that has passed makes room for one more note.
  while (told_ > 0 && now - last_ >= kOneMoreEvery) {
    --told_;
    last_ += kOneMoreEvery;
  }
  if (told_ >= kAtOnce) {
    ++left_out_;
    return std::nullopt;
  }
  if (told_ == 0) last_ = now;
  ++told_;
  return std::exchange(left_out_, 0);
}

}  // namespace rollfix::app
