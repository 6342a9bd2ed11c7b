#pragma once

#include <utility>

#include "rollfix/pulse.hpp"

namespace rollfix {

/// What inner loops call.
inline void beat() {
  if (Pulse* const pulse = Pulse::current()) pulse->count();
}

/// Says what is being done while it lives, and what was done before thereafter.
class Doing {
 public:
  explicit Doing(const char* what) : pulse_(Pulse::current()) {
    if (pulse_ != nullptr) before_ = std::exchange(pulse_->doing_, what);
  }
  ~Doing() {
    if (pulse_ != nullptr) pulse_->doing_ = before_;
  }
  Doing(const Doing&) = delete;
  Doing& operator=(const Doing&) = delete;

 private:
  Pulse* pulse_;
  const char* before_ = nullptr;
};

}  // namespace rollfix
