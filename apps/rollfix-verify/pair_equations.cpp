#include "pair_boxes.hpp"

#include <algorithm>
#include <cmath>

#include "check.hpp"

// Notation:
//   w               an equation's weights of the contacts c
//   Theta_a(s), Theta_b(t)   the angles of both fingers' contacts
//   F               w . Theta_a(s) - w . Theta_b(t) - right: what an equation is off by
//   J, Y            bounds on the slopes of two equations; about the inverse of the middle of J: `j`, `inverse`
// Follows eqs. (8) and (9) of the paper (Jia, IROS 2001) and the facing; docs/certificates.md, "Two fingers".
// Idea: bounds on w . Theta are those of finger_curve.cpp. One root is proved by Krawczyk's operator (`map_inside`),
// all else by equations, and by two of them together, that are off.
namespace rollfix_verify {
namespace {

// Whole turns that a facing may be off by on two stretches, before they are halved.
constexpr long kMostTurns = 4;
// To look at a combination of equations, and at a root, in expansions.
constexpr double kApartWork = 0.1;
constexpr double kMapWork = 1;
// Most halvings by which the curvatures of a whole stretch are told from those of its parts.
constexpr int kRateDepth = 7;
// A plane is looked at in doubles: what their rounding makes of its terms.
constexpr double kPlaneRounding = 1e-14;

using Equation = PairEquations::Equation;
using Linear = PairEquations::Linear;

/// x one + y other.
Equation sum(double x, const Equation& one, double y, const Equation& other) {
  // Weights and right sides alike.
  Equation result{one.weights, x * one.right + y * other.right};
  for (std::size_t c = 0; c < one.weights.size(); ++c) result.weights[c] = x * one.weights[c] + y * other.weights[c];
  return result;
}

/// How far a sum of angles turns from end to end of a stretch.
double turn_along(const Equation& equation, const Stretch& stretch) {
  double sum = 0;
  for (std::size_t c = 0; c < equation.weights.size(); ++c) sum += equation.weights[c].middle() * stretch.turn(c);
  return sum;
}

/// Each equation by itself; then each two of them as they are seen across one curve's chord or the other's, where that
/// curve is thin. Where two are off by no more than the bound each, x one + y other is by no more than |x| + |y| times
/// that.
bool some_is_off(const std::vector<Equation>& all, const Stretch& a, const Stretch& b, double bound) {
  const auto is_off = [&](const Equation& equation, const Ball& most) {
    const Ball off = equation.off(a, b);
    return off.is_above(most) || off.is_below(-most);
  };
  for (const Equation& equation : all) {
    if (is_off(equation, bound)) return true;
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (std::size_t l = k + 1; l < all.size(); ++l) {
      for (const Stretch* one : {&a, &b}) {
        const double x = -turn_along(all[l], *one);
        const double y = turn_along(all[k], *one);
        // False: both turns are 0, and there is no combination to look at.
        const bool is_thin = x != 0 || y != 0;
        if (is_thin && is_off(sum(x, all[k], y, all[l]), (abs(Ball(x)) + abs(Ball(y))) * bound)) return true;
      }
    }
  }
  return false;
}

/// The curvatures on all of a stretch; of its halves they are known better.
std::vector<Ball> rates(FingerCurve& curve, const Stretch& stretch, int depth) {
  if (depth == 0) return stretch.rate;
  const std::pair<Stretch, Stretch>& halves = curve.halved(stretch);
  std::vector<Ball> first = rates(curve, halves.first, depth - 1);
  const std::vector<Ball> last = rates(curve, halves.second, depth - 1);
  for (std::size_t c = 0; c < first.size(); ++c) first[c] = hull(first[c], last[c]);
  return first;
}

/// Of a smooth stretch by arc length, in widths from about the middle; of a pivot by the angle of its widest contact.
/// `depth`: halvings by which the rates are bounded.
Linear linear(FingerCurve& curve, const Stretch& stretch, int depth) {
  Linear result;
  if (!stretch.pivot) {
    // Its end is about the middle, with the contacts' angles there.
    const Stretch& first = curve.halved(stretch).first;
    const Ball width = Ball(stretch.hi) - stretch.lo;
    result.middle = first.to;
    result.rate = rates(curve, stretch, depth);
    for (std::size_t c = 0; c < result.rate.size(); ++c) {
      result.rate[c] = width * result.rate[c];
      // Between the middle and a place the angle also jumps at smooth joints: by no more than that to either side.
      result.middle[c] = result.middle[c] + stretch.jump[c] - stretch.jump[c];
    }
    result.lo = (Ball(stretch.lo) - first.hi) / width;
    result.hi = (Ball(stretch.hi) - first.hi) / width;
    return result;
  }
  // Arc length stays; only that contact turns.
  const std::size_t pivoting = stretch.widest();
  const Ball middle = stretch.from[pivoting].middle();
  const Ball width = stretch.turn(pivoting);
  result.middle = stretch.from;
  result.rate.assign(stretch.from.size(), Ball(0.0));
  result.middle[pivoting] = middle;
  result.rate[pivoting] = width;
  result.lo = (stretch.from[pivoting].lower() - middle) / width;
  result.hi = (stretch.from[pivoting].upper() - middle) / width;
  return result;
}

}  // namespace

/// Weights by contact, the first one first: -1 and +1 of a reading's first and last contact, +1 of the facing's.
PairEquations::PairEquations(const std::vector<Ball>& turns, const std::optional<Ball>& facing)
    : has_facing_(facing.has_value()) {
  const std::vector<Ball> none(turns.size() + 1, Ball(0.0));
  for (std::size_t k = 0; k < turns.size(); ++k) {
    equations_.push_back({none, turns[k]});
    equations_.back().weights[0] = -1.0;
    equations_.back().weights[k + 1] = 1.0;
  }
  if (!facing) return;
  equations_.push_back({none, *facing});
  equations_.back().weights[0] = 1.0;
}

/// The first and the last number of whole turns by which the facing can fit; nothing: none does.
std::optional<std::pair<long, long>> PairEquations::whole_turns(const Stretch& a, const Stretch& b,
                                                                double bound) const {
  if (!has_facing_) return std::pair<long, long>{0, 0};
  const Ball range = equations_.back().off(a, b);
  // Nothing is known: too many turns, so that the stretches are halved.
  if (!range.is_finite()) return std::pair<long, long>{0, kMostTurns};
  const auto first = static_cast<long>(std::ceil(((Ball(range.lower()) - bound) / full_turn()).lower()));
  const auto last = static_cast<long>(std::floor(((Ball(range.upper()) + bound) / full_turn()).upper()));
  if (first > last) return std::nullopt;
  return std::pair<long, long>{first, last};
}

/// For every number of whole turns that the facing allows some equation, or a combination, is off.
bool PairEquations::are_apart(const Stretch& a, const Stretch& b, double bound) const {
  Budget::spend(kApartWork * static_cast<double>(count() * count()));
  const std::optional<std::pair<long, long>> turns = whole_turns(a, b, bound);
  if (!turns) return true;
  // Halving leaves fewer.
  if (turns->second - turns->first >= kMostTurns) return false;
  for (long k = turns->first; k <= turns->second; ++k) {
    // The facing with this number of whole turns.
    std::vector<Equation> all = equations_;
    if (has_facing_) all.back().right = all.back().right + static_cast<double>(k) * full_turn();
    if (!some_is_off(all, a, b, bound)) return false;
  }
  return true;
}

std::vector<Ball> PairEquations::off(const Stretch& a, const Stretch& b) const {
  std::vector<Ball> result;
  for (const Equation& equation : equations_) result.push_back(equation.off(a, b));
  if (has_facing_) result.back() = to_nearest_turn(result.back());
  return result;
}

/// From the chords of both fingers. Each coefficient is rounded to a double, and what that leaves is part of `off`.
std::vector<PairEquations::Plane> PairEquations::planes(const Stretch& a, const Stretch& b) const {
  std::vector<Plane> result;
  for (std::size_t k = 0; k < count(); ++k) {
    const Stretch::Chord of_a = a.chord(equations_[k].weights);
    const Stretch::Chord of_b = b.chord(equations_[k].weights);
    Ball at = of_a.from - of_b.from - equations_[k].right;
    const Ball by_a = of_a.to - of_a.from;
    const Ball by_b = of_b.from - of_b.to;
    // No other number of whole turns is possible: the facing stays within half a turn of 0 on both stretches.
    if (is_facing(k)) {
      const Ball halfway = 0.5 * by_a + 0.5 * by_b;
      const Ball middle = to_nearest_turn(at + halfway);
      at = middle - halfway;
      const Ball reach = abs(middle) + 0.5 * (abs(by_a) + abs(by_b)) + of_a.off + of_b.off;
      if (!reach.is_below(0.5 * full_turn())) return {};
    }
    Plane plane{at.middle(), by_a.middle(), by_b.middle(), 0};
    const Ball left = abs(at - plane.at) + abs(by_a - plane.by_a) + abs(by_b - plane.by_b) + of_a.off + of_b.off;
    const double size = std::abs(plane.at) + std::abs(plane.by_a) + std::abs(plane.by_b);
    plane.off = left.upper() + kPlaneRounding * size;
    result.push_back(plane);
  }
  return result;
}

/// Each says where the difference of the first contacts' tangents is; the facing but for whole turns.
bool PairEquations::fit_together(const Stretch& a, const Stretch& b, double most) const {
  // Differences are taken from the middle, so that doubles hold them.
  const Ball base = a.angle(0).middle() - Ball(b.angle(0).middle());
  const Ball all = a.angle(0) - b.angle(0) - base;
  double lo = all.lower();
  double hi = all.upper();
  // What an equation leaves of the difference of both first contacts' tangents.
  const auto keep = [&](const Ball& difference) {
    lo = std::max(lo, (difference - most).lower());
    hi = std::min(hi, (difference + most).upper());
  };
  for (std::size_t k = 0; k < count(); ++k) {
    const Ball& right = equations_[k].right;
    if (!is_facing(k)) {
      keep(a.angle(k + 1) - b.angle(k + 1) - right - base);
    } else if (lo <= hi) {
      // The whole turns nearest to what is left.
      const double middle = 0.5 * (lo + hi);
      keep(middle - to_nearest_turn(middle - (right - base)));
    }
  }
  return lo <= hi;
}

/// Tried with ever tighter bounds on the rates, and with each two equations.
bool PairEquations::have_one_root(FingerCurve& curve_a, const Stretch& a, FingerCurve& curve_b, const Stretch& b,
                                  double slack) const {
  // With two contacts at corners two angles are free at one place: a family, never one root.
  if ((a.pivot && a.pivots != 1) || (b.pivot && b.pivots != 1)) return false;
  // Cheap bounds first.
  for (int depth = 0; depth <= kRateDepth; ++depth) {
    const Linear of_a = linear(curve_a, a, depth);
    const Linear of_b = linear(curve_b, b, depth);
    for (std::size_t k = 0; k < count(); ++k) {
      for (std::size_t l = k + 1; l < count(); ++l) {
        if (map_inside(of_a, of_b, {k, l}, slack)) return true;
      }
    }
  }
  return false;
}

/// With x the middle, X all of the stretches, F continuous with slopes in J: x - Y (F(x) + slack) + (1 - Y J)(X - x)
/// inside of X proves a root (Brouwer), and that J has an inverse, so that there is no second one. `rows`: which two
/// equations.
bool PairEquations::map_inside(const Linear& of_a, const Linear& of_b, const std::array<std::size_t, 2>& rows,
                               double slack) const {
  Budget::spend(kMapWork);
  // X is [lo, hi] in both parameters, x is 0.
  const Ball lo[2] = {of_a.lo, of_b.lo};
  const Ball hi[2] = {of_a.hi, of_b.hi};
  Ball j[2][2];
  Ball f[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& [weights, right] = equations_[rows[k]];
    // F in the middle, open by the slack, and J over all of X.
    f[k] = around_zero(slack) + weighted(weights, of_a.middle) - weighted(weights, of_b.middle) - right;
    j[k][0] = weighted(weights, of_a.rate);
    j[k][1] = -weighted(weights, of_b.rate);
    if (!(j[k][0].is_finite() && j[k][1].is_finite())) return false;
  }
  if (is_facing(rows[1])) {  // no other number of whole turns fits
    f[1] = to_nearest_turn(f[1]);
    const Ball range = abs(f[1] + hull(lo[0], hi[0]) * j[1][0] + hull(lo[1], hi[1]) * j[1][1]);
    if (!range.is_below(full_turn())) return false;
  }
  const double determinant = j[0][0].middle() * j[1][1].middle() - j[0][1].middle() * j[1][0].middle();
  if (determinant == 0) return false;
  // Y need not be the exact inverse: the test below proves what it has to.
  const double inverse[2][2] = {{j[1][1].middle() / determinant, -j[0][1].middle() / determinant},
                                {-j[1][0].middle() / determinant, j[0][0].middle() / determinant}};
  for (int i = 0; i < 2; ++i) {
    // Krawczyk's image, one coordinate each.
    Ball image = -(Ball(inverse[i][0]) * f[0] + Ball(inverse[i][1]) * f[1]);
    for (int k = 0; k < 2; ++k) {
      const Ball off = Ball(i == k ? 1.0 : 0.0) - (Ball(inverse[i][0]) * j[0][k] + Ball(inverse[i][1]) * j[1][k]);
      image = image + off * hull(lo[k], hi[k]);
    }
    if (!(image.is_above(lo[i]) && image.is_below(hi[i]))) return false;
  }
  return true;
}

}  // namespace rollfix_verify
