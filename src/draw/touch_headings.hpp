#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/draw.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::draw {

/// Below the figure of touches, with noise: the density of the part's heading in the likeliest poses, each at its own
/// scale, with what holds 95 % of it shaded.
class HeadingDensities {
 public:
  HeadingDensities(const TouchAnswer& answer, double width);

  double height() const;  // pixels; 0: there is nothing to draw
  void draw(Svg& svg, double top) const;

 private:
  void draw_one(Svg& svg, std::size_t pose, const Vec2& corner, double width) const;

  const TouchAnswer& answer_;
  double width_;
  std::vector<std::size_t> shown_;
};

}  // namespace rollfix::draw
