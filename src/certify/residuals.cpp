#include "residuals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "part/cursor.hpp"
#include "work/pulse.hpp"

// Notation:
//   f_k(s)          Theta(s + L_k) - Theta(s) - theta_k of reading k: `f_[k]`
//   f(s)            Theta(s + `to_`) - Theta(s + `from_`) - `turn_`. Of one reading from = 0, to = L, turn = theta; of
//                   two the difference of their f, with both lengths and the difference of both turns
//   f'(s)           kappa(s + `to_`) - kappa(s + `from_`)
//   cut             a start at which one of the two contacts passes to another spiral, with the jump of f there
//   blur            by how much |f| near a joint has to be clear of a bound, for rows keep away from joints
//   f_j - f_k       does not know the tangent at s; where both fit it is within twice the tolerance: `exclusion_by_two`
//   excluded        the bound that |f| has to be outside of: `excluded()`
//   step            the least distance between places: `step_`
// Follows eqs. (4) and (5) of the paper (Jia, IROS 2001); docs/certificates.md, "What is in it", and there the cell
// `apart`, by one reading or by two.
// Idea: between cuts both curvatures are monotone, so that four numbers tell the sign of f', after some halvings. Of
// all readings the one that is furthest off at the nearer end is tried first. At a convex corner where the roll starts
// all readings share one pivot, which each of them alone may fit, and two together can exclude.
namespace rollfix::certifying {
namespace {

// Halvings of a bracket: it ends sooner where no double is left in between.
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

/// Each of the two contacts walks along its spirals from lo to hi. At a joint of the second contact f grows by the
/// corner's turn, at one of the first contact it falls by it. O(n log n) in the number of joints passed.
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

/// The sign of f' = kappa(s + to) - kappa(s + from) on a stretch without cuts; 0: it has both signs, or is not decided.
int Residual::slope_sign(double lo, double hi, int depth) const {
  // Each curvature is monotone here, so that its two end values enclose it.
  const double start_lo = turning_.curvature(lo + from_);
  const double start_hi = turning_.curvature(hi + from_);
  const double end_lo = turning_.curvature(lo + to_);
  const double end_hi = turning_.curvature(hi + to_);
  // The two enclosures do not overlap: the difference has one sign.
  if (std::min(end_lo, end_hi) > std::max(start_lo, start_hi)) return 1;
  if (std::max(end_lo, end_hi) < std::min(start_lo, start_hi)) return -1;
  // Different signs at the two ends: f' is 0 somewhere in between, and halving is of no use.
  if (depth == kMostHalvings || (end_lo > start_lo) != (end_hi > start_hi)) return 0;
  const double middle = 0.5 * (lo + hi);
  const int sign = slope_sign(lo, middle, depth + 1);
  return sign != 0 && slope_sign(middle, hi, depth + 1) == sign ? sign : 0;
}

/// One sign of f' on all pieces between cuts, the same on all of them, and no corner with a jump. Then f has at most
/// one root between lo and hi.
bool Residual::is_monotone(double lo, double hi) const {
  const std::vector<Cut> all = cuts(lo, hi);
  int sign = 0;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    if (all[k].jumps()) return false;
    // A step inside of the piece, so that each contact's curvature is taken on the piece's own spiral.
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

/// Where |f| is least between lo and hi, if it has one minimum there; golden section narrows the bracket to 4e-9 of its
/// width.
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

/// A root of f by bisection. REQUIRES opposite signs at lo and hi; the sign is kept at both ends of the bracket.
double Residual::root(double lo, double hi) const {
  const bool rises = at(hi) > at(lo);
  double middle = 0.5 * (lo + hi);
  for (int k = 0; k < kMostBisections && lo < middle && middle < hi; ++k) {
    ((at(middle) > 0) == rises ? hi : lo) = middle;
    middle = 0.5 * (lo + hi);
  }
  return middle;
}

/// On each piece between cuts |f| is sampled. A change of sign brackets a root; around each sample that is no larger
/// than its neighbours |f| is refined. A root is also looked for across a cut without a jump. A heuristic: the verifier
/// proves what is claimed from it.
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
  // The last place looked at before this piece: what lies between it and the piece is the joint, two steps wide.
  double last = lo;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    const double from = all[k].s + step_;
    beat();
    const double width = all[k + 1].s - step_ - from;
    // Across a jump a change of sign is no root; corners are looked at in `is_near_at_joints`.
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

/// At each cut: whether f comes within the bound on either side, or by a pivot in between. If both contacts are at
/// convex corners at once, each pivots on its own, and f takes every sum of parts of their jumps.
bool Residual::is_near_at_joints(double bound, double lo, double hi) const {
  const std::vector<Cut> all = cuts(lo, hi);
  for (std::size_t k = 1; k + 1 < all.size(); ++k) {
    const double here = all[k].s - 2 * step_;
    const double there = all[k].s + 2 * step_;
    const double miss = bound + std::max(blur(here), blur(there));
    if (std::min(size(here), size(there)) <= miss) return true;
    // At a concave corner f has only the two values that were looked at.
    if (!all[k].jumps() || !all[k].pivots) continue;
    // All values of f during the pivots: from the value before the corner, less all falls, to it plus all rises.
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

/// The places two steps beside each cut, and two steps inside of lo and of hi.
double Residual::largest_at_joints(double lo, double hi) const {
  double largest = 0;
  for (const Cut& cut : cuts(lo, hi)) {
    for (const double s : {cut.s - 2 * step_, cut.s + 2 * step_}) {
      if (s > lo && s < hi) largest = std::max(largest, size(s));
    }
  }
  return largest;
}

/// Radians: the verifier's rounding, and what f changes at most over the four steps that rows and places keep from a
/// joint.
double Residual::blur(double s) const { return kMissAtJoints + 4 * step_ * steepest(s); }

double Residual::steepest(double s) const {
  return std::abs(turning_.curvature(s + from_)) + std::abs(turning_.curvature(s + to_));
}

/// |f| <= `kTurnAccuracy`, and what an error of 1e-15 P in the places changes. More samples than a polynomial of the
/// turning function has coefficients, so that none of them can vanish at all samples and not in between.
bool Residual::is_flat(double lo, double hi) const {
  for (int i = 0; i <= kFlatSamples; ++i) {
    const double s = lo + (hi - lo) * i / kFlatSamples;
    if (size(s) > kTurnAccuracy + 1e-15 * turning_.perimeter() * steepest(s)) return false;
  }
  return true;
}

/// Pieces that only a cut separates are joined: f is continuous there if it is 0 on both sides.
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

namespace {

// A row on the edge of what is excluded is off by more than the tolerance by at least this share of it.
constexpr double kLeastMiss = 1e-3;
// Two readings are tried together on what is narrower than so many steps: around a corner.
constexpr double kManySteps = 20;

/// The stretches that are in a list and in another one, both by rising s.
std::vector<Interval> common(const std::vector<Interval>& some, const std::vector<Interval>& others) {
  std::vector<Interval> result;
  for (const Interval& one : some) {
    for (const Interval& other : others) {
      const Interval both{std::max(one.lo, other.lo), std::min(one.hi, other.hi)};
      if (both.lo < both.hi) result.push_back(both);
    }
  }
  return result;
}

}  // namespace

Residuals::Residuals(const Part& part, const std::vector<Reading>& readings, double tolerance)
    : part_(part), readings_(readings), tolerance_(tolerance), step_(least_step(part)) {
  for (const Reading& reading : readings) {
    f_.emplace_back(part, reading);
    lengths_.push_back(reading.length[0]);
  }
}

/// max over k of |f_k(s)|, radians.
double Residuals::size(double s) const {
  double largest = 0;
  for (const Residual& f : f_) largest = std::max(largest, f.size(s));
  return largest;
}

bool Residuals::jumps(double lo, double hi) const {
  return std::any_of(f_.begin(), f_.end(), [&](const Residual& f) { return f.jumps(lo, hi); });
}

/// Radians. With several readings `kTurnAccuracy` more, for the rounding of their differences.
double Residuals::edge() const { return (1 + kLeastMiss) * tolerance_ + (f_.size() > 1 ? kTurnAccuracy : 0); }

double Residuals::excluded() const { return f_.size() > 1 ? edge() : tolerance_; }

/// Whether |f| > bound from lo to hi. A row is suggested where |f| is least, if that is inside and below both ends: the
/// cell `apart` claims a share of |f| at its nearer end, which must not be far above the minimum.
std::optional<Exclusion> Residuals::exclusion(const Residual& f, double bound, double lo, double hi) const {
  const double ends = std::min(f.size(lo), f.size(hi));
  // The cheapest test first.
  if (ends <= bound) return std::nullopt;
  const double nearest = clear(f.nearest(lo, hi), 1);
  if (f.size(nearest) <= bound || f.is_near_at_joints(bound, lo, hi)) return std::nullopt;
  const bool is_inside = nearest > lo + step_ && nearest < hi - step_;
  return is_inside && f.size(nearest) < ends ? Exclusion{{}, nearest} : Exclusion{};
}

/// The readings that are furthest off at the nearer end come first.
std::optional<Exclusion> Residuals::exclusion_by_one(double lo, double hi) const {
  const auto miss = [&](std::size_t k) { return std::min(f_[k].size(lo), f_[k].size(hi)); };
  std::vector<std::size_t> order(f_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::size_t one, std::size_t other) { return miss(one) > miss(other); });
  for (const std::size_t k : order) {
    // Order is a matter of cost: the reading that is furthest off is the likeliest to exclude the whole stretch.
    if (const auto found = exclusion(f_[k], excluded(), lo, hi)) return Exclusion{{k}, found->row};
  }
  return std::nullopt;
}

/// At a convex corner where the roll starts Theta(s) is a free angle, the same for all readings. f_j - f_k does not
/// contain it. Where both |f| <= tolerance, |f_j - f_k| <= 2 tolerance: beyond that no start fits.
std::optional<Exclusion> Residuals::exclusion_by_two(double lo, double hi) const {
  for (std::size_t k = 0; k < f_.size(); ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      const Residual f = Residual::difference(part_, readings_[j], readings_[k]);
      if (const auto found = exclusion(f, 2 * excluded(), lo, hi)) return Exclusion{{j, k}, found->row};
    }
  }
  return std::nullopt;
}

/// Two readings cost O(n^2) of their count, and help only at corners: they are tried on narrow stretches alone.
std::optional<Exclusion> Residuals::exclusion(double lo, double hi) const {
  const auto found = exclusion_by_one(lo, hi);
  return found || hi - lo >= kManySteps * step_ ? found : exclusion_by_two(lo, hi);
}

/// The middle, or if a convex corner lies inside, a place four steps beside it: two such halvings leave the corner
/// alone in a narrow cell, to which `exclusion_by_two` applies.
double Residuals::split(double lo, double hi) const {
  const double period = part_.perimeter();
  const double beside = 4 * step_;
  const auto is_inside = [&](double s) { return s > lo + step_ && s < hi - step_; };
  for (const Corner& corner : part_.corners()) {
    if (corner.is_concave()) continue;
    // The corner's first lap from lo on.
    const double s = corner.s + (part_.closed() ? period * std::ceil((lo - corner.s) / period) : 0);
    if (is_inside(s + beside)) return clear(s + beside, 1);
    if (is_inside(s - beside)) return clear(s - beside, -1);
  }
  return clear(0.5 * (lo + hi), 1);
}

/// The intersection over all readings.
std::vector<Interval> Residuals::flat(double lo, double hi) const {
  std::vector<Interval> all = f_[0].flat(lo, hi);
  for (std::size_t k = 1; k < f_.size(); ++k) all = common(all, f_[k].flat(lo, hi));
  return all;
}

}  // namespace rollfix::certifying
