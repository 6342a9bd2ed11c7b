#include "line_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "locate/searches.hpp"
#include "work/pulse.hpp"

// Notation:
//   x, y            the free contact and the bound one: `Place::free.x`, `Place::bound.x`; `free_is_a_` says which is
//                   a's
//   g               the guide, the equation that is solved for y: `guide_`; A_g(x) - B_g(y) = 0 makes y a function of x
//   dy/dx           A_g' / B_g': `direction`
//   r_k(x)          the other equations along that line: `residual`; dr_k/dx = A_k' - B_k' dy/dx: `residual_slope`
//   margin          tolerance / least |B_g'|: how far y may be off the line while the guide is within the tolerance
//   within_k        tolerance (1 + |B_k' / B_g'|): what r_k may be, for the guide may be off as well
// (A is the free finger's curve here, whichever finger that is.)
// Follows eqs. (8) and (9) of the paper (Jia, IROS 2001); docs/search.md, "Two fingers", steps 4 and 5. Overlaps are
// found in family_line.cpp.
// Idea: where both curves run alongside each other J is singular, but one equation is steep. It leaves one variable,
// and the others are searched along x by branch and prune, with bounds on their slopes, as root_search.cpp does.
namespace rollfix::locating {
namespace {

// The guide's slope must be at least this share of the steepest slope in the box, so that no error is blown up.
constexpr double kGuideShare = 0.05;
// The set within the tolerance is taken as a band about the line: no wider than the box by this factor.
constexpr double kWidestBand = 1;
// Rounds of Newton's method or bisection at most.
constexpr int kMostLineRounds = 100;
// How far a band may bend, in parts of its half width, to be taken as straight.
constexpr double kBandBend = 0.5;
// A residual that leaves its chord by this share of the tolerance is taken as straight.
constexpr double kStraightShare = 0.1;

// Newton's step below this share of a side leaves less than rounding.
constexpr double kLastSideStep = 1e-10;

/// Where one component of a side, monotone, has this value: Newton's method, kept in the bracket by bisection. Beyond
/// the side's ends the component is continued by its tangents there.
double solve_side(const BoxSide& side, std::size_t row, double target) {
  const PlaneCurve::Component& component = side.component(row);
  const double rise = component.last - component.first;
  double lo = side.lo();
  double hi = side.hi();
  const double share = rise == 0 ? 0.5 : (target - component.first) / rise;
  if (share <= 0 || share >= 1) {  // beyond an end the continuation is straight
    return share <= 0 ? lo + (target - component.first) / component.first_slope
                      : hi + (target - component.last) / component.last_slope;
  }
  double x = lo + share * (hi - lo);
  const bool rises = rise > 0;
  for (int round = 0; round < kMostLineRounds; ++round) {
    const PlaneCurve::Place at = side.place(x, row);
    const double off = at.value - target;
    if (off == 0) break;
    ((off > 0) == rises ? hi : lo) = x;
    const double newton = x - off / at.slope;
    const bool is_inside = newton > lo && newton < hi;
    const double next = is_inside ? newton : 0.5 * (lo + hi);
    const double step = std::abs(next - x);
    if (step <= 1e-16 * (std::abs(x) + side.width())) break;
    x = next;
    if (is_inside && step <= kLastSideStep * side.width()) break;
  }
  return x;
}

}  // namespace

LineSearch::LineSearch(const PairBoxSides& sides, const PairLimits& limits, std::size_t& budget, PairFindings& findings)
    : sides_(sides), limits_(limits), budget_(budget), findings_(findings) {}

bool LineSearch::run() {
  if (!choose_guide()) return false;
  // The whole line across the free side. It may leave the box through the bound side's ends.
  Stretch all{place(free().lo()), place(free().hi()), 0, limits_.covered};
  waiting_.push_back(std::move(all));
  while (!waiting_.empty()) {
    Stretch stretch = std::move(waiting_.back());
    waiting_.pop_back();
    decide(std::move(stretch));
  }
  return true;
}

/// Chooses as guide the equation and the contact whose slope has the largest lower bound in size, with one sign: there
/// the equation has one solution y for each x, and the least error in y. Sets `margin_`.
bool LineSearch::choose_guide() {
  double steepest = 0;
  for (std::size_t row = 0; row < sides_.a.rows(); ++row) {
    steepest = std::max({steepest, sides_.a.slope(row).size(), sides_.b.slope(row).size()});
  }
  // The largest lower bound on a slope's size so far: the guide's |B_g'|.
  double best = kGuideShare * steepest;
  bool found = false;
  for (std::size_t row = 0; row < sides_.a.rows(); ++row) {
    for (const bool a_is_free : {true, false}) {
      const Range slope = (a_is_free ? sides_.b : sides_.a).slope(row);
      if (!slope.has_sign()) continue;
      const double least = std::min(std::abs(slope.least), std::abs(slope.most));
      if (least <= best) continue;
      best = least;
      found = true;
      free_is_a_ = a_is_free;
      guide_ = row;
    }
  }
  if (!found) return false;
  // |g| <= tolerance on a slope of at least `best`.
  margin_ = limits_.tolerance / best;
  return margin_ <= kWidestBand * bound().width();
}

LineSearch::Place LineSearch::place(double x) const {
  CurvePoint free = this->free().point(x);
  const double y = bound_at(free.value(guide_));
  return {std::move(free), bound().point(y)};
}

/// Where the other contact is while the guide's component of the free one has this value.
double LineSearch::bound_at(double value) const {
  // g = A - B - shift = 0 with A of finger a: solved for whichever of the two is bound.
  const double shift = sides_.shift(guide_, limits_);
  return solve_side(bound(), guide_, value - (free_is_a_ ? shift : -shift));
}

double LineSearch::residual(const Place& place, std::size_t row) const {
  const double difference = place.free.value(row) - place.bound.value(row);
  return (free_is_a_ ? difference : -difference) - sides_.shift(row, limits_);
}

double LineSearch::direction(const Place& place) const { return place.free.slope(guide_) / place.bound.slope(guide_); }

double LineSearch::residual_slope(const Place& place, std::size_t row) const {
  // By the chain rule, y following x along the line.
  const double slope = place.free.slope(row) - place.bound.slope(row) * direction(place);
  return free_is_a_ ? slope : -slope;
}

/// Bounds by interval arithmetic on a stretch: on y, dy/dx = A_g' / B_g', dr_k/dx = A_k' - B_k' dy/dx, and the
/// tolerance of each r_k.
LineSearch::Bounds LineSearch::bounds(const Stretch& stretch) const {
  const double width = stretch.hi.free.x - stretch.lo.free.x;
  Bounds bounds;
  const Range guide_free = free().slope_between(stretch.lo.free, stretch.hi.free, guide_);
  // y is monotone along the stretch if A_g' keeps its sign (B_g' does): then its ends bound it.
  const Range ends = hull(stretch.lo.bound.x, stretch.hi.bound.x);
  CurvePoint bound_lo = stretch.lo.bound;
  CurvePoint bound_hi = stretch.hi.bound;
  bounds.bound_x = ends;
  if (!guide_free.keeps_sign()) {  // the line may swing out beyond its ends
    bounds.bound_x = value_range(stretch.lo.bound.x, stretch.hi.bound.x, guide_free / bound().slope(guide_), width);
    bound_lo = bound().point(bounds.bound_x.least);
    bound_hi = bound().point(bounds.bound_x.most);
  }
  const Range guide_bound = bound().slope_between(bound_lo, bound_hi, guide_);
  bounds.direction = guide_free / guide_bound;
  for (std::size_t row = 0; row < free().rows(); ++row) {
    const Range slope_free = free().slope_between(stretch.lo.free, stretch.hi.free, row);
    const Range slope_bound = bound().slope_between(bound_lo, bound_hi, row);
    const Range slope = slope_free - slope_bound * bounds.direction;
    bounds.slope.push_back(free_is_a_ ? slope : Range{-slope.most, -slope.least});
    // Within the tolerance g may be off by it, y by tolerance / |B_g'|, and r_k by |B_k'| times that, besides its own.
    const double tolerance = stretch.covered ? kTurnAccuracy : limits_.tolerance;
    bounds.within.push_back(row == guide_ ? tolerance : tolerance * (1 + (slope_bound / guide_bound).size()));
  }
  return bounds;
}

PairPoint LineSearch::contacts(const Place& place) const {
  const double x = std::clamp(place.free.x, free().lo(), free().hi());
  const double y = std::clamp(place.bound.x, bound().lo(), bound().hi());
  return free_is_a_ ? PairPoint{sides_.a.s(x), sides_.b.s(y)} : PairPoint{sides_.a.s(y), sides_.b.s(x)};
}

bool LineSearch::is_inside(const Place& place) const {
  // y is known to the accuracy of g over its slope.
  const double slack = bound().same_place(limits_) + kTurnAccuracy / std::abs(place.bound.slope(guide_));
  return place.bound.x >= bound().lo() - slack && place.bound.x <= bound().hi() + slack;
}

bool LineSearch::turns_round(const Stretch& stretch) const {
  return !free().slope_between(stretch.lo.free, stretch.hi.free, guide_).keeps_sign();
}

/// Cuts off what lies beyond the other contact's side by more than the margin. False: nothing is left. A line that
/// turns round is left as it is.
bool LineSearch::clip(Stretch& stretch, double margin) const {
  const double least = bound().lo() - margin;
  const double most = bound().hi() + margin;
  const double lo = stretch.lo.bound.x;
  const double hi = stretch.hi.bound.x;
  if (turns_round(stretch)) return true;
  if (std::max(lo, hi) < least || std::min(lo, hi) > most) return false;
  // y is monotone along the stretch: each edge is met once at most.
  const Stretch whole = stretch;
  if (lo < least || lo > most) stretch.lo = at_edge(whole, lo < least ? least : most);
  if (hi < least || hi > most) stretch.hi = at_edge(whole, hi < least ? least : most);
  return stretch.hi.free.x >= stretch.lo.free.x;
}

/// Where the line, monotone in y, reaches y = edge: Newton's method from the chord, kept in the bracket by bisection.
LineSearch::Place LineSearch::at_edge(const Stretch& stretch, double edge) const {
  double lo = stretch.lo.free.x;
  double hi = stretch.hi.free.x;
  const bool rises = stretch.hi.bound.x > stretch.lo.bound.x;
  double x = lo + (hi - lo) * (edge - stretch.lo.bound.x) / (stretch.hi.bound.x - stretch.lo.bound.x);
  Place at = place(std::clamp(x, lo, hi));
  for (int round = 0; round < kMostLineRounds; ++round) {
    x = at.free.x;
    const double off = at.bound.x - edge;
    if (std::abs(off) <= 1e-3 * bound().same_place(limits_)) break;
    ((off > 0) == rises ? hi : lo) = x;
    double next = x - off / direction(at);
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (next == x || !(next > lo && next < hi)) break;
    at = place(next);
  }
  return at;
}

/// Leaves both halves to be decided, the lower one first.
void LineSearch::split(const Stretch& stretch) {
  const Place middle = place(0.5 * (stretch.lo.free.x + stretch.hi.free.x));
  waiting_.push_back({middle, stretch.hi, stretch.depth + 1, stretch.covered});
  waiting_.push_back({stretch.lo, middle, stretch.depth + 1, stretch.covered});
}

void LineSearch::decide(Stretch stretch) {
  beat();
  ++findings_.counts.intervals;
  // Beyond the bound side by more than the margin nothing of the box is within the tolerance.
  if (!clip(stretch, margin_)) return;
  const Bounds along = bounds(stretch);
  if (along.bound_x.most < bound().lo() - margin_ || along.bound_x.least > bound().hi() + margin_) return;
  const double width = stretch.hi.free.x - stretch.lo.free.x;
  const std::size_t rows = free().rows();
  double size = 0;  // of the residuals, against their tolerances
  double spread = 0;
  double turn = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    if (row == guide_) continue;
    // The cone on r_k misses its tolerance: nothing is on this stretch.
    const Range r = value_range(residual(stretch.lo, row), residual(stretch.hi, row), along.slope[row], width);
    if (r.least > along.within[row] || r.most < -along.within[row]) return;
    size = std::max(size, r.size() / along.within[row]);
    spread = std::max(spread, r.spread() / along.within[row]);
    turn = std::max(turn, r.size());
  }
  // Before halving, which would never end on an overlap.
  std::vector<Place> samples;
  if (overlaps(stretch, samples)) {
    take_overlap(stretch, std::move(samples));
    return;
  }
  if (stretch.depth > 0 && budget_ == 0) {
    const PairPoint lo = contacts(stretch.lo);
    const PairPoint hi = contacts(stretch.hi);
    const Range s = hull(lo[0], hi[0]);
    const Range t = hull(lo[1], hi[1]);
    findings_.unresolved.push_back({Interval{s.least, s.most}, Interval{t.least, t.most}});
    return;
  }
  if (stretch.depth > 0) --budget_;
  // A stretch as short as rounding, or one on which every r_k is 0 to rounding: no halving can tell more.
  const bool tiny = width <= free().same_place(limits_);
  const bool zero = turn <= kTurnAccuracy && !turns_round(stretch);
  if (!tiny && !zero) {
    // One residual is monotone: at most one root, and an interval within its tolerance.
    const std::size_t row = steepest(along);
    if (row != guide_) {
      take_monotone(stretch, along, row);
      return;
    }
  }
  // Straight enough to be a band, and all of it in or out, or surely within the tolerance.
  const bool straight = along.direction.spread() * width <= kBandBend * margin_;
  if (tiny || (straight && (size <= 1 || spread <= kSmallVariation || zero))) {
    if (take_flat(stretch, along, tiny || zero)) return;
    stretch.covered = true;  // its roots are left to be found
  }
  split(stretch);
}

