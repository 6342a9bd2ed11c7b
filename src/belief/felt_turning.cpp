#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "belief/posterior.hpp"
#include "belief/two/pair_filter.hpp"
#include "rollfix/pulse.hpp"
#include "rollfix/turning_function.hpp"

// Notation:
//   s, n            a contact's true place, and by how much it was felt elsewhere: n ~ N(0, `sd_`^2)
//   Y               Theta(s + n) + n / r, what the measured normal tells of the tangent; 1 / r is `normal_turn_`
//   E Y, Var Y      `Felt::angle`, `Felt::variance`; d E Y / ds is `Felt::slope`
//   corner_length   how far a finger's centre goes per radian that it pivots: a disk's r
//   pivot           the part of Var Y that neighbouring rows of one pivot have in common: `Felt::pivot`
// Follows docs/two_fingers.md, "The errors", from "Near a corner" on. Integrals by Gauss and
// Legendre's rule of 15 points, kept as a table (`knots_`).
// Idea: near a corner the straight line Theta + kappa n would be wrong; its mean and its variance over n are not.
namespace rollfix::belief {

namespace {

// A normal distribution further out than this many standard deviations holds 6e-7 of its mass.
constexpr double kTail = 5;
// Below this probability of being at a corner the pivot counts in proportion only.
constexpr double kSeldom = 0.01;
// First knots per perimeter; between them the table is refined.
constexpr std::size_t kFirstKnots = 64;
constexpr int kMostKnotHalvings = 14;
// The variance is interpolated to this share of itself, or of what the angles are known to.
constexpr double kShareOfVariance = 0.05;

using Rule = boost::math::quadrature::gauss<double, 15>;

/// Sums over places around s, by how likely each is (`density` times length): of the offset n of a place from s, and of
/// the angle y at it, from a reference.
struct Moments {
  double s;          // where the contact was felt
  double sd;         // of that
  double reference;  // radians: y is small near it, so that squares keep their digits
  double mass = 0;   // sum of weights
  double n = 0;      // weighted sums of n, ...
  double nn = 0;     // ... of its square, and so on
  double y = 0;
  double yn = 0;
  double yy = 0;
  double at_corners = 0;  // of the mass
  double jumps = 0;       // of all corners in reach

  /// `place`: offset from s; `angle`: from the reference.
  void add(double weight, double place, double angle) {
    mass += weight;
    n += weight * place;
    nn += weight * place * place;
    y += weight * angle;
    yn += weight * angle * place;
    yy += weight * angle * angle;
  }

  /// Of an offset, not normalized: `mass` divides it out.
  double density(double place) const { return std::exp(-0.5 * square(place / sd)); }

  /// A smooth stretch [lo, hi], by Gauss and Legendre. `angle`: of the tangent at a place in between.
  template <class Angle>
  void add_stretch(double lo, double hi, const Angle& angle) {
    const double middle = 0.5 * (lo + hi);
    const double half = 0.5 * (hi - lo);
    if (half <= 0) return;
    const auto& nodes = Rule::abscissa();
    const auto& weights = Rule::weights();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      for (const double side : {-1.0, 1.0}) {
        if (k == 0 && side > 0) continue;  // the middle one
        const double at = middle + side * half * nodes[k];
        add(weights[k] * half * density(at - s), at - s, angle(at) - reference);
      }
    }
  }
};

/// Mean, slope and variance of Y = Theta + n / r: Var Y = Var Theta + 2 / r Cov(Theta, n) + Var n / r^2.
Felt felt_by(const Moments& moments, double normal_turn) {
  // Means, variances and the covariance of n and Theta.
  const double mean_n = moments.n / moments.mass;
  const double spread_n = moments.nn / moments.mass - square(mean_n);
  const double mean_angle = moments.y / moments.mass;
  const double both_angle = moments.yn / moments.mass - mean_angle * mean_n;
  const double spread_angle = moments.yy / moments.mass - square(mean_angle);
  const double mean = mean_angle + normal_turn * mean_n;
  const double both = both_angle + normal_turn * spread_n;
  const double spread = spread_angle + normal_turn * (2 * both_angle + normal_turn * spread_n);
  Felt felt;
  felt.angle = moments.reference + mean;
  // The mean's derivative: moving s tilts the density by n / sd^2, and n is counted from there.
  felt.slope = both / square(moments.sd) - normal_turn;
  felt.variance = std::max(0.0, spread);
  // A side and a pivot differ as much as two pivots do: an angle that is anywhere in a range varies by a half of it.
  const double most = std::min(felt.variance, 0.25 * square(moments.jumps));
  felt.pivot = most * std::min(1.0, moments.at_corners / moments.mass / kSeldom);
  return felt;
}

}  // namespace

