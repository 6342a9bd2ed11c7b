#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rollfix/contact/log.hpp"
#include "rollfix/contact/log_options.hpp"

namespace rollfix {

/// What is known of a wheel without skin, which turns freely on a pin: where the pin was and, by an encoder, how the
/// wheel was turned. Where the part touches it is not known. docs/rig.md.
struct PinLog {
  /// time, x and y of the pin in the world, and psi in radians, counter-clockwise; no psi: without an encoder. Its u
  /// says nothing: there are as many as rows.
  Log rows;

  bool has_encoder() const { return !rows.fingers.front().psi.empty(); }
};

/// Reads such a log: columns x and y, at most psi, time and contact besides, all else as `read_log`. Throws InputError
/// as that does, where x or y is missing, and where the log has a skin's u: then the finger is a disk.
PinLog read_pin_log(const std::string& path, const LogOptions& options = {});

/// The same from a text; `name` is what messages call it.
PinLog parse_pin_log(std::string_view text, const std::string& name, const LogOptions& options = {});

/// The same from numbers. `psi` and `time` may be empty. Throws InputError: not at least two rows, columns of different
/// lengths, a number that is not finite, a time that does not grow.
PinLog pin_log(std::string name, std::vector<double> x, std::vector<double> y, std::vector<double> psi = {},
               std::vector<double> time = {});

}  // namespace rollfix
