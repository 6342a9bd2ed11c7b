#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix {

/// How a chain of curves leaves the node at one of its ends.
struct Departure {
  std::size_t node = 0;
  double heading = 0;    // of its tangent away from the node, radians
  double curvature = 0;  // positive where it turns left on leaving
};

/// A chain of curves between two nodes of a plane graph.
struct Edge {
  Departure front;
  Departure back;
  std::vector<Vec2> points;  // on it from front to back, its ends among them
};

/// The curves follow one another from the node `front` to the node `back`.
Edge edge_along(const std::vector<Curve>& curves, std::size_t front, std::size_t back);

/// An edge as it is passed through.
struct Passage {
  std::size_t edge = 0;
  bool forward = true;
};

/// A connected piece of a plane graph.
struct Face {
  std::vector<std::size_t> edges;           // all that hang together, in rising order
  std::vector<std::vector<Passage>> loops;  // around the outside, each counter-clockwise; none: it is no loop
  bool encloses = false;                    // whether anything is left without loose ends
};

/// The outer face of each connected piece. Edges that lead nowhere (leaders, construction lines) are no part of it. One
/// edge at the outside is followed by the one that turns rightmost, until the first comes again; where that passes a
/// node twice it is more than one loop, and where it passes an edge twice that is a bridge between two. What comes out
/// is held against the points of all other edges, so that edges which cross without a node give no wrong face.
std::vector<Face> outer_faces(const std::vector<Edge>& edges, std::size_t nodes);

}  // namespace rollfix
