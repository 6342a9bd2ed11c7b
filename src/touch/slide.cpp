#include "rollfix/touch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "slide_bounds.hpp"

namespace rollfix {
namespace {

// Sides are parallel where they differ by no more than this, radians: so well the direction is known.
constexpr double kParallel = 0.01;
// A side is straight where it turns by no more than this over the part's perimeter, radians.
constexpr double kStraight = 1e-6;

/// An angle of a line: in (-pi/2, pi/2].
double of_line(double angle) {
  const double half = std::remainder(angle, std::numbers::pi);
  return half <= -0.5 * std::numbers::pi ? half + std::numbers::pi : half;
}

/// Without outliers.
std::vector<TouchContact> counted_contacts(const TouchAnswer& answer, const TouchPose& pose) {
  std::vector<TouchContact> contacts = pose.contacts;
  for (auto k = pose.outliers.rbegin(); k != pose.outliers.rend(); ++k) {
    contacts.erase(contacts.begin() + static_cast<std::ptrdiff_t>(answer.rolls.size() + *k));
  }
  return contacts;
}

}  // namespace

std::optional<Slide> slide_of(const TouchAnswer& answer, const TouchPose& pose) {
  if (!pose.continuum || pose.any_heading || pose.contacts.empty()) return std::nullopt;
  const Part& part = answer.part;
  const std::vector<TouchContact> contacts = counted_contacts(answer, pose);
  const double along = contacts.front().tangent;
  const bool are_parallel = std::all_of(contacts.begin(), contacts.end(), [&](const TouchContact& contact) {
    return std::abs(part.turning().at(contact.s).curvature) * part.perimeter() <= kStraight &&
           std::abs(of_line(contact.tangent - along)) <= kParallel;
  });
  if (!are_parallel) return std::nullopt;
  const std::array<Interval, 3>& range = answer.noise ? pose.interval : pose.extent;
  const double direction = of_line(pose.pose.heading + along);
  const double by_x = range[0].width() / std::abs(std::cos(direction));
  const double by_y = range[1].width() / std::abs(std::sin(direction));
  const double by_extent = std::min(by_x, by_y);
  if (!pose.outliers.empty()) return Slide{direction, by_extent};  // the other sides may let it go further
  return Slide{direction, std::min(by_extent, touch::slide_between_sides(answer, pose, direction).value_or(by_extent))};
}

}  // namespace rollfix