/// The row whose residual is surely monotone and steepest, by the lower bound on its slope; the guide where there is
/// none.
std::size_t LineSearch::steepest(const Bounds& along) const {
  std::size_t best = guide_;
  double steepness = 0;
  for (std::size_t row = 0; row < free().rows(); ++row) {
    if (row == guide_ || !along.slope[row].has_sign()) continue;
    const double least = std::min(std::abs(along.slope[row].least), std::abs(along.slope[row].most));
    if (least > steepness) {
      steepness = least;
      best = row;
    }
  }
  return best;
}

/// The residuals vary by less than a share of their tolerances, or are within them all along: all of the stretch is in
/// or out as its middle is. `is_point`: no halving can tell more. False: the stretch is listed, and its roots are still
/// to be found.
bool LineSearch::take_flat(const Stretch& stretch, const Bounds& along, bool is_point) {
  const Place middle = place(stretch.lo.free.x + 0.5 * (stretch.hi.free.x - stretch.lo.free.x));
  double largest = 0;
  for (std::size_t row = 0; row < free().rows(); ++row) {
    if (row == guide_) continue;
    const double r = std::abs(residual(middle, row));
    if (r > along.within[row]) return true;
    largest = std::max(largest, r);
  }
  // Within each tolerance on the line, and yet perhaps nowhere within all of them.
  if (passes_by(stretch.lo, stretch.hi, along.bound_x)) return true;
  if (!stretch.covered) add_piece(stretch.lo, stretch.hi, along.bound_x);
  if (!is_point && !stretch.covered) return false;
  if (largest <= kTurnAccuracy && is_inside(middle)) add_root(middle, 0, true);
  return true;
}

