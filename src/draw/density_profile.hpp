#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::draw {

/// A density on equal bins of a stretch of the boundary: what each holds, by its length. Points, as in corners, count
/// as well. `range`: as wide as the perimeter at most; of a closed boundary it may go on beyond P.
std::vector<double> binned(const Density& density, const Boundary& places, const Interval& range, std::size_t count);

/// The highest density in each of so many equal parts: a peak that is narrower than a part is as high as it is,
/// wherever it falls between two. What is held at a point, at a pivot, is spread over its part.
std::vector<double> highest(const Density& density, const Boundary& places, const Interval& range, std::size_t count);

/// The same smoothed by a normal distribution of this many bins' standard deviation; `around`: the last bin's neighbour
/// is the first.
std::vector<double> smoothed(const std::vector<double>& bins, double sd, bool around);

}  // namespace rollfix::draw
