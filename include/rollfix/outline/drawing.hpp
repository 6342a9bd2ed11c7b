#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// Where in its file a curve of a drawing stands.
struct Origin {
  std::string entity;    // what the file calls it: "ARC", "path"
  std::string layer;     // of a DXF; the id of an SVG element; empty where there is none
  std::size_t line = 0;  // counted from 1; of a binary file the byte
};

/// A smooth curve of a drawing. A circle or another closed smooth curve is one curve that ends where it starts.
struct DrawnCurve {
  Curve curve;
  Origin origin;
};

/// What a file draws: curves in the file's order, each in the file's direction, not yet joined (see loops). The curves
/// of one polyline, spline or path stand next to each other.
struct Drawing {
  std::string name;                // what the user calls the file
  std::string unit;                // "mm", "in", ...; empty where the file does not say
  std::vector<DrawnCurve> curves;  // in the file's own unit
  std::vector<std::string> notes;  // all that was left out or flattened, with counts: for the user to read
};

}  // namespace rollfix