/// Lists the part of the stretch that is within the tolerance, and the root in it if there is one.
void LineSearch::take_monotone(const Stretch& stretch, const Bounds& along, std::size_t row) {
  const double within = along.within[row];
  const double at_lo = residual(stretch.lo, row);
  const double at_hi = residual(stretch.hi, row);
  // A monotone residual lies between its values at the ends.
  if (std::min(at_lo, at_hi) > within || std::max(at_lo, at_hi) < -within) return;
  // Where the monotone residual comes within its tolerance, and where it leaves it.
  Place lo = std::abs(at_lo) <= within ? stretch.lo : solve(row, std::copysign(within, at_lo), stretch.lo, stretch.hi);
  Place hi = std::abs(at_hi) <= within ? stretch.hi : solve(row, std::copysign(within, at_hi), stretch.lo, stretch.hi);
  // The other equations narrow what this one leaves; on so short a stretch they are straight.
  for (std::size_t other = 0; other < free().rows(); ++other) {
    if (other == guide_ || other == row) continue;
    const double from = residual(lo, other);
    const double to = residual(hi, other);
    const double most = along.within[other];
    if (std::min(from, to) > most || std::max(from, to) < -most) return;
    const double start = lo.free.x;
    const double width = hi.free.x - start;
    const auto reached = [&](double level) { return start + width * (level - from) / (to - from); };
    if (std::abs(from) > most) lo = place(reached(std::copysign(most, from)));
    if (std::abs(to) > most) hi = place(reached(std::copysign(most, to)));
  }
  const Range y = bounds({lo, hi, 0, false}).bound_x;
  if (passes_by(lo, hi, y)) return;
  // A change of sign, or an end that is 0 to rounding.
  if ((at_lo <= 0) != (at_hi <= 0) || std::abs(at_lo) <= kTurnAccuracy || std::abs(at_hi) <= kTurnAccuracy) {
    Place root = std::abs(at_lo) <= kTurnAccuracy   ? stretch.lo
                 : std::abs(at_hi) <= kTurnAccuracy ? stretch.hi
                                                    : solve(row, 0, stretch.lo, stretch.hi);
    // Of more than two equations the others must vanish there as well.
    bool exact = true;
    for (std::size_t other = 0; other < free().rows(); ++other) {
      exact = exact && std::abs(residual(root, other)) <= kRootTurn;
    }
    // det J by rows (guide, row), turned so that it has the same sign whatever guides.
    const CurvePoint& a = free_is_a_ ? root.free : root.bound;
    const CurvePoint& b = free_is_a_ ? root.bound : root.free;
    const std::size_t p = std::min(guide_, row);
    const std::size_t q = std::max(guide_, row);
    const double determinant = a.slope(q) * b.slope(p) - a.slope(p) * b.slope(q);
    // A root beyond the bound side is not in this box.
    if (is_inside(root) && (exact || !stretch.covered)) add_root(root, determinant > 0 ? 1 : -1, exact);
  }
  if (!stretch.covered) add_piece(lo, hi, y);
}

