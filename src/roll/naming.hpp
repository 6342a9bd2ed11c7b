#pragma once

#include <fmt/format.h>

#include <array>

#include "rollfix/error.hpp"

namespace rollfix {

inline constexpr std::array<const char*, 2> kFingerNames = {"finger a", "finger b"};

/// Says which finger an error is about.
template <class Action>
void naming(const char* finger, const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", finger, error.what()));
  }
}

}  // namespace rollfix