/// Notes convex corners, jumps of Theta upwards between spirals, and makes the table.
FeltTurning::FeltTurning(const TurningFunction& turning, double sd, double corner_length, double normal_turn,
                         double accuracy)
    : turning_(&turning), sd_(sd), corner_length_(corner_length), normal_turn_(normal_turn) {
  const double P = turning.perimeter();
  lo_ = turning.closed() ? 0 : -2 * kTail * sd;
  hi_ = turning.closed() ? P : P + 2 * kTail * sd;
  const std::vector<Spiral>& spirals = turning.spirals();
  for (std::size_t k = 0; k < spirals.size(); ++k) {
    // An open outline's start is no corner.
    if (k == 0 && !turning.closed()) continue;
    const double before = k > 0 ? spirals[k - 1].end.angle : spirals.back().end.angle - turning.period_turn();
    if (spirals[k].start.angle - before > kTurnAccuracy) corners_.push_back(spirals[k].lo);
  }
  add_knots((hi_ - lo_) / static_cast<double>(kFirstKnots), accuracy);
  std::vector<double> starts;
  for (const Knot& knot : knots_) starts.push_back(knot.s);
  starts.pop_back();
  buckets_ = Buckets(starts, hi_);
}

/// Moments over s - kTail sd to s + kTail sd: along every spiral in reach, and at every corner over all directions of
/// the pivot, which counts as `corner_length_` per radian.
Felt FeltTurning::integrated(double s) const {
  beat();
  const TurningFunction& turning = *turning_;
  const std::vector<Spiral>& spirals = turning.spirals();
  const double P = turning.perimeter();
  const double from = s - kTail * sd_;
  const double to = s + kTail * sd_;
  const double reference = turning.angle(s);
  Moments moments{s, sd_, reference};
  if (!turning.closed()) {
    // Beyond an open outline's ends the tangent goes on.
    moments.add_stretch(from, std::min(to, 0.0), [&](double) { return spirals.front().start.angle; });
    moments.add_stretch(std::max(from, P), to, [&](double) { return spirals.back().end.angle; });
  }
  const double begin = turning.closed() ? from : std::max(from, 0.0);
  const double end = turning.closed() ? to : std::min(to, P);
  if (begin < end) {
    const Wrapped first = turning.closed() ? wrap(begin, P) : Wrapped{begin, 0};
    std::size_t k = turning.spiral_at(first.base);
    double winding = first.winding;
    bool is_first = true;
    double before = 0;  // the tangent where the last spiral ended
    // From spiral to spiral, on to further laps: `shift` and `lift` are the laps' s and Theta.
    while (true) {
      const Spiral& spiral = spirals[k];
      const double shift = winding * P;
      const double lift = winding * turning.period_turn();
      if (spiral.lo + shift >= end) break;
      const double jump = spiral.start.angle + lift - before;
      const double at = spiral.lo + shift;
      if (!is_first && jump > kTurnAccuracy && at > from) {
        // A pivot: every direction in between, alike.
        const double weight = corner_length_ * jump * moments.density(at - s);
        const double middle = before + 0.5 * jump - reference;
        moments.add(weight, at - s, middle);
        moments.at_corners += weight;
        moments.jumps += jump;
        // An even distribution over a range has the variance range^2 / 12 about its middle.
        moments.yy += weight * square(jump) / 12;
      }
      // Halves: over all of the tails one rule is not enough.
      const auto angle = [&](double place) { return turning.on_spiral(spiral, place - shift).angle + lift; };
      moments.add_stretch(std::max(begin, at), std::min({end, spiral.hi + shift, s}), angle);
      moments.add_stretch(std::max({begin, at, s}), std::min(end, spiral.hi + shift), angle);
      before = spiral.end.angle + lift;
      is_first = false;
      if (++k == spirals.size()) {
        if (!turning.closed()) break;
        k = 0;
        winding += 1;
      }
    }
  }
  return felt_by(moments, normal_turn_);
}

