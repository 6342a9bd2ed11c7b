#pragma once

// Random readings of one finger, most of them of the kinds that are easily got wrong.

#include <cmath>
#include <cstddef>
#include <vector>

#include "oracle/one_finger.hpp"
#include "oracle/shapes.hpp"

namespace oracle {

/// As the library gets it.
struct Reading {
  double length = 0;
  double turn = 0;
  double tolerance = 0;
};

class RandomReadings {
 public:
  RandomReadings(const Boundary& boundary, RandomShapes& random) : boundary_(boundary), random_(random) {}

  Reading reading() {
    const double length = this->length();
    return {length, turn(length), tolerance()};
  }

 private:
  double perimeter() const { return static_cast<double>(boundary_.perimeter()); }

  double tolerance() {
    static constexpr double kTolerances[] = {1e-9, 1e-9, 1e-9, 0, 1e-7, 1e-4, 0.02};
    return kTolerances[random_.whole(0, 6)];
  }

  double length() {
    const double P = perimeter();
    if (!boundary_.closed()) {
      return random_.chance(0.1) ? 0 : random_.uniform(-0.98, 0.98) * P;
    }
    switch (random_.whole(0, 9)) {
      case 0:
        return 0;
      case 1:
        return random_.whole(-2, 2) * P;
      case 2:
        return random_.whole(-12, 12) * P / random_.whole(2, 6);
      case 3:
        return P * random_.scaled(1e-9, 0.1) * (random_.chance(0.5) ? 1 : -1);
      case 4:
        return between_corners();
      case 5:
        return random_.uniform(-3, 3) * P;
      default:
        return random_.uniform(-1, 1) * P;
    }
  }

  double between_corners() {
    const auto& corners = boundary_.corners();
    if (corners.empty()) return random_.uniform(-1, 1) * perimeter();
    const auto any = [&] {
      return corners[static_cast<std::size_t>(random_.whole(0, static_cast<int>(corners.size()) - 1))].s;
    };
    return static_cast<double>(any() - any());
  }

  Real phi(Real s, Real length) const { return boundary_.contact(s + length).angle - boundary_.contact(s).angle; }

  Real start(Real length) {
    const Real P = boundary_.perimeter();
    if (boundary_.closed()) return random_.uniform(0, 1) * P;
    const Real lo = std::max<Real>(0, -length), hi = std::min(P, P - length);
    return random_.chance(0.1) ? hi : lo + random_.uniform(0, 1) * (hi - lo);
  }

  double turn(double length) {
    const Real from = start(length);
    switch (random_.whole(0, 9)) {
      case 0:  // what is felt if nothing is
        return static_cast<double>(std::round(phi(from, length) / kPi) * kPi);
      case 1:  // somewhere else, or nowhere
        return static_cast<double>(phi(from, length)) + random_.uniform(-1, 1);
      case 2:  // within a corner's pivot
        return corner_turn(length);
      case 3:
      case 4:
      case 5:
        return static_cast<double>(extremum(from, length)) +
               (random_.chance(0.5) ? 1 : -1) * random_.scaled(1e-13, 1e-6);
      default:
        return static_cast<double>(phi(from, length));
    }
  }

  double corner_turn(double length) {
    const auto& corners = boundary_.corners();
    if (corners.empty()) return static_cast<double>(phi(start(length), length));
    const Corner& corner = corners[static_cast<std::size_t>(random_.whole(0, static_cast<int>(corners.size()) - 1))];
    const Real from = random_.chance(0.5) ? corner.s : corner.s - length;
    const Real before =
        boundary_.contact(from + length, Side::before).angle - boundary_.contact(from, Side::before).angle;
    return static_cast<double>(before + random_.uniform(0, 1) * (phi(from, length) - before));
  }

  /// A value that phi takes without crossing it, near a place: by the golden section.
  Real extremum(Real near, Real length) {
    const Real sign = random_.chance(0.5) ? 1 : -1, golden = (std::sqrt(Real{5}) - 1) / 2;
    const Real reach = random_.scaled(0.005, 0.1) * perimeter();
    Real lo = near - reach, hi = near + reach;
    if (!boundary_.closed()) {
      lo = std::max({lo, Real{0}, -Real{length}});
      hi = std::min({hi, boundary_.perimeter(), boundary_.perimeter() - length});
    }
    const auto at = [&](Real share) { return lo + share * (hi - lo); };
    for (int round = 0; round < 60; ++round) {
      if (sign * phi(at(1 - golden), length) < sign * phi(at(golden), length)) {
        hi = at(golden);
      } else {
        lo = at(1 - golden);
      }
    }
    return phi(at(0.5L), length);
  }

  const Boundary& boundary_;
  RandomShapes& random_;
};

}  // namespace oracle
