#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "rollfix/contact/noise.hpp"

namespace rollfix::app {

/// Adds --noise to a command.
void add_noise_argument(CLI::App& command, std::string& noise);

/// What was typed: "contact=SD,angle=SD,slip=PER_LENGTH,radius=SD", any of them; nothing when empty.
/// Throws InputError: another name, one given twice, or not a number of at least 0.
std::optional<Noise> read_noise(const std::string& text);

}  // namespace rollfix::app
