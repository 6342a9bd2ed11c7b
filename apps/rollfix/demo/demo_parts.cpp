#include "rollfix/demo/demo_parts.hpp"

#include <fmt/format.h>

#include <array>

#include "rollfix/outline.hpp"

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

std::string plate_drawing() {
  struct Vertex {
    double x;
    double y;
    double bulge;  // of the side that starts here: the tangent of a quarter of the angle that it sweeps
  };
  constexpr double kQuarterTurn = 0.41421356237309503;
  constexpr std::array<Vertex, 7> kVertices = {{{0, 0, 0},
                                                {60, 0, kQuarterTurn},
                                                {70, 10, 0},
                                                {70, 25, kQuarterTurn},
                                                {55, 40, 0},
                                                {10, 40, kQuarterTurn},
                                                {0, 30, 0}}};
  std::string text = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
  text += fmt::format("0\nLWPOLYLINE\n8\nplate\n90\n{}\n70\n1\n", kVertices.size());
  for (const Vertex& vertex : kVertices) {
    text += fmt::format("10\n{}\n20\n{}\n42\n{}\n", vertex.x, vertex.y, vertex.bulge);
  }
  text += "0\nCIRCLE\n8\nplate\n10\n22\n20\n20\n40\n9\n";
  return text + "0\nENDSEC\n0\nEOF\n";
}

}  // namespace rollfix::app