/// Knots from lo_ to hi_, so close that Hermite's cubic between two is within `accuracy` in its middle, and the
/// variance within kShareOfVariance. The first are even ones, and some about both ends of every spiral, where the mean
/// may bend.
void FeltTurning::add_knots(double spacing, double accuracy) {
  std::vector<double> first;
  const auto count = static_cast<std::size_t>(std::ceil((hi_ - lo_) / spacing));
  for (std::size_t k = 0; k <= count; ++k) {
    first.push_back(lo_ + (hi_ - lo_) * static_cast<double>(k) / static_cast<double>(count));
  }
  for (const Spiral& spiral : turning_->spirals()) {
    for (const double sigmas : {-4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0}) {
      const double at = spiral.lo + sigmas * sd_;
      if (at > lo_ && at < hi_) first.push_back(at);
      const double across = spiral.hi + sigmas * sd_;
      if (across > lo_ && across < hi_) first.push_back(across);
    }
  }
  std::sort(first.begin(), first.end());
  const double least = 1e-3 * sd_;
  const auto knot_at = [&](double s) { return Knot{s, integrated(s)}; };
  knots_.push_back(knot_at(first.front()));
  struct Task {
    Knot hi;
    int depth;
  };
  for (const double s : first) {
    // Nearer together than `least` no knots are needed.
    if (s - knots_.back().s < least && s != first.back()) continue;
    if (s <= knots_.back().s) continue;
    std::vector<Task> tasks{{knot_at(s), 0}};
    // What is left up to s, the nearest on top: the top begins at the last knot. Halves until it is good.
    while (!tasks.empty()) {
      const Knot lo = knots_.back();
      const Task task = tasks.back();
      const Knot& hi = task.hi;
      const double h = hi.s - lo.s;
      const Knot middle = knot_at(lo.s + 0.5 * h);
      // Hermite's cubic in the middle.
      const double guess = 0.5 * (lo.felt.angle + hi.felt.angle) + 0.125 * h * (lo.felt.slope - hi.felt.slope);
      const double variance = 0.5 * (lo.felt.variance + hi.felt.variance);
      const bool is_good = std::abs(guess - middle.felt.angle) <= accuracy &&
                           std::abs(variance - middle.felt.variance) <=
                               kShareOfVariance * (middle.felt.variance + square(accuracy) / kShareOfVariance);
      if (!is_good && task.depth < kMostKnotHalvings && h > 2 * least) {
        tasks.back().depth += 1;
        tasks.push_back({middle, task.depth + 1});
        continue;
      }
      knots_.push_back(middle);
      knots_.push_back(hi);
      tasks.pop_back();
    }
  }
}

/// From the table: the mean by Hermite's cubic, variances on straight lines between knots.
Felt FeltTurning::at(double s) const {
  double base = s;
  double lift = 0;
  if (turning_->closed()) {
    const Wrapped wrapped = wrap(s, turning_->perimeter());
    base = wrapped.base;
    lift = wrapped.winding * turning_->period_turn();
    // An open outline's table ends 2 kTail sd beyond it.
  } else if (s <= lo_ || s >= hi_) {
    return {s <= lo_ ? knots_.front().felt.angle : knots_.back().felt.angle, 0, 0};
  }
  std::size_t k = buckets_.before(base);
  while (k + 2 < knots_.size() && knots_[k + 1].s <= base) ++k;
  const Knot& lo = knots_[k];
  const Knot& hi = knots_[k + 1];
  const double h = hi.s - lo.s;
  const double x = base - lo.s;
  const HermiteCubic cubic = HermiteCubic::through(h, hi.felt.angle - lo.felt.angle, lo.felt.slope, hi.felt.slope);
  return {lo.felt.angle + cubic.at(x) + lift, cubic.slope(x),
          lo.felt.variance + (hi.felt.variance - lo.felt.variance) * x / h,
          lo.felt.pivot + (hi.felt.pivot - lo.felt.pivot) * x / h};
}

/// The nearest corner, if it is within kTail sd. REQUIRES has_corners().
std::optional<double> FeltTurning::corner_at(double s) const {
  const double P = turning_->perimeter();
  const Wrapped wrapped = turning_->closed() ? wrap(s, P) : Wrapped{s, 0};
  const auto above = std::lower_bound(corners_.begin(), corners_.end(), wrapped.base);
  // An open outline has none beyond its ends.
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double first = turning_->closed() ? corners_.front() + P : kNone;
  const double last = turning_->closed() ? corners_.back() - P : -kNone;
  const double next = above != corners_.end() ? *above : first;
  const double before = above != corners_.begin() ? *(above - 1) : last;
  const double nearest = next - wrapped.base < wrapped.base - before ? next : before;
  if (std::abs(nearest - wrapped.base) > kTail * sd_) return std::nullopt;
  return nearest + wrapped.winding * P;
}

}  // namespace rollfix::belief
