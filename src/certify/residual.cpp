#include "residual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "part/cursor.hpp"
#include "places.hpp"

namespace rollfix {
namespace {

// Halvings until a slope's sign is given up.
constexpr int kMostHalvings = 24;
// Between cuts f is a difference of monotone slopes: looked at in so many places for its least size ...
constexpr int kSamples = 16;
constexpr double kGolden = 0.6180339887498949;
constexpr int kGoldenSteps = 40;
// ... and for being 0 all along: more than its polynomials have terms.
constexpr int kFlatSamples = 19;

}  // namespace

double Residual::size(double s) const { return std::abs(at(s)); }

double Residual::step() const { return least_step(part_); }

CurvePlace Residual::place(double s) const { return place_of(part_, s); }

double Residual::clear(double s, int way) const { return clear_of_joints(part_, {length_}, s, way); }

std::vector<Residual::Cut> Residual::cuts(double lo, double hi) const {
  std::vector<Cut> result{{lo}};
  for (const double shift : {0.0, length_}) {
    Cursor cursor(turning_, lo + shift);
    // On a closed boundary the cursor's own laps are those of the place that it was made from.
    while (!cursor.is_last() && cursor.hi() - shift < hi) {
      cursor.advance();
      const double s = cursor.lo() - shift;
      const bool jumps = std::abs(cursor.angle_after() - cursor.angle_before()) > 0.5 * kTurnAccuracy;
      if (s > lo) result.push_back({s, jumps});
    }
  }
  result.push_back({hi});
  std::sort(result.begin(), result.end(), [](const Cut& one, const Cut& two) { return one.s < two.s; });
  return result;
}

/// Of f' between cuts, where each curvature is monotone; 0: not known.
int Residual::slope_sign(double lo, double hi, int depth) const {
  const double start_lo = turning_.curvature(lo);
  const double start_hi = turning_.curvature(hi);
  const double end_lo = turning_.curvature(lo + length_);
  const double end_hi = turning_.curvature(hi + length_);
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
    if (all[k].jumps) return false;
    const double inset = std::min(step(), 0.25 * (all[k + 1].s - all[k].s));
    const int here = slope_sign(all[k].s + inset, all[k + 1].s - inset, 0);
    if (here == 0 || (sign != 0 && here != sign)) return false;
    sign = here;
  }
  return true;
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
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    const double from = all[k].s + step();
    const double width = all[k + 1].s - step() - from;
    if (!(width > step())) continue;
    for (int i = 0; i <= kSamples; ++i) {
      const double before = least;
      const double s = from + width * i / kSamples;
      consider(s);
      if (least >= before) continue;
      const double around = width / kSamples;
      consider(refined(std::max(s - around, from), std::min(s + around, from + width)));
    }
  }
  return best;
}

bool Residual::is_flat(double lo, double hi) const {
  for (int i = 0; i <= kFlatSamples; ++i) {
    const double s = lo + (hi - lo) * i / kFlatSamples;
    const double curvature = std::abs(turning_.curvature(s)) + std::abs(turning_.curvature(s + length_));
    if (size(s) > kTurnAccuracy + 1e-15 * part_.perimeter() * curvature) return false;
  }
  return true;
}

std::vector<Interval> Residual::flat(double lo, double hi) const {
  const std::vector<Cut> all = cuts(lo, hi);
  std::vector<Interval> result;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    const Interval piece{all[k].s + step(), all[k + 1].s - step()};
    if (!(piece.width() > step()) || !is_flat(piece.lo, piece.hi)) continue;
    if (!result.empty() && piece.lo - result.back().hi < 8 * step()) {
      result.back().hi = piece.hi;
    } else {
      result.push_back(piece);
    }
  }
  return result;
}

}  // namespace rollfix
