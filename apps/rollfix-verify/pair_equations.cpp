#include "pair_equations.hpp"

#include <algorithm>
#include <cmath>

#include "budget.hpp"

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

Weights unit(std::size_t count, std::size_t k) {
  Weights result(count, 0.0);
  result[k] = 1;
  return result;
}

double size_of(const Weights& weights) {
  double sum = 0;
  for (const double weight : weights) sum += std::abs(weight);
  return sum;
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

using Linear = PairEquations::Linear;

Linear linear(FingerCurve& curve, const Stretch& stretch, int depth) {
  Linear result;
  if (!stretch.pivot) {
    const Stretch& first = curve.halved(stretch).first;
    const Ball width = Ball(stretch.hi) - stretch.lo;
    result.middle = first.to;
    result.rate = rates(curve, stretch, depth);
    for (std::size_t c = 0; c < result.rate.size(); ++c) {
      result.rate[c] = width * result.rate[c];
      result.middle[c] = result.middle[c] + stretch.jump[c] - stretch.jump[c];
    }
    result.lo = (Ball(stretch.lo) - first.hi) / width;
    result.hi = (Ball(stretch.hi) - first.hi) / width;
    return result;
  }
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

/// Of finger a's contacts, the first one first.
std::vector<Ball> PairEquations::contact_weights(const Weights& weights) const {
  std::vector<Ball> result(turns_.size() + 1, Ball(0.0));
  for (std::size_t k = 0; k < turns_.size(); ++k) {
    result[k + 1] = weights[k];
    result[0] = result[0] - weights[k];
  }
  if (facing_) result[0] = result[0] + weights.back();
  return result;
}

/// `turned`: whole turns that the facing is off by, radians.
Ball PairEquations::right_side(const Weights& weights, const Ball& turned) const {
  Ball result = 0.0;
  for (std::size_t k = 0; k < turns_.size(); ++k) result = result + Ball(weights[k]) * turns_[k];
  if (facing_) result = result + Ball(weights.back()) * (*facing_ + turned);
  return result;
}

Ball PairEquations::combined(const Stretch& a, const Stretch& b, const Weights& weights, const Ball& turned) const {
  const std::vector<Ball> contacts = contact_weights(weights);
  return a.sum(contacts) - b.sum(contacts) - right_side(weights, turned);
}

/// The first and the last number of whole turns by which the facing can fit; nothing: none does.
std::optional<std::pair<long, long>> PairEquations::whole_turns(const Stretch& a, const Stretch& b,
                                                                double bound) const {
  if (!facing_) return std::pair<long, long>{0, 0};
  const Ball range = combined(a, b, unit(count(), count() - 1), 0.0);
  if (!range.is_finite()) return std::pair<long, long>{0, kMostTurns};
  const Ball full = 2.0 * pi();
  const auto first = static_cast<long>(std::ceil(((Ball(range.lower()) - bound) / full).lower()));
  const auto last = static_cast<long>(std::floor(((Ball(range.upper()) + bound) / full).upper()));
  if (first > last) return std::nullopt;
  return std::pair<long, long>{first, last};
}

bool PairEquations::are_apart(const Stretch& a, const Stretch& b, double bound) const {
  Budget::spend(kApartWork * static_cast<double>(count() * count()));
  const std::optional<std::pair<long, long>> turns = whole_turns(a, b, bound);
  if (!turns) return true;
  if (turns->second - turns->first >= kMostTurns) return false;
  for (long k = turns->first; k <= turns->second; ++k) {
    if (!are_apart(a, b, bound, static_cast<double>(k) * (2.0 * pi()))) return false;
  }
  return true;
}

/// Each equation by itself; then each two of them as they are seen across one curve's chord or the other's, where that
/// curve is thin. Where equations are off by no more than the bound each, a sum of them with weights is off by no more
/// than the bound times the weights' sizes.
bool PairEquations::are_apart(const Stretch& a, const Stretch& b, double bound, const Ball& turned) const {
  const auto decides = [&](const Weights& weights) {
    const Ball most = Ball(bound) * size_of(weights);
    const Ball range = combined(a, b, weights, turned);
    return range.is_above(most) || range.is_below(-most);
  };
  for (std::size_t k = 0; k < count(); ++k) {
    if (decides(unit(count(), k))) return true;
  }
  for (std::size_t k = 0; k < count(); ++k) {
    for (std::size_t l = k + 1; l < count(); ++l) {
      for (const Stretch* one : {&a, &b}) {
        const auto chord = [&](std::size_t row) {
          const std::vector<Ball> contacts = contact_weights(unit(count(), row));
          double sum = 0;
          for (std::size_t c = 0; c < contacts.size(); ++c) {
            sum += contacts[c].middle() * one->turn(c);
          }
          return sum;
        };
        Weights across(count(), 0.0);
        across[k] = -chord(l);
        across[l] = chord(k);
        if (size_of(across) > 0 && decides(across)) return true;
      }
    }
  }
  return false;
}

std::vector<Ball> PairEquations::off(const Stretch& a, const Stretch& b) const {
  std::vector<Ball> result;
  for (std::size_t k = 0; k < count(); ++k) {
    result.push_back(combined(a, b, unit(count(), k), 0.0));
    const bool is_facing = k == turns_.size();
    const Ball full = 2.0 * pi();
    if (is_facing) result[k] = result[k] - std::round((result[k] / full).middle()) * full;
  }
  return result;
}

std::vector<PairEquations::Plane> PairEquations::planes(const Stretch& a, const Stretch& b) const {
  std::vector<Plane> result;
  for (std::size_t k = 0; k < count(); ++k) {
    const std::vector<Ball> contacts = contact_weights(unit(count(), k));
    const Stretch::Chord of_a = a.chord(contacts);
    const Stretch::Chord of_b = b.chord(contacts);
    Ball at = of_a.from - of_b.from - right_side(unit(count(), k), 0.0);
    const Ball by_a = of_a.to - of_a.from;
    const Ball by_b = of_b.from - of_b.to;
    if (k == turns_.size()) {
      const Ball full = 2.0 * pi();
      const Ball middle = at + 0.5 * by_a + 0.5 * by_b;
      at = at - std::round((middle / full).middle()) * full;
      const Ball reach = abs(at + 0.5 * by_a + 0.5 * by_b) + 0.5 * (abs(by_a) + abs(by_b)) + of_a.off + of_b.off;
      if (!reach.is_below(pi())) return {};
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
  const Ball base = a.angle(0).middle() - Ball(b.angle(0).middle());
  const Ball all = a.angle(0) - b.angle(0) - base;
  double lo = all.lower();
  double hi = all.upper();
  const auto keep = [&](const Ball& difference) {
    lo = std::max(lo, (difference - most).lower());
    hi = std::min(hi, (difference + most).upper());
  };
  for (std::size_t k = 0; k < turns_.size(); ++k) keep(a.angle(k + 1) - b.angle(k + 1) - turns_[k] - base);
  if (facing_ && lo <= hi) {
    const Ball full = 2.0 * pi();
    const Ball off = *facing_ - base;
    keep(off + std::round(((Ball(0.5 * (lo + hi)) - off) / full).middle()) * full);
  }
  return lo <= hi;
}

bool PairEquations::have_one_root(FingerCurve& curve_a, const Stretch& a, FingerCurve& curve_b, const Stretch& b,
                                  double slack) const {
  if ((a.pivot && a.pivots != 1) || (b.pivot && b.pivots != 1)) return false;
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
  const Ball full = 2.0 * pi();
  const Ball lo[2] = {of_a.lo, of_b.lo};
  const Ball hi[2] = {of_a.hi, of_b.hi};
  Ball j[2][2];
  Ball f[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const std::vector<Ball> contacts = contact_weights(unit(count(), rows[k]));
    f[k] = hull(-slack, slack) - right_side(unit(count(), rows[k]), 0.0);
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      f[k] = f[k] + contacts[c] * (of_a.middle[c] - of_b.middle[c]);
      j[k][0] = j[k][0] + contacts[c] * of_a.rate[c];
      j[k][1] = j[k][1] - contacts[c] * of_b.rate[c];
    }
    if (!(j[k][0].is_finite() && j[k][1].is_finite())) return false;
  }
  if (facing_ && rows[1] + 1 == count()) {  // no other number of whole turns fits
    f[1] = f[1] - std::round((f[1] / full).middle()) * full;
    const Ball range = abs(f[1] + hull(lo[0], hi[0]) * j[1][0] + hull(lo[1], hi[1]) * j[1][1]);
    if (!range.is_below(full)) return false;
  }
  const double determinant = j[0][0].middle() * j[1][1].middle() - j[0][1].middle() * j[1][0].middle();
  if (determinant == 0) return false;
  const double inverse[2][2] = {{j[1][1].middle() / determinant, -j[0][1].middle() / determinant},
                                {-j[1][0].middle() / determinant, j[0][0].middle() / determinant}};
  for (int i = 0; i < 2; ++i) {
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
