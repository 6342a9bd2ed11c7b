#pragma once

#include <string>

#include "hold/hold_cases.hpp"
#include "rollfix/files.hpp"

// Holds with noise on smooth parts, in which one mistake is planted.
namespace noisy_holds {

inline rollfix::Part smooth(int number) {
  return rollfix::load_part("gallery:spline,n=" + std::to_string(number % 2 == 0 ? 9 : 15) +
                            ",wobble=0.2,seed=" + std::to_string(number + 1));
}

/// Rolls of 12 % of the perimeter with 41 rows.
inline hold_cases::Holding noisy(bool centres) {
  hold_cases::Holding holding;
  holding.centres = centres;
  holding.length = 0.12;
  holding.contact_sd = holding.place_sd = 0.002;
  holding.angle_sd = 0.005;
  return holding;
}

}  // namespace noisy_holds
