#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rollfix/log.hpp"
#include "watch/rolls.hpp"

namespace rollfix {

/// Rolls, with a stream of one log or of two that makes rows of numbers and of lines.
struct Tracker::State {
  /// Throws InputError: as Tracker does.
  State(const Followed& followed, MakeMeaning make);

  std::vector<Tracked> take(const LogLine& row, LogKind kind);
  /// The log of numbers. Throws InputError: there are two logs, whose rows are lines.
  LogStream& numbers();

  LogStream stream;
  std::optional<PairedStream> two;  // in place of that
  Rolls rolls;
  std::vector<std::string> messages;
};

}  // namespace rollfix
