#pragma once

// Curves for the tests of the march, defined here so that their derivatives are in plain sight.

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "rollfix/outline.hpp"

namespace march_shapes {

using rollfix::Curve;
using rollfix::Interval;
using rollfix::Jet;
using rollfix::Outline;
using rollfix::Vec2;

constexpr double kPi = std::numbers::pi;

/// amplitude * cos(frequency * u + phase)
struct Harmonic {
  double amplitude;
  double frequency;
  double phase;

  /// Value and derivatives up to the third.
  std::array<double, 4> at(double u) const {
    const double value = amplitude * std::cos(frequency * u + phase);
    const double first = -amplitude * frequency * std::sin(frequency * u + phase);
    const double square = frequency * frequency;
    return {value, first, -square * value, -square * first};
  }
};

/// (x, y), each a constant plus harmonics: ellipses, limacons, and anything smooth.
struct Trigonometric {
  std::vector<Harmonic> x;
  std::vector<Harmonic> y;
  Interval range{0, 2 * kPi};

  Interval domain() const { return range; }
  Jet jet(double u) const {
    std::array<Vec2, 4> sum{Vec2::Zero(), Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
    const auto add = [&](const std::vector<Harmonic>& terms, int axis) {
      for (const Harmonic& term : terms) {
        const std::array<double, 4> values = term.at(u);
        for (std::size_t order = 0; order < 4; ++order) sum[order][axis] += values[order];
      }
    };
    add(x, 0);
    add(y, 1);
    return {sum[0], sum[1], sum[2], sum[3]};
  }
};

/// r(u) = radius + harmonics, in polar coordinates.
inline Trigonometric polar(double radius, const std::vector<Harmonic>& waves, Interval range = {0, 2 * kPi}) {
  Trigonometric curve{{{radius, 1, 0}}, {{radius, 1, -kPi / 2}}, range};
  for (const Harmonic& wave : waves) {  // 2 cos(a) cos(b) = cos(a + b) + cos(a - b), and so for the sine
    const double half = wave.amplitude / 2;
    curve.x.push_back({half, wave.frequency + 1, wave.phase});
    curve.x.push_back({half, wave.frequency - 1, wave.phase});
    curve.y.push_back({half, wave.frequency + 1, wave.phase - kPi / 2});
    curve.y.push_back({half, wave.frequency - 1, wave.phase + kPi / 2});
  }
  return curve;
}

inline Outline outline_of(const char* name, Curve curve, bool closed = true) {
  return {name, {std::move(curve)}, closed, false};
}

inline Outline ellipse(double a, double b) {
  return outline_of("ellipse", Trigonometric{{{a, 1, 0}}, {{b, 1, -kPi / 2}}});
}

/// r = a + b cos u: convex for a >= 2b, dimpled for b < a < 2b.
inline Outline limacon(double a, double b) { return outline_of("limacon", polar(a, {{b, 1, 0}})); }

/// A convex curve without any symmetry.
inline Outline egg() { return outline_of("egg", polar(1, {{0.2, 1, 0.3}, {0.05, 2, 1.1}, {0.015, 3, 0.4}})); }

/// A wavy curve without any symmetry: `lobes` bumps and dents.
inline Outline amoeba(double wave = 0.09, double lobes = 5) {
  return outline_of("amoeba", polar(1, {{wave, lobes, 0.2}, {0.12, 2, 1.0}, {0.05, 3, 2.2}}));
}

/// A periodic cubic spline through points on a wavy circle.
inline Outline random_spline(std::mt19937_64& generator, int points = 12, double wobble = 0.25) {
  std::uniform_real_distribution<double> radius(1 - wobble, 1 + wobble);
  std::vector<Vec2> corners;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * kPi * i / points;
    corners.emplace_back(Vec2(std::cos(angle), std::sin(angle)) * radius(generator));
  }
  return {"spline", rollfix::spline_through(corners, true, kPi), true, false};
}

/// An open wavy arc.
inline Outline open_wave() {
  return outline_of("open wave", polar(1, {{0.1, 4, 0.7}, {0.07, 2.3, 0.1}}, {0.1, 4.5}), false);
}

}  // namespace march_shapes
