#pragma once

#include <optional>

#include "rollfix/touch/touch.hpp"

namespace rollfix {

/// What a part does that touches on parallel straight sides leave free.
struct Slide {
  double direction = 0;  // along the sides, in the world, radians, in (-pi/2, pi/2]
  double length = 0;     // no two poses of the set are further apart; with noise, of its 95 % intervals
};

/// How a part slides from one pose of a continuum to another; none if it does not, or turns as well.
std::optional<Slide> slide_of(const TouchAnswer& answer, const TouchPose& pose);

}  // namespace rollfix
