#pragma once

#include <vector>

#include "rollfix/advise.hpp"
#include "touch/likely_poses.hpp"
#include "touch/nearest.hpp"

namespace rollfix::touch {

/// A part as it may lie, by an answer that has to outlive it: its likely poses, and a circle around it in all of them.
class PartInPoses {
 public:
  PartInPoses(const TouchAnswer& answer, std::vector<LikelyPose> poses);

  const TouchAnswer& answer() const { return answer_; }
  const std::vector<LikelyPose>& poses() const { return poses_; }
  PartDistance& part() { return part_; }
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

}  // namespace rollfix::touch