/// Newton's method along the line from the chord, kept in the bracket by bisection.
LineSearch::Place LineSearch::solve(std::size_t row, double level, const Place& from, const Place& to) const {
  double lo = from.free.x;
  double hi = to.free.x;
  const double first = residual(from, row);
  const double last = residual(to, row);
  const bool rises = last > first;
  Place at = place(lo + (hi - lo) * (level - first) / (last - first));
  for (int round = 0; round < kMostLineRounds; ++round) {
    const double x = at.free.x;
    const double off = residual(at, row) - level;
    if (off == 0) break;
    ((off > 0) == rises ? hi : lo) = x;
    double next = x - off / residual_slope(at, row);
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (!(next > lo && next < hi) || std::abs(next - x) <= 1e-16 * (std::abs(x) + hi - lo)) break;
    at = place(next);
  }
  return at;
}

/// Is there no place beside the line, between these two, where all equations are within the tolerance? `within` allows
/// each residual as much as the guide's own tolerance can add; together the equations may allow less. Only equations
/// that are straight here are used: each cuts a polygon, and if nothing is left of it, there is no such place.
bool LineSearch::passes_by(const Place& lo, const Place& hi, const Range& y) const {
  const double least = std::max(y.least - margin_, bound().lo());
  const double most = std::min(y.most + margin_, bound().hi());
  if (most < least) return false;
  const double width = hi.free.x - lo.free.x;
  const CurvePoint bound_lo = bound().point(least);
  const CurvePoint bound_hi = bound().point(most);
  const double bend = kStraightShare * limits_.tolerance;
  Polygon left{{lo.free.x, least}, {hi.free.x, least}, {hi.free.x, most}, {lo.free.x, most}};
  for (std::size_t row = 0; row < free().rows(); ++row) {
    // How far the equation is from straight on the rectangle that the polygon starts from, in x and in y.
    const double along = free().slope_between(lo.free, hi.free, row).spread() * width;
    const double across = bound().slope_between(bound_lo, bound_hi, row).spread() * (most - least);
    if (along + across <= bend) left = within_row(left, lo, row, limits_.tolerance + bend + kTurnAccuracy);
  }
  return left.empty();
}

