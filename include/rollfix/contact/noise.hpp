#pragma once

#include <array>

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

namespace rollfix {

/// How far sensors are off: standard deviations.
struct Noise {
  double contact = 0;  // of a contact's place along the outline, in its unit, each row on its own
  double angle = 0;    // of a turn, radians: each row on its own, and of a gyroscope's drift over the whole roll
  double slip = 0;     // of the length travelled, per length
  double radius = 0;   // of the finger's radius, in the outline's unit
};

/// One of them: what it is called, wherever users read or type it, and in what it is measured.
struct NoiseKind {
  enum class Unit { length, angle, per_length };
  const char* name;
  double Noise::*sd;
  Unit unit;
};
inline constexpr std::array<NoiseKind, 4> kNoiseKinds = {{{"contact", &Noise::contact, NoiseKind::Unit::length},
                                                          {"angle", &Noise::angle, NoiseKind::Unit::angle},
                                                          {"slip", &Noise::slip, NoiseKind::Unit::per_length},
                                                          {"radius", &Noise::radius, NoiseKind::Unit::length}}};

/// Throws InputError: a standard deviation that is not a finite number of at least 0.
void require_valid(const Noise& noise);

}  // namespace rollfix
