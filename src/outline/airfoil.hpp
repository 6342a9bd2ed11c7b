#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// Points with the lines of the file that they came from.
struct NumberedPoints {
  std::vector<Vec2> points;
  std::vector<std::size_t> lines;
  bool has_title = false;
};

/// Airfoil files come in two orders. Selig's is the points of one loop, from the trailing edge over the top to the nose
/// and back below. Lednicer's has a line with the numbers of points above and below, then both surfaces from the nose
/// to the trailing edge.
///
/// Brings Lednicer's order into Selig's and returns a note that says which order was found; empty when the points are
/// none of both. Lednicer's is what starts with two whole numbers above 1 that are the numbers of points in the two
/// blocks that follow, whose first points are the same; Selig's (for the note only: nothing is changed) what has a
/// title, a chord of 1, and x that falls and then rises.
/// Throws InputError naming the line: what looks like Lednicer's order, with counts that do not match or blocks that do
/// not start at the same point.
std::string order_airfoil(NumberedPoints& data, const std::string& name);

}  // namespace rollfix
