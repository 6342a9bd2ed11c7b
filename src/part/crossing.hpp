#pragma once

#include <optional>

#include "rollfix/part/part.hpp"

namespace rollfix {

/// Two places on the boundary that share a point of the plane.
struct Crossing {
  double first = 0;  // arc lengths
  double second = 0;
  Vec2 point;
};

/// A place where the part's boundary crosses or touches itself, if there is one. Exhaustive: stretches are passed
/// over only when they turn too little to meet themselves, or when boxes around them are apart.
std::optional<Crossing> find_crossing(const Part& part);

}  // namespace rollfix
