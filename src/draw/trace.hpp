#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/part.hpp"

namespace rollfix::draw {

/// A boundary as a polyline that knows its arc length: all that a figure needs of a shape.
/// The first vertex is at s = 0, the last at s = length; on a closed one both are the same point.
struct Trace {
  std::vector<double> s;  // of each vertex, increasing
  std::vector<Vec2> points;
  bool closed = true;
  double length = 0;  // arc length of the true boundary, P

  Boundary boundary() const { return {length, closed}; }
};

/// Distance between a curve and its drawing that no eye sees, even at ten times the size: pixels.
constexpr double kInvisible = 0.03;

/// More vertices than this are too many for one drawing of a boundary; what they show is lost in its line's width.
constexpr std::size_t kMostVertices = 12000;

/// The part's boundary within `tolerance` (in the outline's unit), or as near to it as `most` vertices allow.
Trace trace(const Part& part, double tolerance, std::size_t most = kMostVertices);

/// The vertices to keep so that the polyline moves by no more than `tolerance`; the first and the last stay.
std::vector<std::size_t> simplify(const std::vector<Vec2>& points, double tolerance);

/// As above with at most about `most` vertices: the tolerance grows until they suffice.
std::vector<std::size_t> simplify(const std::vector<Vec2>& points, double tolerance, std::size_t most);

/// The points at these indices.
std::vector<Vec2> pick(const std::vector<Vec2>& points, const std::vector<std::size_t>& indices);

/// Position at arc length s; any s when closed, clamped when open.
Vec2 point_at(const Trace& trace, double s);

/// Direction (unit vector) of the polyline's edge just after s, or just before it.
Vec2 direction_at(const Trace& trace, double s, Side side = Side::after);

/// The stretch from lo to hi, lo <= hi, as an open trace whose `s` runs from lo to hi. On a closed trace both may
/// be anywhere and the stretch may go round more than once.
Trace slice(const Trace& trace, double lo, double hi);

/// The same polyline with no edge longer than `step`.
Trace densify(const Trace& trace, double step);

}  // namespace rollfix::draw
