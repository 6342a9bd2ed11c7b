#pragma once

#include <functional>
#include <vector>

#include "rollfix/curve.hpp"

/// Images of shapes, for tests of scans.
namespace pixels {

/// The boundary of the unit pixels whose centres are inside a shape around the origin: every pixel corner on the way,
/// counter-clockwise, as one who traces an image gets it. The shape's pixels must hang together by their edges.
inline std::vector<rollfix::Vec2> boundary(const std::function<bool(const rollfix::Vec2&)>& is_inside, int half_width) {
  const auto pixel = [&](int x, int y) { return is_inside({x + 0.5, y + 0.5}); };
  int x = -half_width;
  int y = -half_width;
  while (!pixel(x, y)) {  // the leftmost pixel of the lowest row: its lower edge belongs to the boundary
    if (++x < half_width) continue;
    x = -half_width;
    ++y;
  }
  const int first_x = x;
  const int first_y = y;
  int dx = 1;
  int dy = 0;
  std::vector<rollfix::Vec2> points;
  do {
    points.emplace_back(x, y);
    x += dx;
    y += dy;
    // The pixels ahead, to the left and to the right of the way.
    const auto ahead = [&](int side_x, int side_y) {
      return pixel(x + (dx + side_x > 0 ? 0 : -1), y + (dy + side_y > 0 ? 0 : -1));
    };
    const int old_dx = dx;
    if (ahead(dy, -dx)) {
      dx = dy;
      dy = -old_dx;
    } else if (!ahead(-dy, dx)) {
      dx = -dy;
      dy = old_dx;
    }
  } while (x != first_x || y != first_y);
  return points;
}

}  // namespace pixels
