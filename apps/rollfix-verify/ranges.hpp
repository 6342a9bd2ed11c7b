#pragma once

#include <vector>

#include "along.hpp"

namespace rollfix_verify {

/// A roll from a start by the length asked, and how far its turn is off.
struct Row {
  Place start;
  Place end;
  Ball f;  // the turn along it less the one asked
  Taylor start_ahead;
  Taylor end_ahead;
};

/// What f is on all the starts from one row to the next.
struct Range {
  bool known = false;
  int slope = 0;  // +-1: f rises, falls all the way
  bool corner = false;
  std::vector<Ball> parts;  // f is in one of these at each start; several where it jumps at a concave corner
};

/// Whether the start or the end of the roll passes a corner from row to row.
bool spans_corner(const Boundary& boundary, const Row& from, const Row& to);

/// Bounds f from row to row. REQUIRES `to` ahead of `from`.
Range range_between(const Boundary& boundary, const Ball& turn, const Row& from, const Row& to);

}  // namespace rollfix_verify
