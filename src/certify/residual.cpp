#include "residual.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "part/cursor.hpp"
#include "rollfix/pulse.hpp"

// Notation:
//   f(s)            Theta(s + `to_`) - Theta(s + `from_`) - `turn_`. Of one reading from = 0, to = L, turn = theta; of
//                   two the difference of their f, with both lengths and the difference of both turns
//   f'(s)           kappa(s + `to_`) - kappa(s + `from_`)
//   cut             a start at which one of the two contacts passes to another spiral, with the jump of f there
//   blur            by how much |f| near a joint has to be clear of a bound, for rows keep away from joints
// Follows eqs. (4) and (5) of the paper (Jia, IROS 2001); docs/certificates.md, "What is in it".
// Idea: between cuts both curvatures are monotone, so that four numbers tell the sign of f', after some halvings.
namespace rollfix {
namespace {

constexpr int kMostBisections = 60;
// What is checked with balls has to miss a bound by this much at joints besides what f does over the steps that rows
// keep from them, radians, and at corners by this share of what the finger pivots: a ball's radius has 30 bits, less
// after some operations.
constexpr double kMissAtJoints = 4e-12;
constexpr double kMissAtCorners = 1e-8;
// Halvings until a slope's sign is given up.
constexpr int kMostHalvings = 24;
// Between cuts f is a difference of monotone slopes: looked at in so many places for its least size ...
constexpr int kSamples = 16;
constexpr double kGolden = 0.6180339887498949;
constexpr int kGoldenSteps = 40;
// ... and for being 0 all along: more than its polynomials have terms.
constexpr int kFlatSamples = 19;

}  // namespace

std::vector<Residual::Cut> Residual::cuts(double lo, double hi) const {
  std::vector<Cut> result{{lo}};
  for (const auto& [shift, sign] : {std::pair(from_, -1.0), std::pair(to_, 1.0)}) {
    Cursor cursor(turning_, lo + shift);
    // On a closed boundary the cursor's own laps are those of the place that it was made from.
    while (!cursor.is_last() && cursor.hi() - shift < hi) {
      cursor.advance();
      const double s = cursor.lo() - shift;
      const Corner corner{s, cursor.jump()};
      if (s > lo) result.push_back({s, sign * corner.turn, !corner.is_concave()});
    }
  }
  result.push_back({hi});
  std::sort(result.begin(), result.end(), [](const Cut& one, const Cut& two) { return one.s < two.s; });
  return result;
}

/// Of f' between cuts, where each curvature is monotone; 0: not known.
int Residual::slope_sign(double lo, double hi, int depth) const {
  const double start_lo = turning_.curvature(lo + from_);
  const double start_hi = turning_.curvature(hi + from_);
  const double end_lo = turning_.curvature(lo + to_);
  const double end_hi = turning_.curvature(hi + to_);
  if (std::min(end_lo, end_hi) > std::max(start_lo, start_hi)) return 1;
  if (std::max(end_lo, end_hi) < std::min(start_lo, start_hi)) return -1;
  if (depth == kMostHalvings || (end_lo > start_lo) != (end_hi > start_hi)) return 0;
  const double middle = 0.5 * (lo + hi);
  const int sign = slope_sign(lo, middle, depth + 1);
  return sign != 0 && slope_sign(middle, hi, depth + 1) == sign ? sign : 0;
}

bool Residual::is_monotone(double lo, double hi) const {
  const std::vector<Cut> all = cuts(lo, hi);
  int sign = 0;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    if (all[k].jumps()) return false;
    const double inset = std::min(step_, 0.25 * (all[k + 1].s - all[k].s));
    const int here = slope_sign(all[k].s + inset, all[k + 1].s - inset, 0);
    if (here == 0 || (sign != 0 && here != sign)) return false;
    sign = here;
  }
  return true;
}

bool Residual::jumps(double lo, double hi) const {
  const std::vector<Cut> all = cuts(lo, hi);
  return std::any_of(all.begin(), all.end(), [](const Cut& cut) { return cut.jumps(); });
}

/// Golden sections around the least of three.
double Residual::refined(double lo, double hi) const {
  double inner = hi - kGolden * (hi - lo);
  double outer = lo + kGolden * (hi - lo);
  for (int k = 0; k < kGoldenSteps; ++k) {
    if (size(inner) < size(outer)) {
      hi = outer;
      outer = inner;
      inner = hi - kGolden * (hi - lo);
    } else {
      lo = inner;
      inner = outer;
      outer = lo + kGolden * (hi - lo);
    }
  }
  return 0.5 * (lo + hi);
}

