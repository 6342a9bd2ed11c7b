#pragma once

#include <cstddef>
#include <vector>

#include "cell_sets.hpp"
#include "pose_fit.hpp"

namespace rollfix::touch {

/// Squares that exceed the least known by more are worth exp(-25) of it: what has them is not looked at closely.
inline constexpr double kHopeless = 50;

/// Of each group of cells whether its component fits so badly, next to the best, that it has no probability to speak
/// of. Each is started from in its middle, and those that seem to from more and more cells.
std::vector<bool> hopeless_groups(PoseFit& fit, const CellSets& sets, std::size_t first_touch);

}  // namespace rollfix::touch
