#pragma once

#include <string>

namespace rollfix {

/// "{path}: has the unknown ending '.step', expected {known}", and what gallery shape may have been meant.
std::string unknown_ending(const std::string& path, const std::string& known);

}  // namespace rollfix
