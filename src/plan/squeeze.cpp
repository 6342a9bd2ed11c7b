#include "plan/squeeze.hpp"

#include <cmath>
#include <numbers>

namespace rollfix {
namespace {

double angle_of(const Vec2& vector) { return std::atan2(vector.y(), vector.x()); }

double angle_between(double from, double to) { return std::remainder(to - from, 2 * std::numbers::pi); }

Vec2 outward_at(const ContactPlace& place) { return {std::sin(place.angle), -std::cos(place.angle)}; }

double gap_to_jaw(const ContactPlace& jaw, const ContactPlace& disk, double radius) {
  return -(disk.centre - jaw.point).dot(outward_at(jaw)) - radius;
}

}  // namespace

Squeeze squeeze_of(const ContactPlace& a, const ContactPlace& b, bool expanding) {
  // Two fingers at one place press nothing together: as if they pulled.
  if (a.point == b.point) return {std::numbers::pi, std::numbers::pi, 0};
  const Vec2 to_b = expanding ? Vec2(a.point - b.point) : Vec2(b.point - a.point);
  const double line = angle_of(to_b);
  return {angle_between(a.inward(), line), angle_between(b.inward(), line + std::numbers::pi), to_b.norm()};
}

std::optional<double> gap_between(const Finger& finger_a, const ContactPlace& a, const Finger& finger_b,
                                  const ContactPlace& b) {
  if (finger_a.is_disk() && finger_b.is_disk()) {
    return (a.centre - b.centre).norm() - finger_a.disk()->radius - finger_b.disk()->radius;
  }
  if (finger_a.is_jaw() && finger_b.is_disk()) return gap_to_jaw(a, b, finger_b.disk()->radius);
  if (finger_a.is_disk() && finger_b.is_jaw()) return gap_to_jaw(b, a, finger_a.disk()->radius);
  return std::nullopt;
}

}  // namespace rollfix
