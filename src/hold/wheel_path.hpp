#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/part.hpp"
#include "touch/centre_path.hpp"
#include "touch/nearest.hpp"

namespace rollfix::hold {

/// The place of a wheel's pin, touching the part, that is nearest to a point of the part's frame.
struct NearPin {
  double distance = 0;            // of the point from it, above 0 off the part
  Vec2 away = Vec2::Zero();       // direction in which that grows
  Vec2 along = Vec2::Zero();      // unit vector along the path; zero at an end of it, where the wheel hits the part
  double s = 0;                   // where the wheel touches
  double angle = 0;               // of the tangent there; at a corner as the wheel pivots. Radians, of the first lap
  double turn_per_length = 0;     // how it changes as the pin goes along the path, ...
  double contact_per_length = 0;  // ... and how s does
};

/// A stretch of the path: where the wheel touches on it, and how the tangents point.
struct PinStretch {
  Interval s;
  Interval angle;
};

/// Where the pin of a wheel can be while it touches a part and enters it nowhere: the boundary's offset.
class WheelPath {
 public:
  WheelPath(const Part& part, double radius);
  WheelPath(const WheelPath&) = delete;
  WheelPath& operator=(const WheelPath&) = delete;

  bool is_empty() const { return path_.stretches().empty(); }
  double radius() const { return path_.radius(); }
  /// What Theta + s / r grows by around the part: an encoder sees it modulo this; 0 of an open part.
  double spin_period() const { return spin_period_; }
  /// All of the boundary.
  Interval whole() const { return path_.part().boundary().full_arc(); }

  NearPin nearest(const Vec2& point);
  /// The same, downhill from where another row's pin was, if that is near: of fits, which ask for it often.
  NearPin nearest(const Vec2& point, std::optional<touch::PathPlace>& from);
  /// All of the path within `reach` of a point, in pieces of about that length; nothing where they are too many.
  std::optional<std::vector<PinStretch>> within(const Vec2& point, double reach);

 private:
  touch::InPart seen(const Vec2& point) const;
  NearPin described(const Vec2& point, const touch::PathPlace& place) const;

  touch::CentrePath path_;
  std::optional<touch::PathTree> tree_;  // of a path that is not empty
  double unit_ = 1;
  double spin_period_ = 0;
};

}  // namespace rollfix::hold