/// Where f changes its sign between two places.
double Residual::root(double lo, double hi) const {
  const bool rises = at(hi) > at(lo);
  double middle = 0.5 * (lo + hi);
  for (int k = 0; k < kMostBisections && lo < middle && middle < hi; ++k) {
    ((at(middle) > 0) == rises ? hi : lo) = middle;
    middle = 0.5 * (lo + hi);
  }
  return middle;
}

/// Between cuts, by samples: a root between two of them, else what is refined around those that are least.
double Residual::nearest(double lo, double hi) const {
  const std::vector<Cut> all = cuts(lo, hi);
  double best = lo;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double s) {
    const double here = size(s);
    if (here >= least) return;
    least = here;
    best = s;
  };
  double last = lo;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    const double from = all[k].s + step_;
    beat();
    const double width = all[k + 1].s - step_ - from;
    if (all[k].jumps()) last = from;
    if (!(width > step_)) continue;
    if ((at(last) < 0) != (at(from) < 0)) consider(root(last, from));
    last = from + width;
    const auto place = [&](int i) { return from + width * std::clamp(i, 0, kSamples) / kSamples; };
    std::array<double, kSamples + 1> f;
    for (int i = 0; i <= kSamples; ++i) f[static_cast<std::size_t>(i)] = at(place(i));
    const auto size_at = [&](int i) { return std::abs(f[static_cast<std::size_t>(std::clamp(i, 0, kSamples))]); };
    for (int i = 0; i <= kSamples; ++i) {
      consider(place(i));
      const auto index = static_cast<std::size_t>(i);
      if (i < kSamples && (f[index] < 0) != (f[index + 1] < 0)) consider(root(place(i), place(i + 1)));
      if (size_at(i) <= size_at(i - 1) && size_at(i) <= size_at(i + 1)) consider(refined(place(i - 1), place(i + 1)));
    }
  }
  if ((at(last) < 0) != (at(hi) < 0)) consider(root(last, hi));
  return best;
}

/// Corners that both ends of the roll come to at once each turn by any part of it.
bool Residual::is_near_at_joints(double bound, double lo, double hi) const {
  const std::vector<Cut> all = cuts(lo, hi);
  for (std::size_t k = 1; k + 1 < all.size(); ++k) {
    const double here = all[k].s - 2 * step_;
    const double there = all[k].s + 2 * step_;
    const double miss = bound + std::max(blur(here), blur(there));
    if (std::min(size(here), size(there)) <= miss) return true;
    if (!all[k].jumps() || !all[k].pivots) continue;
    double least = at(here);
    double most = least;
    for (const Cut& one : all) {
      if (std::abs(one.s - all[k].s) < 4 * step_) (one.jump < 0 ? least : most) += one.jump;
    }
    const double spare = kMissAtCorners * (most - least);
    if (least <= miss + spare && most >= -miss - spare) return true;
  }
  return false;
}

double Residual::largest_at_joints(double lo, double hi) const {
  double largest = 0;
  for (const Cut& cut : cuts(lo, hi)) {
    for (const double s : {cut.s - 2 * step_, cut.s + 2 * step_}) {
      if (s > lo && s < hi) largest = std::max(largest, size(s));
    }
  }
  return largest;
}

double Residual::blur(double s) const { return kMissAtJoints + 4 * step_ * steepest(s); }

double Residual::steepest(double s) const {
  return std::abs(turning_.curvature(s + from_)) + std::abs(turning_.curvature(s + to_));
}

bool Residual::is_flat(double lo, double hi) const {
  for (int i = 0; i <= kFlatSamples; ++i) {
    const double s = lo + (hi - lo) * i / kFlatSamples;
    if (size(s) > kTurnAccuracy + 1e-15 * turning_.perimeter() * steepest(s)) return false;
  }
  return true;
}

std::vector<Interval> Residual::flat(double lo, double hi) const {
  const std::vector<Cut> all = cuts(lo, hi);
  std::vector<Interval> result;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    const Interval piece{all[k].s + step_, all[k + 1].s - step_};
    if (!(piece.width() > step_) || !is_flat(piece.lo, piece.hi)) continue;
    if (!result.empty() && piece.lo - result.back().hi < 8 * step_) {
      result.back().hi = piece.hi;
    } else {
      result.push_back(piece);
    }
  }
  return result;
}

}  // namespace rollfix
