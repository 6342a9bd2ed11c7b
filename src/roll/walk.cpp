#include "roll/motion.hpp"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "work/pulse.hpp"

// Notation:
//   s, Theta        contact on the part, and the tangent's angle there: `s`, `angle`
//   omega           the finger's angular velocity; its integral from the start on: `rotations_of`
//   psi             how far the finger has turned: `Track::rotation`, of a disk Theta + s / r
//   L, theta        s - s0 and Theta - Theta0: the reading, from which u and psi follow (`contact_after`)
//   fallen          over the tiny concave joints of a drawing the finger turns back: by so much psi is behind,
//                   `Walk::fallen_`
// Follows eqs. (1) and (2) of the paper (Jia, IROS 2001), integrated once: (1/r + kappa) ds = omega d tau makes Theta +
// s / r the integral of omega, eq. (3). Measured are L and theta, eqs. (4) and (5).
// At corners psi grows where s stays: at the part's Theta turns, at the finger's own N does.
// Idea: psi grows along the track, so that the contact at each time is found by solving psi(s) = rotation on one
// stretch, by Newton's method, instead of by steps of a differential equation.
namespace rollfix {
namespace {

// Rounding of a rotation: the last row of a roll that ends where the way ends is not beyond it.
constexpr double kRotationRounding = 16 * std::numeric_limits<double>::epsilon();

/// How far the finger has turned at each of the times: the integral of omega in eq. (3).
std::vector<double> rotations_of(const Motion& motion, const std::vector<double>& times) {
  if (motion.omega) return integrals(motion.omega, times);
  std::vector<double> rotations(times.size());
  for (std::size_t k = 0; k < times.size(); ++k) rotations[k] = motion.velocity * times[k];
  return rotations;
}

}  // namespace

/// The contact at this value of psi. It goes from the last stretch on, either way, so that rotations near the last one
/// cost one Newton solution.
Walked Walk::to(double rotation) {
  beat();
  // Turned back at falls, the finger is behind by that much.
  const double rounding = kRotationRounding * (std::abs(rotation) + std::abs(rotation_.lo) + std::abs(rotation_.hi));
  // After both loops `rotation + fallen_` lies on this stretch, to rounding.
  while (rotation + fallen_ > rotation_.hi + rounding) go(1);
  while (rotation + fallen_ < rotation_.lo - rounding) go(-1);
  return solve(std::min(std::max(rotation + fallen_, rotation_.lo), rotation_.hi));
}

/// rotation_: psi at both ends of the stretch. On the stretch psi grows from one to the other.
void Walk::enter(std::int64_t index) {
  index_ = index;
  stretch_ = track_.stretch(index);
  rotation_ = {track_.rotation(stretch_, stretch_.s.lo, stretch_.angle.lo),
               track_.rotation(stretch_, stretch_.s.hi, stretch_.angle.hi)};
}

void Walk::go(int direction) {
  const auto next = track_.next(index_, direction);
  if (!next) track_.refuse(index_, direction);
  fallen_ += track_.fall_between(index_, *next);
  enter(*next);
}

Walked Walk::solve(double rotation) const {
  if (stretch_.is_finger_pivot) return {stretch_.s.lo, stretch_.angle.lo, 0};
  if (stretch_.is_pivot) return {stretch_.s.lo, stretch_.angle.lo + (rotation - rotation_.lo), 0};
  // d psi / ds = kappa_f + kappa, above 0 where the finger fits: one root.
  const auto excess = [&](double s) {
    const Turning turning = track_.turning(stretch_, s);
    return std::pair(track_.rotation(stretch_, s, turning.angle) - rotation,
                     track_.finger_curvature(stretch_, s) + turning.curvature);
  };
  // The first guess: as if psi were linear in s on the stretch.
  const double share = (rotation - rotation_.lo) / (rotation_.hi - rotation_.lo);
  const double guess = stretch_.s.lo + share * stretch_.s.width();
  constexpr int kDigits = std::numeric_limits<double>::digits;
  std::uintmax_t iterations = 100;
  const double s =
      boost::math::tools::newton_raphson_iterate(excess, guess, stretch_.s.lo, stretch_.s.hi, kDigits, iterations);
  const Turning turning = track_.turning(stretch_, s);
  return {s, turning.angle, 1 / (track_.finger_curvature(stretch_, s) + turning.curvature)};
}

std::vector<RollState> states_of(const Track& track, const Motion& motion, const std::vector<double>& times) {
  const double s0 = motion.start.s;
  const double rotation0 = track.rotation(track.stretch(motion.start.index), s0, motion.start_angle);
  std::vector<RollState> states;
  states.reserve(times.size());
  Walk walk(track, motion.start.index);
  for (const double rotation : rotations_of(motion, times)) {
    const Walked at = walk.to(rotation0 + rotation);
    if (track.finger().has_corners()) {  // on them u does not tell psi
      states.push_back({{motion.first.u - (at.s - s0), motion.first.psi + rotation}, at.s, at.angle});
      continue;
    }
    const Reading reading{at.s - s0, at.angle - motion.start_angle};  // eqs. (4) and (5)
    states.push_back({contact_after(track.finger(), motion.first, reading), at.s, at.angle});
  }
  return states;
}

}  // namespace rollfix
