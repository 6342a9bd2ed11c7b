#include "rollfix/outline/outline.hpp"

namespace rollfix {

Outline reversed(const Outline& outline) {
  Outline result;
  result.name = outline.name;
  result.closed = outline.closed;
  result.reversed = !outline.reversed;
  result.hole = outline.hole;
  result.gallery = outline.gallery;
  result.gap = outline.gap;
  result.curves.reserve(outline.curves.size());
  // A closed outline's first point is also the end of its last curve, and so stays the first point.
  for (auto curve = outline.curves.rbegin(); curve != outline.curves.rend(); ++curve) {
    result.curves.push_back(reversed(*curve));
  }
  return result;
}

}  // namespace rollfix