/// The part of a polygon where an equation, taken as straight from a place on the line, is off by no more than `most`.
Polygon LineSearch::within_row(const Polygon& polygon, const Place& at, std::size_t row, double most) const {
  const double sign = free_is_a_ ? 1 : -1;
  const Vec2 slope(sign * at.free.slope(row), -sign * at.bound.slope(row));
  return within(polygon, {at.free.x, at.bound.x}, residual(at, row), slope, most);
}

/// The part of a band in which every equation is within the tolerance, of those that are straight from one end of the
/// band to the other.
Polygon LineSearch::narrow(const Polygon& band, const Place& lo, const Place& hi) const {
  const double width = hi.free.x - lo.free.x;
  Polygon left = band;
  for (std::size_t row = 0; row < free().rows(); ++row) {
    // Its tangent at one end against its value at the other one.
    const double bend = residual(lo, row) + width * residual_slope(lo, row) - residual(hi, row);
    if (!(std::abs(bend) <= kStraightShare * limits_.tolerance)) continue;
    left = within_row(left, lo, row, limits_.tolerance);
  }
  return left;
}

PairPoint LineSearch::contacts(const Vec2& at) const {
  const double one = free().s(at.x());
  const double other = bound().s(at.y());
  return free_is_a_ ? PairPoint{one, other} : PairPoint{other, one};
}

