#pragma once

// Random readings of two fingers that started somewhere, some of them where two pairs are about to become one or none.

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "oracle/shapes.hpp"
#include "oracle/two_fingers.hpp"
#include "rollfix/reading.hpp"

namespace oracle {

/// As the library gets it.
struct PairCase {
  Pair start{};
  std::vector<rollfix::Reading> readings;
  std::optional<double> facing;
  double tolerance = 0;

  PairQuestion question(Real doubt, Real least_tolerance) const {
    PairQuestion question;
    for (const auto& reading : readings)
      question.readings.push_back({reading.length[0], reading.length[1], reading.turn});
    if (facing) question.facing = *facing;
    question.tolerance = std::max<Real>(tolerance, least_tolerance);
    question.doubt = doubt;
    return question;
  }
};

class RandomPairCases {
 public:
  /// `is_drafted`: of lines and arcs.
  RandomPairCases(const Boundary& boundary, bool is_drafted, RandomShapes& random)
      : boundary_(boundary), is_drafted_(is_drafted), random_(random) {}

  PairCase pair_case() {
    static constexpr double kTolerances[] = {1e-9, 1e-9, 0, 1e-7};
    const double P = static_cast<double>(boundary_.perimeter());
    PairCase drawn;
    drawn.start = {random_.uniform(0, 1) * P, random_.uniform(0, 1) * P};
    drawn.tolerance = kTolerances[random_.whole(0, 3)];
    const bool faces = random_.chance(0.4);
    const int count = random_.whole(faces ? 1 : 2, faces ? 2 : 3);
    for (int k = 0; k < count; ++k)
      drawn.readings.push_back(reading(drawn.start, length(drawn.start[0]), length(drawn.start[1])));
    if (faces) {
      drawn.facing =
          static_cast<double>(boundary_.contact(drawn.start[0]).angle - boundary_.contact(drawn.start[1]).angle) +
          2 * std::numbers::pi * random_.whole(-2, 2);
    } else if (count == 2 && boundary_.closed() && random_.chance(0.4)) {
      touch(drawn);
    }
    if (random_.chance(0.1)) drawn.readings.back().turn += random_.uniform(-0.3, 0.3);  // from elsewhere, or nowhere
    if (is_drafted_) {  // there most starts leave a continuum
      for (auto& reading : drawn.readings) reading.turn += random_.uniform(-0.3, 0.3);
    }
    return drawn;
  }

 private:
  double length(Real start) {
    const double P = static_cast<double>(boundary_.perimeter());
    if (!boundary_.closed()) return static_cast<double>(random_.uniform(0.01, 0.99) * P - start);
    if (random_.chance(0.05)) return P / random_.whole(1, 4);
    return random_.uniform(-1.25, 1.25) * P;
  }

  rollfix::Reading reading(const Pair& start, double length_a, double length_b) const {
    const auto turn = [&](Real s, Real length) {
      return boundary_.contact(s + length).angle - boundary_.contact(s).angle;
    };
    return {length_a, length_b, static_cast<double>(turn(start[0], length_a) - turn(start[1], length_b))};
  }

  Real gain(Real s, Real length) const {
    return boundary_.curvature(boundary_.contact(s + length)) - boundary_.curvature(boundary_.contact(s));
  }

  /// Moves the last length until both curves touch at the start; then off by nothing or by little.
  void touch(PairCase& drawn) const {
    const Real s = drawn.start[0], t = drawn.start[1];
    const auto& first = drawn.readings[0];
    rollfix::Reading& second = drawn.readings[1];
    const auto determinant = [&](Real length_b) {
      return gain(s, second.length[0]) * gain(t, first.length[1]) - gain(s, first.length[0]) * gain(t, length_b);
    };
    Real lo = second.length[1], hi = lo + 0.3L * boundary_.perimeter();
    const bool rises = determinant(hi) > 0;
    if ((determinant(lo) > 0) == rises) return;
    for (int halving = 0; halving < 60; ++halving) {
      const Real middle = (lo + hi) / 2;
      ((determinant(middle) > 0) == rises ? hi : lo) = middle;
    }
    second = reading(drawn.start, second.length[0], static_cast<double>(lo));
    second.turn += (random_.chance(0.5) ? 1 : -1) * random_.scaled(1e-13, 1e-6);
  }

  const Boundary& boundary_;
  bool is_drafted_;
  RandomShapes& random_;
};

}  // namespace oracle
