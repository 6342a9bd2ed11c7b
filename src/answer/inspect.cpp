#include "rollfix/inspect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/solve.hpp"

// Facts of a part: its box, curvatures, the largest finger, its symmetry, and how ambiguous rolls on it are.
// Notation:
//   spiral          a stretch on which kappa is monotone and keeps its sign, so that Theta is monotone
//   P / m           a shift after which the part looks the same: symmetry m
//   share           a roll of P / share is located again, from starts off any grid
// Idea: what is extreme is at the ends of spirals, or where Theta is a multiple of 90 degrees. A part repeats after a
// shift if the reading of length P / m and 1 / m of the whole turn fits everywhere, which the search itself decides.
namespace rollfix {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2;

/// Where on a spiral, on which Theta is monotone, it has this value.
/// By bisection, until no double is left in between.
double place_of_angle(const TurningFunction& turning, const Spiral& spiral, double angle) {
  const bool grows = spiral.turn() > 0;
  double lo = spiral.lo;
  double hi = spiral.hi;
  while (true) {
    const double middle = lo + 0.5 * (hi - lo);
    if (!(middle > lo && middle < hi)) return lo;
    const bool is_before = (turning.on_spiral(spiral, middle).angle < angle) == grows;
    (is_before ? lo : hi) = middle;
  }
}

/// What a roll from s says.
Reading reading_of(const Part& part, double s, double length) {
  return {length, part.turning().angle(s + length) - part.turning().angle(s)};
}

/// Cheap, and true of every part that looks the same after a shift by `shift`.
/// Samples only: it saves the search for nearly all shifts that are none.
bool may_repeat_after(const Part& part, double shift) {
  constexpr int kSamples = 16;
  const TurningFunction& turning = part.turning();
  const double expected = turning.period_turn() * shift / part.perimeter();
  for (int i = 0; i < kSamples; ++i) {
    const double s = (i + std::numbers::phi / 2) / kSamples * part.perimeter();
    if (std::abs(turning.angle(s + shift) - turning.angle(s) - expected) > 1e3 * kTurnAccuracy) return false;
  }
  return true;
}

/// A shift is a symmetry if the reading of that length and its share of the whole turn fits all around.
bool repeats_after(const Part& part, double shift) {
  if (!may_repeat_after(part, shift)) return false;
  const Reading reading{shift, part.turning().period_turn() * shift / part.perimeter()};
  return locate(part, reading).verdict().name == Verdict::unobservable;
}

/// Averages over `rolls` rolls of P / share.
Ambiguity ambiguity_of(const Part& part, int share, int rolls) {
  Ambiguity result;
  result.share = share;
  result.rolls = rolls;
  const double length = part.perimeter() / share;
  const double room = part.closed() ? part.perimeter() : part.perimeter() - length;
  for (int i = 0; i < rolls; ++i) {
    // Off any regular grid, so that no symmetry is met by accident.
    const double s = (i + std::numbers::phi / 2) / rolls * room;
    const Search found = locate(part, reading_of(part, s, length));
    const auto is_stretch = [](const Placement& placement) { return placement.kind == Kind::stretch; };
    const bool with_stretch = std::any_of(found.placements.begin(), found.placements.end(), is_stretch);
    result.with_stretch += with_stretch ? 1 : 0;
    result.mean_placements += static_cast<double>(found.placements.size()) / rolls;
    result.most_placements = std::max(result.most_placements, found.placements.size());
  }
  return result;
}

}  // namespace

bool has_reach(const Finger& finger) { return finger.outline() == nullptr; }

Reach reach_of(const Part& part, const Finger& finger) {
  return finger.is_disk() ? reach_of_disk(part, finger.disk()->radius) : reach_of_jaw(part);
}

/// Exact but for rounding, in O(n) spirals.
BoundingBox bounding_box(const Part& part) {
  const TurningFunction& turning = part.turning();
  BoundingBox box{part.point(0), part.point(0)};
  const auto include = [&](double s) {
    const Vec2 point = part.point(s);
    box.lo = box.lo.cwiseMin(point);
    box.hi = box.hi.cwiseMax(point);
  };
  for (const Spiral& spiral : turning.spirals()) {
    include(spiral.lo);
    include(spiral.hi);
    // In between, where the tangent is level or upright.
    const double first = std::ceil(std::min(spiral.start.angle, spiral.end.angle) / kRightAngle);
    const double last = std::floor(std::max(spiral.start.angle, spiral.end.angle) / kRightAngle);
    for (double k = first; k <= last; ++k) include(place_of_angle(turning, spiral, k * kRightAngle));
  }
  return box;
}

/// From the least to the largest kappa, corners left out.
Interval curvature_range(const Part& part) {
  Interval range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Spiral& spiral : part.turning().spirals()) {
    range.lo = std::min({range.lo, spiral.start.curvature, spiral.end.curvature});
    range.hi = std::max({range.hi, spiral.start.curvature, spiral.end.curvature});
  }
  return range;
}

/// The radius of the largest disk that no concave place hinders, by its curvature alone: 0 with concave corners,
/// infinite on a convex part. Narrow gaps are not looked at.
double largest_disk(const Part& part) {
  const auto is_concave = [](const Corner& corner) { return corner.is_concave(); };  // tiny joints are rolled over
  if (std::any_of(part.corners().begin(), part.corners().end(), is_concave)) return 0;
  const double most_concave = -curvature_range(part).lo;
  // A straight line's curvature is 0 but for rounding.
  const bool is_concave_somewhere = most_concave > kTurnAccuracy / part.perimeter();
  return is_concave_somewhere ? 1 / most_concave : std::numeric_limits<double>::infinity();
}

/// m of an m-fold symmetry, the largest; 1: none; 0: a circle, where every shift is one.
int symmetry(const Part& part) {
  // An open outline has ends, which no shift maps onto themselves.
  if (!part.closed()) return 1;
  const Interval range = curvature_range(part);
  // One curvature all around.
  const bool is_circle = part.corners().empty() && range.width() <= 1e3 * kTurnAccuracy * std::abs(range.hi);
  if (is_circle) return 0;
  // A shift by P/m maps spirals onto spirals.
  for (int m = static_cast<int>(part.turning().spirals().size()); m > 1; --m) {
    if (repeats_after(part, part.perimeter() / m)) return m;
  }
  return 1;
}

/// For rolls of P / 16, P / 8, P / 4 and P / 2; fewer rolls on a part with many spirals.
std::vector<Ambiguity> ambiguity(const Part& part) {
  constexpr std::size_t kMostWork = 20000;  // spirals, summed over the rolls of one length
  constexpr std::size_t kLeastRolls = 4;
  constexpr std::size_t kMostRolls = 32;
  const std::size_t rolls = std::clamp(kMostWork / part.turning().spirals().size(), kLeastRolls, kMostRolls);
  std::vector<Ambiguity> result;
  for (const int share : {16, 8, 4, 2}) result.push_back(ambiguity_of(part, share, static_cast<int>(rolls)));
  return result;
}

Inspection inspect(const Part& part, const std::optional<Finger>& finger) {
  if (finger && !has_reach(*finger)) {
    throw InputError(
        fmt::format("the finger {}: where a finger can touch is known of disks and jaws only", finger->name()));
  }
  Inspection inspection{
      part, bounding_box(part), curvature_range(part), largest_disk(part), symmetry(part), ambiguity(part), finger};
  if (finger) inspection.reach = reach_of(part, *finger);
  return inspection;
}

}  // namespace rollfix
