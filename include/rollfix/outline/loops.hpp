#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/outline/curve.hpp"
#include "rollfix/outline/outline.hpp"

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

/// Ends of curves closer together than this share of the drawing's diagonal meet, unless the user says otherwise.
inline constexpr double kGapShare = 1e-6;

struct LoopOptions {
  std::optional<double> gap;  // a length: ends this close together meet; default: kGapShare of the diagonal
  bool outer = false;         // where more than two ends meet: take what is around the outside
};

/// Curves of a drawing joined end to end.
struct Loop {
  Outline outline;        // starts with its first curve in the file, in that curve's direction
  std::size_t first = 0;  // that curve's number in the drawing
  double length = 0;      // of all its curves, to kLengthAccuracy or so
  double area = 0;        // closed: enclosed, above 0 whichever way it runs
  int depth = 0;          // closed: inside how many other closed loops it lies; odd: a hole
  double gap = 0;         // the largest between neighbouring curves; open: not the one between its two ends

  /// Whether the gap is more than rounding.
  bool has_gap() const { return gap > 1e-9 * length; }
};

struct Loops {
  std::vector<Loop> closed;        // by falling area: the first is the outer one
  std::vector<Loop> open;          // by falling length
  std::vector<std::string> notes;  // what was left out: curves drawn twice, curves without length, chains that branch
  std::string doubt;               // why the first of them may not be the outer one: a chain around it branches
};

/// Joins a drawing's curves, whatever their order and direction, where ends meet within the gap. Where more than two
/// ends meet, the curves that hang together there are left out, and a note says where that is; with `outer` those of
/// them that are around the outside are a loop, and leaders and construction lines are left out. Throws InputError: no
/// curves, or none but such as branch (with the place).
Loops loops(const Drawing& drawing, const LoopOptions& options = {});

/// The area that a closed outline encloses, above 0 whichever way it runs; relative error 1e-11 or so.
double enclosed_area(const Outline& outline);

}  // namespace rollfix
