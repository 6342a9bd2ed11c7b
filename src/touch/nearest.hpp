#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "measured.hpp"
#include "path_tree.hpp"

namespace rollfix::touch {

/// A touch as the part's frame sees it, in some pose.
struct InPart {
  Vec2 at = Vec2::Zero();
  bool has_place = true;
  std::optional<double> tangent{};
  double place_unit = 1;
  double angle_unit = 1;
};

/// How far a place is from a touch: the sum of squares of its residuals, and its derivatives by u.
struct Distance {
  double square = 0;
  double slope = 0;   // half the derivative of it, with its sign: above 0 where it falls with u
  double weight = 0;  // half the second derivative, but for ...
  double bend = 0;    // ... what the path's bends add to it, if they are those of a circle
};
Distance distance_at(const CentrePoint& point, const InPart& touch);

/// No place of a node has a smaller sum of squares.
double least_square(const PathTree::Node& node, const InPart& touch);

/// A place of the path, and what is there.
struct OnPath {
  PathPlace place;
  CentrePoint point;
};

/// The nearest place to be found by going downhill from this one, from stretch to stretch.
OnPath downhill(const CentrePath& path, const InPart& touch, OnPath from);

/// The nearest of all places. Branch and bound.
OnPath nearest_place(PathTree& tree, const InPart& touch);

/// The nearest of all places if it is nearer than this one, by more than rounding: nothing if none is.
std::optional<OnPath> nearer_place(PathTree& tree, const InPart& touch, const OnPath& than);

}  // namespace rollfix::touch
