#pragma once

#include <array>

namespace rollfix {

/// Lengths that were given in another unit: by what they are to be multiplied, the unit that they are in, and the
/// part's.
struct MistakenUnit {
  double factor;
  const char* from;
  const char* to;
};
inline constexpr std::array<MistakenUnit, 6> kMistakenUnits = {{{25.4, "in", "mm"},
                                                                {1 / 25.4, "mm", "in"},
                                                                {10, "cm", "mm"},
                                                                {0.1, "mm", "cm"},
                                                                {1000, "m", "mm"},
                                                                {0.001, "mm", "m"}}};

}  // namespace rollfix
