#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "rollfix/belief.hpp"

namespace rollfix::app {

/// What is known of how the part lies, as typed: at most one of both.
struct PoseArguments {
  std::string heading;
  std::string pose;
};

/// Adds --heading and --pose.
void add_pose_arguments(CLI::App& command, PoseArguments& arguments);

/// --heading or --pose as typed. Throws InputError.
std::optional<PosePrior> read_pose(const PoseArguments& arguments, const std::string& unit);

}  // namespace rollfix::app
