#pragma once

#include <string>

namespace rollfix {

/// What follows the last dot of the file's name, in lower case: ".csv"; empty when there is none.
std::string ending_of(const std::string& path);

/// "{path}: has the unknown ending '.step', expected {known}", and what gallery shape may have been meant.
std::string unknown_ending(const std::string& path, const std::string& known);

}  // namespace rollfix
