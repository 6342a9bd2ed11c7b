#pragma once

#include <vector>

#include "rollfix/part/part.hpp"

namespace rollfix {

/// Where the curvature changes sign. On a straight stretch between bends of opposite sign: its middle.
std::vector<double> find_inflections(const TurningFunction& turning);

/// Where the curvature, itself continuous, turns from rising to falling or back.
std::vector<double> find_vertices(const TurningFunction& turning, const std::vector<Corner>& corners);

}  // namespace rollfix
