#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/pair_log.hpp"

namespace rollfix::app {

/// A finger as typed: a disk, or a flat jaw.
struct FingerShape {
  std::optional<DiskFinger> disk;  // nothing: a jaw

  double curvature() const { return disk ? 1 / disk->radius : 0; }
  std::string name() const;  // "disk,r=0.1", "jaw"
};

/// Adds --finger to a command. It can be typed twice: two fingers.
void add_finger_argument(CLI::App& command, std::vector<std::string>& fingers);

/// The finger, which has to be a disk; nothing when none is given. Throws InputError: another one, or more than one.
std::optional<DiskFinger> read_finger(const std::vector<std::string>& fingers);

/// Two fingers, where --finger is given once two alike; nothing when none is given. Throws InputError: another one than
/// a disk, or more than two.
std::optional<FingerPair> read_fingers(const std::vector<std::string>& fingers);

/// The same of any shape. Throws InputError: another one than disk,r=R or jaw, or too many.
std::optional<FingerShape> read_shape(const std::vector<std::string>& fingers);
std::optional<std::array<FingerShape, 2>> read_shapes(const std::vector<std::string>& fingers);

}  // namespace rollfix::app
