#pragma once

// Theta(s), the tangent's direction along a boundary, with bounds on intervals; and periodic places and arcs.
//
//     const Part part = load_part("gallery:circle,r=2");
//     const TurningFunction& theta = part.turning();
//     theta.angle(2.0) - theta.angle(0.0);               // 1
//     part.boundary().distance(0.1, 12.5);   // 0.166371
//
// Degenerate cases: at a corner Theta jumps, and `before` and `after` differ; on a line it is constant.
//
// Accuracy: 1e-12 rad (docs/search.md, "ACCURACY").

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix {

/// Arc length is accurate to this share of the perimeter: places closer together than that are one place.
inline constexpr double kLengthAccuracy = 1e-12;

/// A point of a loop: value = base + winding * period, base in [0, period).
struct Wrapped {
  double base = 0;
  double winding = 0;  // a whole number
};

/// The only place where lengths are reduced to one period. `period` > 0.
inline Wrapped wrap(double value, double period) {
  if (value >= 0 && value < period) return {value, 0};
  double winding = std::floor(value / period);
  double base = value - winding * period;
  // The quotient is rounded: the remainder can come out a whole period off, or at the period itself.
  if (base < 0) {
    base += period;
    winding -= 1;
  }
  if (base >= period) {
    base = 0;
    winding += 1;
  }
  return {base, winding};
}

/// Which of two neighbouring things is meant where they meet: what ends there or what starts there.
enum class Side { before, after };

/// What the places s of a boundary are: of a closed one a loop, on which s and s + P are one place; of an open one the
/// segment [0, P]. Knows no geometry.
///
/// An arc of it, a stretch from lo forwards to hi, is an Interval: any lo and hi >= lo on a closed boundary, where it
/// may go on across s = 0 and holds all that is a whole number of perimeters off. hi < lo: the empty arc. As wide as P:
/// the full one.
struct Boundary {
  double perimeter = 0;  // P, above 0
  bool closed = true;

  static constexpr Interval empty_arc() {
    return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  }
  Interval full_arc() const { return {0, perimeter}; }

  static bool is_empty(const Interval& arc) { return !(arc.lo <= arc.hi); }
  bool is_full(const Interval& arc) const {
    return closed ? arc.width() >= perimeter : arc.lo <= 0 && arc.hi >= perimeter;
  }

  // ---- places ----

  /// s as a place on [0, P) and whole laps, or from before on (0, P]; of an open boundary clamped to [0, P], no laps.
  Wrapped reduced(double s, Side side = Side::after) const {
    if (!closed) return {std::min(std::max(s, 0.0), perimeter), 0};
    const Wrapped place = wrap(s, perimeter);
    return place.base == 0 && side == Side::before ? Wrapped{perimeter, place.winding - 1} : place;
  }
  double base(double s) const { return reduced(s).base; }

  /// s in [0, P) of a closed boundary; of an open one s as it is, on it or beyond an end.
  double on_first_lap(double s) const { return closed ? wrap(s, perimeter).base : s; }

  /// The same, and what lies before P by no more than rounding is 0: one name for one place.
  double canonical(double s) const {
    const double at = base(s);
    return closed && perimeter - at <= kLengthAccuracy * perimeter ? 0 : at;
  }

  /// How far it is forwards from one place to another: in [0, P) on a closed boundary; below 0 on an open one where
  /// the other lies behind.
  double ahead(double from, double to) const { return closed ? wrap(to - from, perimeter).base : to - from; }

  /// The same the shorter way, forwards or (below 0) backwards.
  double offset(double from, double to) const { return closed ? std::remainder(to - from, perimeter) : to - from; }

  /// How far apart two places are.
  double distance(double one, double other) const {
    if (!closed) return std::abs(one - other);
    const double forwards = ahead(one, other);
    return std::fmin(forwards, perimeter - forwards);
  }

  // ---- arcs ----

  /// The arc by one name: lo in [0, P), canonical where the arc is no longer than rounding; hi may exceed P. The full
  /// one is [0, P]. Of an open boundary what lies in [0, P].
  Interval arc(double lo, double hi) const {
    if (!closed) return {std::max(lo, 0.0), std::min(hi, perimeter)};
    const double width = hi - lo;
    if (width >= perimeter) return full_arc();
    if (!(width >= 0)) return empty_arc();
    const double start = width <= kLengthAccuracy * perimeter ? canonical(lo) : base(lo);
    return {start, start + width};
  }

  /// Does it hold s, or miss it by no more than the slack?
  bool contains(const Interval& arc, double s, double slack = 0) const {
    if (is_empty(arc)) return false;
    if (!closed) return s >= arc.lo - slack && s <= arc.hi + slack;
    return ahead(arc.lo - slack, s) <= arc.width() + 2 * slack;
  }

  /// How far outside an arc a place is: 0 inside; of the empty one infinity.
  double distance(const Interval& arc, double s) const {
    if (is_empty(arc)) return std::numeric_limits<double>::infinity();
    if (!closed) return std::max({0.0, arc.lo - s, s - arc.hi});
    const double forwards = ahead(arc.lo, s);
    if (forwards <= arc.width()) return 0;
    return std::min(forwards - arc.width(), perimeter - forwards);
  }

  /// Have two arcs a place in common?
  bool intersects(const Interval& one, const Interval& other) const {
    if (is_empty(one) || is_empty(other)) return false;
    if (!closed) return one.lo <= other.hi && other.lo <= one.hi;
    return ahead(one.lo, other.lo) <= one.width() || ahead(other.lo, one.lo) <= other.width();
  }

  /// Does one arc hold all of another?
  bool covers(const Interval& arc, const Interval& inner) const {
    if (is_empty(inner) || is_full(arc)) return true;
    if (is_empty(arc)) return false;
    if (!closed) return arc.lo <= inner.lo && inner.hi <= arc.hi;
    return ahead(arc.lo, inner.lo) + inner.width() <= arc.width();
  }
};

/// The distance between two points of a closed boundary, the shorter way round.
inline double periodic_distance(double a, double b, double period) { return Boundary{period, true}.distance(a, b); }

/// Below this a difference of turning angles is zero: what the turning function is accurate to, radians.
inline constexpr double kTurnAccuracy = 1e-12;

/// The turning function's value and slope at one point.
struct Turning {
  double angle = 0;      // Theta(s), radians, unwrapped
  double curvature = 0;  // kappa(s) = Theta'(s)
};

/// A stretch of the boundary on which the curvature keeps its sign and is monotone.
struct Spiral {
  double lo = 0;  // arc length of its ends
  double hi = 0;
  Turning start;  // one-sided limits at its ends
  Turning end;
  int trend = 0;                  // +1 where the curvature grows, -1 where it falls, 0 where it is constant
  std::uint32_t first_panel = 0;  // the panels it lies on
  std::uint32_t last_panel = 0;

  double turn() const { return end.angle - start.angle; }
};

/// A smooth piece of Theta as a polynomial in x = (s - middle) * inverse_half, x in [-1, 1].
struct Panel {
  double lo = 0;  // arc length of its ends
  double hi = 0;
  double middle = 0;
  double inverse_half = 0;
  std::uint32_t offset = 0;  // into the coefficients, rising powers of x
  std::uint32_t count = 0;   // a multiple of kPanelBlock, padded with zeros
};

inline constexpr std::size_t kPanelBlock = 4;

/// A polynomial by its rising powers, kept in place.
inline constexpr int kMostPowers = 20;
using Powers = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, kMostPowers, 1>;

/// Theta(s), the tangent's angle by arc length (Arkin et al. 1991): what every question is asked of.
/// Piecewise polynomial on panels; accurate to kTurnAccuracy at an s accurate to kLengthAccuracy * P.
/// On a closed outline Theta(s + P) = Theta(s) + period_turn.
class TurningFunction {
 public:
  double perimeter() const { return perimeter_; }
  double period_turn() const { return period_turn_; }
  bool closed() const { return closed_; }
  Boundary boundary() const { return {perimeter_, closed_}; }

  /// Value and slope at s: any s on a closed outline, s clamped to [0, P] on an open one. Where the value jumps (a
  /// corner) or the slope does (a joint): the limit from this side.
  Turning at(double s, Side side = Side::after) const;
  double angle(double s, Side side = Side::after) const { return at(s, side).angle; }
  double curvature(double s, Side side = Side::after) const { return at(s, side).curvature; }

  /// The spirals in order; the first starts at 0, the last ends at P.
  const std::vector<Spiral>& spirals() const { return spirals_; }
  /// The spiral that holds base, 0 <= base <= P; of two that meet there the one on this side.
  std::size_t spiral_at(double base, Side side = Side::after) const;

  /// Value and slope at base, taken on this spiral, also a rounding error beyond its ends.
  Turning on_spiral(const Spiral& spiral, double base) const { return on_panel(panel_on(spiral, base), base); }
  /// The same on this panel.
  Turning on_panel(const Panel& panel, double base) const {
    return sum(panel, (base - panel.middle) * panel.inverse_half);
  }
  /// Theta(end_middle + half y) - Theta(start_middle + half y) as a polynomial in y in [-1, 1], three powers at least:
  /// one lies on the panel `end`, the other on `start`.
  Powers difference(const Panel& start, double start_middle, const Panel& end, double end_middle, double half) const;
  /// The panel that holds base, a place on this spiral.
  const Panel& panel_on(const Spiral& spiral, double base) const { return panels_[panel_index(spiral, base)]; }
  std::uint32_t panel_index(const Spiral& spiral, double base) const {
    return panel_index(spiral.first_panel, spiral.last_panel, base);
  }
  /// The same where it is known to be among these.
  std::uint32_t panel_index(std::uint32_t first, std::uint32_t last, double base) const {
    std::uint32_t index = first;
    if (last - index > kFewPanels) index = middle_panel(first, last, base);
    while (index < last && base >= panels_[index].hi) ++index;
    return index;
  }

  const std::vector<Panel>& panels() const { return panels_; }
  double most_curvature() const { return most_curvature_; }  // largest |kappa|

 private:
  friend class TurningFunctionBuilder;

  std::uint32_t middle_panel(std::uint32_t first, std::uint32_t last, double base) const;

  using Pair = Eigen::Array2d;  // of Theta and of kappa: one vector instruction serves both

  /// Both polynomials' values: four sums in x^4, because one long chain of multiplications would wait for itself.
  Turning sum(const Panel& panel, double x) const {
    const Pair* c = coefficients_.data() + panel.offset;
    const double square = x * x;
    const double fourth = square * square;
    std::size_t k = panel.count - kPanelBlock;
    Pair sum0 = c[k];
    Pair sum1 = c[k + 1];
    Pair sum2 = c[k + 2];
    Pair sum3 = c[k + 3];
    while (k > 0) {
      k -= kPanelBlock;
      sum0 = sum0 * fourth + c[k];
      sum1 = sum1 * fourth + c[k + 1];
      sum2 = sum2 * fourth + c[k + 2];
      sum3 = sum3 * fourth + c[k + 3];
    }
    const Pair value = (sum0 + sum1 * x) + (sum2 + sum3 * x) * square;
    return {value[0], value[1]};
  }

  static constexpr std::uint32_t kFewPanels = 8;  // up to here a walk beats a binary search

  bool closed_ = true;
  double perimeter_ = 0;
  double period_turn_ = 0;
  double most_curvature_ = 0;
  std::vector<Panel> panels_;
  std::vector<Pair> coefficients_;
  std::vector<Spiral> spirals_;
};

}  // namespace rollfix
