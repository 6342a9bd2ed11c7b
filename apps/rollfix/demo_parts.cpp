#include "rollfix/demo_parts.hpp"

#include <fmt/format.h>

#include "rollfix/outline/gallery.hpp"

namespace rollfix::app {

std::string wing_points() {
  constexpr int kPointsPerCurve = 20;
  std::string text = "# NACA 2412 with a closed trailing edge, chord 200\nx,y\n";
  for (const Curve& curve : gallery("naca,digits=2412,chord=200").curves) {
    const Interval domain = curve.domain();
    for (int i = 0; i < kPointsPerCurve; ++i) {
      const Vec2 point = curve.position(domain.lo + domain.width() * i / kPointsPerCurve);
      text += fmt::format("{:.4f},{:.4f}\n", point.x(), point.y());
    }
  }
  return text;
}

}  // namespace rollfix::app
