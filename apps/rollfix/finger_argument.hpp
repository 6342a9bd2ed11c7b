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

/// The finger as typed: disk,r=R, jaw, or an outline; nothing when none is given. Throws InputError: no such finger, or
/// more than one.
std::optional<Finger> read_finger(const std::vector<std::string>& fingers);

/// Two fingers, where --finger is given once two alike; nothing when none is given. Throws InputError: no such finger,
/// or more than two.
std::optional<FingerPair> read_fingers(const std::vector<std::string>& fingers);

/// The same where only disks will do. Throws InputError: another one; `what` says for what.
std::optional<DiskFinger> read_disk_finger(const std::vector<std::string>& fingers, const std::string& what);
std::optional<FingerPair> read_disk_fingers(const std::vector<std::string>& fingers, const std::string& what);

/// "disk,r=0.1", "jaw", or the outline's name.
std::string name_of(const Finger& finger);

/// Whether it is known where such a finger can touch a part without entering it elsewhere.
bool has_reach(const Finger& finger);

/// That it is not.
std::string no_reach_note(const Finger& finger);

}  // namespace rollfix::app
