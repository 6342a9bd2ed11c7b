#pragma once

#include <vector>

#include "rollfix/advise.hpp"
#include "touch/likely_poses.hpp"
#include "touch/nearest.hpp"

namespace rollfix::advising {

using touch::LikelyPose;
using touch::NearestOfPart;
using touch::PartDistance;

/// A part as it may lie, by an answer that has to outlive it: its likely poses, and a circle around it in all of them.
class PartInPoses {
 public:
  PartInPoses(const TouchAnswer& answer, std::vector<LikelyPose> poses);

  const TouchAnswer& answer() const { return answer_; }
  const std::vector<LikelyPose>& poses() const { return poses_; }
  /// Distances to the part, in its own frame.
  PartDistance& part() { return part_; }
  /// The circle around the part in all poses, in the world: its middle and its radius.
  const Vec2& middle() const { return middle_; }
  double reach() const { return reach_; }
  /// Of the part from its frame's origin.
  double farthest() const { return farthest_; }

  /// A place of the world in the part's frame, and back; the frame is mirrored where the part lies face down.
  Vec2 in_part(const LikelyPose& one, const Vec2& at) const;
  Vec2 in_world(const LikelyPose& one, const Vec2& point) const { return one.pose.world(mirrored(point)); }
  /// A direction in the part's frame as the world sees it.
  Vec2 turned(const LikelyPose& one, const Vec2& along) const { return one.pose.turned(mirrored(along)); }

 private:
  Vec2 mirrored(const Vec2& point) const { return {answer_.mirrored ? -point.x() : point.x(), point.y()}; }

  const TouchAnswer& answer_;
  std::vector<LikelyPose> poses_;
  PartDistance part_;
  Vec2 middle_ = Vec2::Zero();
  double reach_ = 0;
  double farthest_ = 0;
};

/// Approaches where none are given. From outside, in all directions; of a hole from within.
std::vector<Approach> approaches_around(PartInPoses& lying);

/// A touch as it would be measured in a pose, and how well it is known beforehand.
struct Forecast {
  ExpectedTouch touch;
  double variance = 0;   // of the part's side across itself, from the pose's
  double incidence = 1;  // cosine of the way's angle with the normal
  /// of the normal, radians^2
  double turn_variance = 0;
};

/// What a touch would be in each pose of a part, and what it would tell of them.
class TouchGains {
 public:
  explicit TouchGains(PartInPoses& lying);

  std::vector<Forecast> forecasts(const Approach& approach);

  /// By how far the finger goes in each pose: quick, and right where no other side of the part is near.
  TouchGain rough(const Approach& approach);

  /// By how well the touch that one pose leads to fits the other one, on whatever side of it.
  TouchGain close(const Approach& approach);

  /// Until one pose is left.
  double bits_wanted() const;

 private:
  template <class Apart>
  TouchGain gain(const Approach& approach, const Apart& apart);
  NearestOfPart nearest_in(const LikelyPose& one, const Vec2& at);
  /// An upper bound of a side's variance across itself.
  double most_variance_of(const LikelyPose& one) const;
  double turn_variance_of(const LikelyPose& one, const NearestOfPart& nearest) const;
  /// d^2 of a touch from any side of another pose; of two touches: square_apart.
  double square_off(const Forecast& made, const LikelyPose& one);
  double square_of(double place, double variance, double turn, double turn_variance) const;
  /// d^2 of the touches that one way makes in two poses.
  double square_apart(const Forecast& a, const Forecast& b) const;
  /// Traces the way in one pose.
  Forecast forecast(const Approach& approach, const LikelyPose& one);
  void touches(const LikelyPose& one, const Vec2& along, const NearestOfPart& nearest, Forecast& result) const;

  PartInPoses& lying_;
  const TouchAnswer& answer_;
  const std::vector<LikelyPose>& poses_;
  PartDistance& part_;
  std::vector<double> share_of_set_;  // of each pose, in the set that it stands for
  /// the answer's touches have them, so that the next one does
  bool has_normals_ = false;
  /// of a measured place, length; turn_sd_: of a normal, radians
  double place_sd_ = 0;
  double turn_sd_ = 0;
};

}  // namespace rollfix::advising
