#pragma once

#include <cstddef>
#include <vector>

#include "outline/box.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"

namespace rollfix::outline {

/// What joining curves asks of each of them.
struct CurveMeasure {
  Vec2 front;
  Vec2 back;
  Vec2 middle;            // at the middle of its parameter
  Box box;                // around points of it, its ends among them
  double length = 0;      // relative error 1e-12 or so
  double twice_area = 0;  // swept by the ray from its front, counter-clockwise
};

/// Length and area by quadrature; of a line directly. The box holds 17 points, not all of the curve.
CurveMeasure measure(const Curve& curve);

/// Points of a closed outline, for asking what lies inside.
struct Polygon {
  std::vector<Vec2> points;  // in order, the first not repeated
  Box box;

  /// Whether a point lies inside, by the number of sides that a ray to the right crosses. Of points on the boundary it
  /// may say either.
  bool contains(const Vec2& point) const;
};

/// 16 points for each curve, one for a line.
Polygon polygon_of(const Outline& outline);

/// Points sorted into clusters: two that are within `gap` of each other are in the same one, and so are those that are
/// linked by others in between.
class EndClusters {
 public:
  /// gap > 0. Linear in the number of points but for those that crowd together.
  EndClusters(const std::vector<Vec2>& points, double gap);

  /// The number of the cluster that holds this point.
  std::size_t of(std::size_t point) const { return cluster_[point]; }
  /// The points of a cluster, in rising order.
  const std::vector<std::size_t>& members(std::size_t cluster) const { return members_[cluster]; }

 private:
  std::vector<std::size_t> cluster_;
  std::vector<std::vector<std::size_t>> members_;
};

/// How a chain of curves leaves the node at one of its ends.
struct Departure {
  std::size_t node = 0;  // that it leaves
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
  std::size_t edge = 0;  // its number
  bool forward = true;   // from its front to its back
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

/// How deep each polygon lies inside others, by a point inside of it: one deeper than the smallest around it. By
/// falling area, so that none lies in one after it.
std::vector<int> nesting_depths(const std::vector<Polygon>& polygons);

}  // namespace rollfix::outline