/// The set within the tolerance about the line between two places, where the line may leave its chord by `bend`: the
/// part of a band that lies in the box, so that neighbours have their common edge in common.
Polygon LineSearch::band(const Place& lo, const Place& hi, double bend) const {
  const double off = margin_ + bend;
  const Polygon all{{lo.free.x, lo.bound.x - off},
                    {hi.free.x, hi.bound.x - off},
                    {hi.free.x, hi.bound.x + off},
                    {lo.free.x, lo.bound.x + off}};
  const Polygon inside = clipped(all, {free().lo(), bound().lo()}, {free().hi(), bound().hi()});
  const Polygon narrowed = narrow(inside, lo, hi);
  return narrowed.empty() ? inside : narrowed;
}

/// Lists the band about the line between two places, as far as it lies in the box: as a polygon, if the line bends
/// little against the band's width, else as a box.
void LineSearch::add_piece(const Place& lo, const Place& hi, const Range& y) {
  const Interval x{std::max(lo.free.x, free().lo()), std::min(hi.free.x, free().hi())};
  const Interval across{std::max(y.least - margin_, bound().lo()), std::min(y.most + margin_, bound().hi())};
  if (across.hi < across.lo) return;
  PairPiece piece;
  // How far the line can be from its chord: dy/dx varies by so much.
  const double bend = bounds({lo, hi, 0, false}).direction.spread() * x.width();
  piece.error = length_of(std::min(bend, margin_));
  piece.corner = sides_.pivots();
  if (bend <= kBandBend * margin_) {
    for (const Vec2& corner : band(lo, hi, 0)) piece.hull.push_back(contacts(corner));
  }
  const std::array around{contacts(Vec2(x.lo, across.lo)), contacts(Vec2(x.hi, across.hi))};
  piece.box = piece.hull.empty() ? box_about(around) : box_about(piece.hull);
  findings_.pieces.push_back(std::move(piece));
}

void LineSearch::add_root(const Place& place, int sign, bool exact) {
  findings_.roots.push_back({contacts(place), sign, sides_.pivots(), exact});
}

}  // namespace rollfix::locating
