#include "plan/squeeze.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "finger/convex_body.hpp"

namespace rollfix {
namespace {

double angle_of(const Vec2& vector) { return std::atan2(vector.y(), vector.x()); }

double angle_between(double from, double to) { return std::remainder(to - from, 2 * std::numbers::pi); }

Vec2 outward_at(const ContactPlace& place) { return {std::sin(place.angle), -std::cos(place.angle)}; }

double of_disk_and_jaw(const ContactPlace& jaw, const ContactPlace& disk, double radius) {
  return -(disk.centre - jaw.point).dot(outward_at(jaw)) - radius;
}

Pose frame_at(const ContactPlace& place) { return {place.centre.x(), place.centre.y(), place.contact.psi}; }

/// What of a finger's body is farthest from where it touches, at most; how far a disk is, its centre tells.
double arm_of(const Finger& finger) {
  if (finger.is_disk()) return finger.disk()->radius;
  return finger.outline()->closed() ? finger.outline()->perimeter() / 2 : finger.outline()->perimeter();
}

/// A finger that rolls turns about its contact, which is somewhere on it.
double moved(const Finger& finger, const ContactPlace& from, const ContactPlace& to) {
  return arm_of(finger) * std::abs(to.turned - from.turned);
}

/// Of a body seen from a jaw, which turns and goes along the part.
double change_at_jaw(const ContactPlace& jaw, const ContactPlace& next_jaw, const Finger& body,
                     const ContactPlace& from, const ContactPlace& to) {
  const double turn = std::abs(next_jaw.turned - jaw.turned);
  const double along = std::abs(next_jaw.s - jaw.s);
  const double by = moved(body, from, to);
  const double away =
      body.is_disk() ? (from.centre - jaw.point).norm() : (from.point - jaw.point).norm() + arm_of(body);
  return (away + along + by) * turn + along * std::min(1.0, turn) + by;
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
                                  const ContactPlace& b, double enough) {
  if (finger_a.is_jaw() && finger_b.is_jaw()) return std::nullopt;
  if (finger_a.is_disk() && finger_b.is_disk()) {
    return (a.centre - b.centre).norm() - finger_a.disk()->radius - finger_b.disk()->radius;
  }
  if (finger_a.is_jaw() && finger_b.is_disk()) return of_disk_and_jaw(a, b, finger_b.disk()->radius);
  if (finger_a.is_disk() && finger_b.is_jaw()) return of_disk_and_jaw(b, a, finger_a.disk()->radius);
  const ConvexBody of_a(finger_a, frame_at(a));
  const ConvexBody of_b(finger_b, frame_at(b));
  if (finger_a.is_jaw()) return -depth_of_overlap(frame_at(a), of_b);
  if (finger_b.is_jaw()) return -depth_of_overlap(frame_at(b), of_a);
  const double straight = -depth_along(of_a, of_b, angle_of(b.point - a.point));
  return straight >= enough ? straight : distance_between(of_a, of_b, enough);
}

double gap_change(const Finger& finger_a, const ContactPlace& a, const ContactPlace& next_a, const Finger& finger_b,
                  const ContactPlace& b, const ContactPlace& next_b) {
  if (finger_a.is_jaw() && finger_b.is_jaw()) return 0;
  if (finger_a.is_jaw()) return change_at_jaw(a, next_a, finger_b, b, next_b);
  if (finger_b.is_jaw()) return change_at_jaw(b, next_b, finger_a, a, next_a);
  return moved(finger_a, a, next_a) + moved(finger_b, b, next_b);
}

double size_of(const Finger& finger) {
  if (finger.is_disk()) return finger.disk()->radius;
  return finger.is_jaw() ? 0 : finger.outline()->perimeter() / (2 * std::numbers::pi);
}

}  // namespace rollfix
