#pragma once

#include <string>

#include "rollfix/belief/advise.hpp"
#include "rollfix/draw/svg.hpp"

namespace rollfix {

/// What is to be expected of rolling on: the placements that remain and the bits gained, by the roll's length, and the
/// roll that is advised.
struct AdviceFigure {
  Advice advice;
  std::string title;
  std::string outcome;
  double width = 640;  // pixels
};

Svg draw_advice(const AdviceFigure& figure);

}  // namespace rollfix
