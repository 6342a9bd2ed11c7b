#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/pair_log.hpp"

namespace rollfix::app {

/// Adds --finger to a command. It can be typed twice: two fingers.
void add_finger_argument(CLI::App& command, std::vector<std::string>& fingers);

/// The finger; nothing when none is given. Throws InputError: another one than disk,r=R, or more than one.
std::optional<DiskFinger> read_finger(const std::vector<std::string>& fingers);

/// Two fingers, where --finger is given once two alike; nothing when none is given. Throws InputError: another one than
/// disk,r=R, or more than two.
std::optional<FingerPair> read_fingers(const std::vector<std::string>& fingers);

}  // namespace rollfix::app
