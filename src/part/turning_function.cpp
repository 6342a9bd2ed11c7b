#include "rollfix/part/turning_function.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix {

std::size_t TurningFunction::spiral_at(double base, Side side) const {
  const auto after = side == Side::after
                         ? std::upper_bound(spirals_.begin(), spirals_.end(), base,
                                            [](double value, const Spiral& spiral) { return value < spiral.lo; })
                         : std::lower_bound(spirals_.begin(), spirals_.end(), base,
                                            [](const Spiral& spiral, double value) { return spiral.lo < value; });
  return after == spirals_.begin() ? 0 : static_cast<std::size_t>(after - spirals_.begin()) - 1;
}

Turning TurningFunction::at(double s, Side side) const {
  const Wrapped place = boundary().reduced(s, side);
  Turning turning = on_spiral(spirals_[spiral_at(place.base, side)], place.base);
  if (closed_) turning.angle += place.winding * period_turn_;
  return turning;
}

std::uint32_t TurningFunction::middle_panel(const Spiral& spiral, double base) const {
  const auto first = panels_.begin() + spiral.first_panel;
  const auto last = panels_.begin() + spiral.last_panel;
  const auto found =
      std::upper_bound(first, last, base, [](double value, const Panel& panel) { return value < panel.hi; });
  return static_cast<std::uint32_t>(found - first);
}

Powers TurningFunction::expand(const Panel& panel, double middle, double half) const {
  const auto count = static_cast<Eigen::Index>(panel.count);
  Powers powers(count);
  for (Eigen::Index k = 0; k < count; ++k) powers[k] = coefficients_[panel.offset + static_cast<std::size_t>(k)][0];
  const double centre = (middle - panel.middle) * panel.inverse_half;
  for (Eigen::Index first = 0; first + 1 < count; ++first) {  // Horner's scheme, repeated: x = centre + ...
    for (Eigen::Index k = count - 2; k >= first; --k) powers[k] += centre * powers[k + 1];
  }
  const double ratio = half * panel.inverse_half;  // ... + ratio * y
  double scale = 1;
  for (Eigen::Index k = 0; k < count; ++k, scale *= ratio) powers[k] *= scale;
  return powers;
}

}  // namespace rollfix
