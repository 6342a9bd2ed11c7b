#include "belief/tilted_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "rollfix/turning_function.hpp"

// Notation:
//   c               the tilt, above every -kappa; for a disk 1 / r: `tilt_`
//   w               Theta + c s, which grows along the boundary and through convex corners: `w`
//   s(w)            place on the boundary, piecewise cubic: `Cell::cubic` from `Cell::s` on
//   m               ds/dw = 1 / (kappa + c), 0 in a corner: `slope`
//   kink            a w where m jumps: a corner, a joint of the curvature, an end of an arc
//   fold            one of m equal parts of a boundary that repeats itself: `folds_`
// Follows docs/belief.md, "The computation". In `about` a normal distribution of w is taken at its mean and at sqrt(3)
// standard deviations on both sides, with the weights 2/3, 1/6, 1/6 of the Gauss-Hermite rule of three points.
// Idea: by w a contact is told by one number everywhere, at corners too; s is a continuous function of it. An arc ends
// only at concave corners and at the ends of an open boundary, which no finger rolls over or pivots at.
namespace rollfix::belief {

namespace {

// s as a function of w need not be better than this share of what a contact is known to, nor than that of the
// perimeter; and it is no worse than the last.
constexpr double kShareOfNoise = 1e-3;
constexpr double kShareOfPerimeter = 1e-9;
constexpr double kLeastAccuracy = 1e-4;
// A tilt that is asked for: at least as many full turns per perimeter, at most as many radians.
constexpr double kLeastTurns = 4;
constexpr double kMostTilt = 1e6;
// kappa + c is at least this share of c: where it vanished, s would jump as w grows.
constexpr double kLeastSlopeShare = 0.5;
// Halvings of a spiral: by then a cubic is as good as the turning function.
constexpr int kMostHalvings = 24;
// Equal steps of w for each cell, so that few cells begin within one.
constexpr std::size_t kBucketsPerCell = 2;
// Newton's steps for the w of a place: its cell's cubic is nearly straight.
constexpr int kRoundsOfPlace = 2;
// So many standard deviations beyond an arc's end are a contact's that rests there, with its noise.
constexpr double kOfNoise = 4;
// Slopes that differ by more than this share of the larger one make a kink.
constexpr double kKink = 1e-3;
// Rows that are joined lie on a parabola where the slope changes by less than this share among them.
constexpr double kBend = 0.02;
// Places look alike where s is the same to this share of the perimeter: to what it is known to as a function of w.
constexpr double kAlike = kShareOfPerimeter;
// No more folds are looked for: a grid begins with about as many cells, so that more folds would save nothing.
constexpr std::size_t kMostFolds = 64;

/// Solves Theta + c s = w for s on [lo, hi], where it grows: Newton's steps, kept within.
double place_of(const TurningFunction& turning, const Spiral& spiral, double tilt, double w, double lo, double hi) {
  // The root stays within [lo, hi]: a step of Newton's that leaves it becomes a bisection.
  double s = 0.5 * (lo + hi);
  for (int round = 0; round < 60; ++round) {
    const Turning here = turning.on_spiral(spiral, s);
    const double miss = here.angle + tilt * s - w;
    (miss > 0 ? hi : lo) = s;
    const double next = s - miss / (here.curvature + tilt);
    const double last = s;
    s = next > lo && next < hi ? next : 0.5 * (lo + hi);
    if (std::abs(s - last) <= 4e-16 * (std::abs(s) + std::abs(hi - lo))) break;
  }
  return s;
}

/// The least kappa anywhere, at most 0. On a spiral kappa is monotone: its ends have the least.
double least_curvature(const TurningFunction& turning) {
  double least = 0;
  for (const Spiral& spiral : turning.spirals()) {
    least = std::min({least, spiral.start.curvature, spiral.end.curvature});
  }
  return least;
}

}  // namespace

Buckets::Buckets(const std::vector<double>& starts, double end) : lo_(starts.front()) {
  const std::size_t count = kBucketsPerCell * starts.size();
  per_length_ = static_cast<double>(count) / (end - lo_);
  first_.resize(count);
  std::size_t at = 0;
  for (std::size_t k = 0; k < count; ++k) {
    // A step earlier, so that rounding can't make a number precede its bucket's.
    const double from = lo_ + (static_cast<double>(k) - 1) / per_length_;
    while (at + 1 < starts.size() && starts[at + 1] <= from) ++at;
    first_[k] = at;
  }
}

/// Beyond the ends of an arc that is no loop a contact stays at the end.
TiltedPlace TiltedArc::at(double w) const {
  if (!loop_ && w <= lo()) return {cells_.front().s, 0};
  if (!loop_ && w >= hi_) return {end_, 0};
  return on(find(w));
}

/// s grows with w: the last cell that begins at or before s has it, and Newton's steps find where.
double TiltedArc::w_at(double s) const {
  double base = s;
  double shift = 0;
  if (loop_) {
    const Wrapped wrapped = wrap(s - cells_.front().s, perimeter_);
    base = cells_.front().s + wrapped.base;
    shift = wrapped.winding * (hi_ - lo());
  }
  if (base <= cells_.front().s) return lo() + shift;
  if (!loop_ && base >= end_) return hi_;
  const auto next =
      std::upper_bound(cells_.begin(), cells_.end(), base, [](double at, const Cell& cell) { return at < cell.s; });
  const Cell& cell = *(next - 1);
  const double width = (next == cells_.end() ? hi_ : next->w) - cell.w;
  double x = 0.5 * width;
  for (int round = 0; round < kRoundsOfPlace; ++round) {
    const double slope = cell.cubic.slope(x);
    if (!(slope > 0)) break;
    x = std::clamp(x + (base - cell.s - cell.cubic.at(x)) / slope, 0.0, width);
  }
  return cell.w + x + shift;
}

/// Rows are spread evenly with variance `spread` about a w that is normal with `variance`. Where no kink is within
/// reach and s(w) bends little among the rows, its tangent serves, and the mean of rows is off by half the bend times
/// their variance. Else the line is that of least squares through three points, and what it misses is a variance.
SpreadPlace TiltedArc::about(double w, double variance, double spread) const {
  const double reach = kSigmaPoint * std::sqrt(variance + spread);
  if (loop_ || (w > lo() && w < hi_)) {
    const Found found = find(w);
    const TiltedPlace place = on(found);
    // d2s/dw2 of the cell's cubic.
    const double bend = 2 * (found.cell->cubic.b + 3 * found.x * found.cell->cubic.c);
    const bool is_straight = bend * bend * spread <= kBend * kBend * place.slope * place.slope;
    if (is_straight && found.x - reach > found.cell->kink_below && found.x + reach < found.cell->kink_above) {
      return {place.s + 0.5 * bend * spread, place.slope, 0};
    }
  }
  // Three points stand for the distribution: weights 1/6, 2/3, 1/6 serve a normal one as well as an even one.
  const SigmaLine line = SigmaLine::through(at(w - reach).s, at(w).s, at(w + reach).s, reach);
  SpreadPlace place{line.mean, line.slope, line.variance};
  const double past = loop_ ? 0 : std::max(lo() - w, w - hi_);
  const double sd = std::sqrt(variance + spread);
  if (past > kOfNoise * sd && sd > 0) {
    place.beyond = past / sd - kOfNoise;
    place.beyond_by_w = (w > hi_ ? 1 : -1) / sd;
  }
  return place;
}

/// Both sides of a small concave joint reach w: the cells before that begin above w are dropped, the one after is cut.
void TiltedArc::join(std::size_t begin, double w) {
  std::size_t before = begin;
  while (before > 1 && cells_[before - 1].w >= w) --before;
  std::size_t after = begin;
  while (after + 1 < cells_.size() && cells_[after + 1].w <= w) ++after;
  Cell& cut = cells_[after];
  // The cubic about its new start: value, slope and second derivative as there.
  const double x = w - cut.w;
  const HermiteCubic& cubic = cut.cubic;
  cut = {w, cut.s + cubic.at(x), {cubic.slope(x), cubic.b + 3 * x * cubic.c, cubic.c}};
  cells_.erase(cells_.begin() + static_cast<std::ptrdiff_t>(before),
               cells_.begin() + static_cast<std::ptrdiff_t>(after));
}

/// Where the slope jumps from cell to cell by more than kKink, and how far each cell is from the nearest such w.
void TiltedArc::mark_kinks() {
  const std::size_t count = cells_.size();
  const auto slope_before = [&](std::size_t k) {
    // Before an arc's start s does not grow: the start is a kink, and so is the end.
    if (k == 0 && !loop_) return 0.0;
    const Cell& cell = cells_[k == 0 ? count - 1 : k - 1];
    const double x = (k == 0 ? hi_ : cells_[k].w) - cell.w;
    return cell.cubic.slope(x);
  };
  for (std::size_t k = 0; k < count; ++k) {
    const double before = slope_before(k);
    if (std::abs(cells_[k].cubic.a - before) > kKink * std::max(cells_[k].cubic.a, before)) {
      kinks_.push_back(cells_[k].w);
    }
  }
  if (!loop_) kinks_.push_back(hi_);
  std::vector<double> kinks = kinks_;
  // On a loop the last kink is before the first, and the first after the last, a lap away.
  if (loop_ && !kinks.empty()) {
    const double last = kinks.back();
    kinks.push_back(kinks.front() + (hi_ - lo()));
    kinks.insert(kinks.begin(), last - (hi_ - lo()));
  }
  constexpr double kNone = std::numeric_limits<double>::infinity();
  for (Cell& cell : cells_) {
    const auto above = std::upper_bound(kinks.begin(), kinks.end(), cell.w);
    cell.kink_above = above == kinks.end() ? kNone : *above - cell.w;
    cell.kink_below = above == kinks.begin() ? -kNone : *(above - 1) - cell.w;
  }
}

/// Arcs begin and end at concave corners and at an open outline's ends. Each spiral adds cubics, each convex corner a
/// cell on which s stays. A closed outline without concave corners is one loop.
TiltedBoundary::TiltedBoundary(const Part& part, double least, double accuracy) {
  const TurningFunction& turning = part.turning();
  const std::vector<Spiral>& spirals = turning.spirals();
  const std::size_t count = spirals.size();
  // kappa + c >= kLeastSlopeShare c everywhere, as c >= -kappa / (1 - kLeastSlopeShare).
  tilt_ = std::max(least, -least_curvature(turning) / (1 - kLeastSlopeShare));
  // A hole turns by -2 pi: w must grow all the same.
  tilt_ = std::max(tilt_, -2 * turning.period_turn() / turning.perimeter());

  perimeter_ = turning.perimeter();
  all_w_ = tilt_ * perimeter_ + turning.period_turn();

  // The jump of Theta in front of a spiral, and whether a finger gets over it.
  const auto jump_before = [&](std::size_t k) {
    if (k > 0) return spirals[k].start.angle - spirals[k - 1].end.angle;
    return part.closed() ? spirals.front().start.angle + turning.period_turn() - spirals.back().end.angle : 0.0;
  };
  // A closed outline with a concave corner is begun at it: no arc goes on across the seam.
  std::size_t first = 0;
  bool is_cut = !part.closed();
  for (std::size_t k = 0; k < count && !is_cut; ++k) {
    if (jump_before(k) <= -kJointTurn) {
      first = k;
      is_cut = true;
    }
  }

  for (std::size_t n = 0; n < count; ++n) {
    // Spirals beyond the seam are a lap further on.
    const std::size_t k = (first + n) % count;
    const double winding = first + n >= count ? 1 : 0;
    const double jump = jump_before(k);
    // At a concave corner no finger rolls on: a new arc.
    if (n == 0 || jump <= -kJointTurn) {
      arcs_.emplace_back();
      arcs_.back().loop_ = !is_cut;
      arcs_.back().perimeter_ = turning.perimeter();
    }
    TiltedArc& arc = arcs_.back();
    const double s = spirals[k].lo + winding * turning.perimeter();
    const double w = spirals[k].start.angle + winding * turning.period_turn() + tilt_ * s;
    const bool goes_on = n > 0 && jump > -kJointTurn;
    if ((goes_on || arc.loop_) && jump > kTurnAccuracy) {
      arc.cells_.push_back({w - jump, s, {}});  // a convex corner: w grows, s stays
    }
    const std::size_t spiral_begin = arc.cells_.size();
    add_spiral(turning, spirals[k], winding, accuracy, arc);
    // Rounded digits turned inwards: the finger touches both sides at once, and goes from one to the other.
    if (goes_on && jump < 0) arc.join(spiral_begin, w - 0.5 * jump);
  }
  for (TiltedArc& arc : arcs_) {
    // A loop ends where it begins, one lap on; cells that rounding put beyond are dropped.
    if (arc.loop_) arc.hi_ = arc.lo() + all_w_;
    while (arc.cells_.back().w >= arc.hi_) arc.cells_.pop_back();
    arc.mark_kinks();
    std::vector<double> starts;
    for (TiltedArc::Cell& cell : arc.cells_) {
      starts.push_back(cell.w);
      cell.end = &cell == &arc.cells_.back() ? std::numeric_limits<double>::infinity() : (&cell + 1)->w;
    }
    arc.buckets_ = Buckets(starts, arc.hi_);
  }
  if (part.closed()) folds_ = count_folds();
}

/// The largest m for which the boundary repeats itself after one m-th of it; at most one fold for each cell. Several
/// arcs must repeat as a whole number of arcs.
std::size_t TiltedBoundary::count_folds() const {
  std::size_t cells = 0;
  for (const TiltedArc& arc : arcs_) cells += arc.cells_.size();
  for (std::size_t folds = std::min(cells, kMostFolds); folds > 1; --folds) {
    if (!arcs_.front().loop() && arcs_.size() % folds != 0) continue;
    const auto share = 1 / static_cast<double>(folds);
    const std::size_t arcs = arcs_.front().loop() ? 0 : arcs_.size() / folds;
    if (repeats_after({arcs, all_w_ * share, perimeter_ * share})) return folds;
  }
  return 1;
}

/// Whether s(w + shift.w) = s(w) + shift.s on all arcs, the ends of arcs included. A cell's cubic is known by its ends
/// and two places in between.
bool TiltedBoundary::repeats_after(const Shift& shift) const {
  for (std::size_t a = 0; a + shift.arcs < arcs_.size(); ++a) {
    const TiltedArc& arc = arcs_[a];
    const TiltedArc& other = arcs_[a + shift.arcs];
    const auto is_alike = [&](double w) {
      return std::abs(other.at(w + shift.w).s - arc.at(w).s - shift.s) <= kAlike * perimeter_;
    };
    const double slack = kAlike * all_w_;
    if (!arc.loop() && std::abs(other.lo() - arc.lo() - shift.w) > slack) return false;
    if (!arc.loop() && std::abs(other.hi() - arc.hi() - shift.w) > slack) return false;
    for (const TiltedArc::Cell& cell : arc.cells_) {
      const double third = (std::min(cell.end, arc.hi()) - cell.w) / 3;
      if (!is_alike(cell.w) || !is_alike(cell.w + third) || !is_alike(cell.w + 2 * third)) return false;
    }
  }
  return true;
}

/// Folds are equal: so many m-ths of w, of s and of the arcs. A loop has one arc.
Shift TiltedBoundary::shift(std::size_t folds) const {
  const double share = static_cast<double>(folds) / static_cast<double>(folds_);
  return {arcs_.front().loop() ? 0 : folds * (arcs_.size() / folds_), all_w_ * share, perimeter_ * share};
}

/// Cubics through s(w) and its slope at both ends, on halves of the spiral until the middle is within `accuracy`.
/// `winding`: laps of s.
void TiltedBoundary::add_spiral(const TurningFunction& turning, const Spiral& spiral, double winding, double accuracy,
                                TiltedArc& arc) const {
  const double shift = winding * turning.perimeter();
  const double lift = winding * turning.period_turn() + tilt_ * shift;
  struct Knot {
    double s;
    double w;
    double slope;  // ds/dw
  };
  const auto knot_at = [&](double s, const Turning& here) {
    return Knot{s, here.angle + tilt_ * s, 1 / (here.curvature + tilt_)};
  };
  struct Task {
    Knot lo;
    Knot hi;
    int depth;
  };
  std::vector<Task> tasks{{knot_at(spiral.lo, spiral.start), knot_at(spiral.hi, spiral.end), 0}};
  // The stack has the rest of the spiral in order of w: its top begins where the last cell ends.
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const double h = task.hi.w - task.lo.w;
    // No length: nothing to add.
    if (h <= 0) continue;
    const HermiteCubic cubic = HermiteCubic::through(h, task.hi.s - task.lo.s, task.lo.slope, task.hi.slope);
    const double x = 0.5 * h;
    const double guess = task.lo.s + cubic.at(x);
    const double s = place_of(turning, spiral, tilt_, task.lo.w + x, task.lo.s, task.hi.s);
    if (task.depth < kMostHalvings && std::abs(guess - s) > accuracy) {
      const Turning here = turning.on_spiral(spiral, s);
      const Knot middle = knot_at(s, here);
      tasks.push_back({middle, task.hi, task.depth + 1});
      tasks.push_back({task.lo, middle, task.depth + 1});
      continue;
    }
    arc.cells_.push_back({task.lo.w + lift, task.lo.s + shift, cubic});
  }
  arc.hi_ = spiral.end.angle + tilt_ * spiral.hi + lift;
  arc.end_ = spiral.hi + shift;
}

/// Bounded on both sides where no finger's curvature is known, or of a jaw. 1 / length.
double tilt_of(double finger_curvature, double even, const Part& part) {
  const double P = part.perimeter();
  if (finger_curvature > 0) return finger_curvature;
  return std::min(std::max(even, kLeastTurns * 2 * std::numbers::pi / P), kMostTilt / P);
}

/// Of s, between kShareOfPerimeter and kLeastAccuracy of the perimeter. Length.
double accuracy_of(double contact_sd, const Part& part) {
  const double P = part.perimeter();
  return std::min(std::max(kShareOfPerimeter * P, kShareOfNoise * contact_sd), kLeastAccuracy * P);
}

/// r, or P / 2 pi.
double corner_length(double finger_curvature, const Part& part) {
  return finger_curvature > 0 ? 1 / finger_curvature : part.perimeter() / (2 * std::numbers::pi);
}

}  // namespace rollfix::belief
