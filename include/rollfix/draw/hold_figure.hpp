#pragma once

#include <string>
#include <vector>

#include "rollfix/draw/svg.hpp"
#include "rollfix/hold/hold.hpp"
#include "rollfix/outline/outline.hpp"

namespace rollfix {

/// The world: the part at the last instant in each placement (the likeliest drawn strong, up to six), where it was at
/// the first one in the likeliest, and the ways of the fingers' centres with the fingers where they are at the end.
struct HoldFigure {
  const HoldAnswer* answer = nullptr;  // not owned; required
  std::string title{};                 // empty: the part's name
  double width = 640;                  // pixels
  std::vector<Outline> others{};       // of a drawing: its other loops, drawn thin in the likeliest placement
};

/// Throws InputError: no answer.
Svg draw_hold(const HoldFigure& figure);

}  // namespace rollfix
