#pragma once

#include <cstddef>
#include <numbers>
#include <vector>

#include "belief/error_model.hpp"
#include "belief/tilted_boundary.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/part.hpp"

// The fingers' centres in the world as evidence: they go along the part's offset curve.
namespace rollfix::belief {

inline constexpr double kHalfTurn = std::numbers::pi;

/// Positions along the boundary as a table: cubics between places so close together that they are as good as the
/// outline.
class BoundaryPath {
 public:
  explicit BoundaryPath(const Part& part);

  /// Any s on a closed boundary; beyond an open one's ends it goes on straight.
  Vec2 at(double s) const;

 private:
  struct Cell {
    double s;
    double length;
    Vec2 from;
    Vec2 to;
    Vec2 by_from;  // derivatives by the share of the cell
    Vec2 by_to;
  };

  bool closed_;
  double perimeter_;
  std::vector<Cell> cells_;
  Buckets buckets_;
};

/// What a row says of a finger's centre.
struct FeltCentre {
  Vec2 centre = Vec2::Zero();  // in the world
  Arm arm;                     // from it to the contact
};

/// What all hypotheses about one finger's roll have in common.
struct CentreModel {
  const Part* part = nullptr;
  const BoundaryPath* path = nullptr;  // where centres are evidence
  bool has_place = false;              // the centre was felt; else only the normal
  FeltCentre first;
  double facing = 0;        // N(u) + psi at the first contact, radians
  double variance = 0;      // of a coordinate, each row on its own; 0: they are no evidence, but tell the pose
  double radius_share = 0;  // of the variance of the scale of lengths, as far as it is a wrong radius
};

}  // namespace rollfix::belief
