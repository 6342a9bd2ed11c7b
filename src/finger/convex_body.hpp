#pragma once

#include "rollfix/finger.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

/// The body of a finger that is no jaw, as it lies in the world: a disk, what a closed outline encloses, or the convex
/// hull of an open one.
class ConvexBody {
 public:
  ConvexBody(const Finger& finger, const Pose& pose) : finger_(finger), pose_(pose) {}

  /// The point that is farthest in this direction, radians; of several any.
  Vec2 farthest(double direction) const;

 private:
  /// The same in the finger's own frame: its support point.
  Vec2 farthest_in_frame(double direction) const;

  const Finger& finger_;  // has to outlive the body
  Pose pose_;             // of the finger's frame
};

/// By how much two of them have to be moved, at least, until they are apart; below 0 where they are: then less it is
/// enough that something separates them. `enough`: a depth of no more than this needs not be exact.
double depth_of_overlap(const ConvexBody& one, const ConvexBody& other, double enough);

/// How far apart two of them are, below 0 by how much they are in one another. `enough`: a distance of no less than
/// this needs not be exact.
double distance_between(const ConvexBody& one, const ConvexBody& other, double enough);

/// The depth as seen in one direction, radians, from the one to the other: no less than the depth; at or below 0 a line
/// across it separates them.
double depth_along(const ConvexBody& one, const ConvexBody& other, double direction);

/// The depth of a jaw in this pose, which has no ends, and a body; below 0 how far they are apart.
double depth_of_overlap(const Pose& jaw, const ConvexBody& other);

/// The same of any two fingers, each in its pose. Two jaws, which without ends would always meet, count as apart.
double depth_of_overlap(const Finger& one, const Pose& pose_of_one, const Finger& other, const Pose& pose_of_other,
                        double enough);

}  // namespace rollfix
