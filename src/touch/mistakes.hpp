#pragma once

#include <array>
#include <vector>

#include "measured.hpp"
#include "rollfix/touch.hpp"

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

namespace rollfix::touch {

/// An explanation fits where chi-square is no less likely than this.
inline constexpr double kExplains = 0.01;

/// `solve` of a valid problem, without looking for mistakes.
TouchAnswer solve_plain(const TouchProblem& problem);

/// The usual mistakes, each tried: those without which the touches fit, the likeliest first.
std::vector<TouchDiagnosis> mistakes(const TouchProblem& problem);

/// Whether the part was moved between two rolls: those before fit together, those after do, and not all of them.
/// REQUIRES a problem with rolls, and its answer.
std::vector<TouchDiagnosis> moved(const TouchProblem& problem, const TouchAnswer& answer);

/// Radii of the finger with which touches fit that do not fit with the stated one, or with none stated. It is one
/// unknown more, so the touches have to say more than the pose takes. REQUIRES noise.
std::vector<TouchDiagnosis> other_radii(const TouchProblem& problem);

}  // namespace rollfix::touch
