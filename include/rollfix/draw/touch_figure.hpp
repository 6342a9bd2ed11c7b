#pragma once

#include <string>
#include <vector>

#include "rollfix/draw/svg.hpp"
#include "rollfix/outline/outline.hpp"
#include "rollfix/touch/next_touch.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix {

/// The world: the part in each pose that touches leave (the likeliest drawn strong, up to six), the touches as dots
/// with their normals, and the finger around them.
struct TouchFigure {
  const TouchAnswer* answer = nullptr;  // not owned; required
  std::string title{};                  // empty: the part's name
  double width = 640;                   // pixels
  std::vector<Outline> others{};        // of a drawing: its other loops, drawn thin in the likeliest pose
  const NextTouch* next = nullptr;      // the advised approach is drawn as well; not owned
};

/// Throws InputError: no answer.
Svg draw_touches(const TouchFigure& figure);

}  // namespace rollfix
