#include "roll/walk.hpp"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "rollfix/pulse.hpp"

namespace rollfix {
namespace {

// Rounding of a rotation: the last row of a roll that ends where the way ends is not beyond it.
constexpr double kRotationRounding = 16 * std::numeric_limits<double>::epsilon();

}  // namespace

Walked Walk::to(double rotation) {
  beat();
  // Turned back at falls, the finger is behind by that much.
  const double rounding = kRotationRounding * (std::abs(rotation) + std::abs(rotation_.lo) + std::abs(rotation_.hi));
  while (rotation + fallen_ > rotation_.hi + rounding) go(1);
  while (rotation + fallen_ < rotation_.lo - rounding) go(-1);
  return solve(std::min(std::max(rotation + fallen_, rotation_.lo), rotation_.hi));
}

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
  const auto excess = [&](double s) {
    const Turning turning = track_.turning(stretch_, s);
    return std::pair(track_.rotation(stretch_, s, turning.angle) - rotation,
                     track_.finger_curvature(stretch_, s) + turning.curvature);
  };
  const double share = (rotation - rotation_.lo) / (rotation_.hi - rotation_.lo);
  const double guess = stretch_.s.lo + share * stretch_.s.width();
  constexpr int kDigits = std::numeric_limits<double>::digits;
  std::uintmax_t iterations = 100;
  const double s =
      boost::math::tools::newton_raphson_iterate(excess, guess, stretch_.s.lo, stretch_.s.hi, kDigits, iterations);
  const Turning turning = track_.turning(stretch_, s);
  return {s, turning.angle, 1 / (track_.finger_curvature(stretch_, s) + turning.curvature)};
}

}  // namespace rollfix
