#pragma once

#include <optional>

#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// How far apart poses of a set can be along a direction, where the touches are on straight sides whose directions
/// differ a little: these hold the part before any touch comes to the end of its side. Nothing where one may come
/// there, with noise, of a part face down or with rolls.
std::optional<double> slide_between_sides(const TouchAnswer& answer, const TouchPose& pose, double direction);

}  // namespace rollfix::touch
