#include "rollfix/pulse.hpp"

namespace rollfix {
namespace {

constexpr std::chrono::milliseconds kBetweenBeats{20};

}  // namespace

constinit thread_local Pulse* Pulse::current_ = nullptr;

void Pulse::look_up() {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < kBetweenBeats) return;
  last_ = now;
  beat_(doing_);
}

}  // namespace rollfix
