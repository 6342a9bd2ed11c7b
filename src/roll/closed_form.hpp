#pragma once

#include <cstdint>

#include "roll/track.hpp"

namespace rollfix {

/// Where a finger's contact is when the finger has turned so far.
struct Walked {
  double s = 0;
  double angle = 0;         // of the tangent, Theta
  double per_rotation = 0;  // ds per angle that the finger turns by; 0 while it pivots at a corner
};

/// Goes along a finger's track to where the finger has turned by a given amount: the inverse of Track::rotation.
class Walk {
 public:
  /// On the stretch with this index.
  Walk(const Track& track, std::int64_t index) : track_(track) { enter(index); }

  /// Throws InputError where the finger can't turn so far (Track::refuse); it can be asked for less then.
  Walked to(double rotation);

 private:
  void enter(std::int64_t index);
  void go(int direction);
  Walked solve(double rotation) const;

  const Track& track_;
  double fallen_ = 0;  // over the tiny concave joints of a drawing the finger turns back: by so much psi is behind
  std::int64_t index_ = 0;
  Stretch stretch_;
  Interval rotation_;
};

}  // namespace rollfix
