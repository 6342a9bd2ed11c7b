#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <tuple>
#include <vector>

#include "locate/searches.hpp"
#include "plane_curve.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/part.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::locating {

/// Two first contacts: s of finger a and t of finger b.
using PairPoint = std::array<double, 2>;

/// A box of them.
using PairBox = std::array<Interval, 2>;

/// Whole perimeters that are added to s and to t.
using Shift = std::array<double, 2>;

/// The same pair, or box, by another name on a closed outline.
inline PairPoint moved(const PairPoint& point, const Shift& shift) {
  return {point[0] + shift[0], point[1] + shift[1]};
}

inline PairBox moved(const PairBox& box, const Shift& shift) {
  return {Interval{box[0].lo + shift[0], box[0].hi + shift[0]}, Interval{box[1].lo + shift[1], box[1].hi + shift[1]}};
}

/// The least box around points; around none an empty one.
template <class Points>
PairBox box_about(const Points& points) {
  PairBox box{Boundary::empty_arc(), Boundary::empty_arc()};
  for (const PairPoint& at : points) {
    for (const std::size_t k : {0U, 1U}) box[k] = {std::min(box[k].lo, at[k]), std::max(box[k].hi, at[k])};
  }
  return box;
}

/// In the plane of s and t, not across s = 0 or t = 0.
inline double distance(const PairPoint& one, const PairPoint& two) {
  const double s = one[0] - two[0];
  const double t = one[1] - two[1];
  return std::sqrt(s * s + t * t);  // no hypot: nothing here is near to under- or overflow, and it is called often
}

/// A pair of first contacts at which every f_k is 0, or, of more equations than two, those that cross best there.
struct PairRoot {
  PairPoint at{};
  int sign = 0;         // of det J; 0 where J is singular
  bool corner = false;  // thanks to a corner's pivot
  bool exact = true;    // every f_k is 0
};

/// A connected set of pairs on which every |f_k| is within the tolerance.
struct PairPiece {
  PairBox box;                  // around it
  std::vector<PairPoint> hull;  // a convex polygon around it; empty: the box
  std::vector<PairPoint> line;  // through it, where f = 0 along a line
  double error = 0;             // how far the hull or the line may be off
  bool exact = false;           // f = 0 on all of it
  bool corner = false;          // where corners' pivots make up the difference
};

/// What a search leaves of the boxes that it looked at.
struct PairFindings {
  // In the order in which they were found, as are the roots.
  std::vector<PairPiece> pieces;
  std::vector<PairRoot> roots;
  // Boxes that were neither excluded nor listed, for the budget was used up.
  std::vector<PairBox> unresolved;
  SearchCounts counts;
};

/// What all steps of one search need to know.
struct PairLimits {
  double tolerance = 0;   // of every component: of rolls radians
  double perimeter = 0;   // P
  double same_place = 0;  // lengths below this are rounding errors
  bool facing = false;    // the last row is modulo 2 pi
  bool covered = false;   // inside a set that is within the tolerance and already listed: only its roots are missing

  /// For a box inside a listed set: its roots alone are looked for, to rounding.
  PairLimits inside() const {
    PairLimits limits = *this;
    limits.tolerance = kTurnAccuracy;
    limits.covered = true;
    return limits;
  }
};

/// Where a residual varies by this share of the tolerance, all is in or out as its middle is.
inline constexpr double kSmallVariation = 0.25;

/// The cubic on [0, 1] with these values and slopes at the ends (Hermite). Slopes are by x in [0, 1]: those of a side,
/// times its width.
class ResidualCubic {
 public:
  ResidualCubic(double first, double last, double slope_first, double slope_last)
      : first_(first),
        slope_(slope_first),
        square_(3 * (last - first) - 2 * slope_first - slope_last),
        cube_(slope_first + slope_last - 2 * (last - first)) {}

  double value(double x) const { return first_ + x * (slope_ + x * (square_ + x * cube_)); }
  double slope(double x) const { return slope_ + x * (2 * square_ + x * (3 * cube_)); }

 private:
  double first_;
  double slope_;
  double square_;
  double cube_;
};

/// A stretch of a curve on one piece: a side of a box.
class BoxSide {
 public:
  /// REQUIRES a node of one piece. The curve must not be halved while the side is used.
  BoxSide(const PlaneCurve& curve, std::int32_t node)
      : curve_(&curve),
        components_(curve.components(node)),
        node_(node),
        lo_(curve.node(node).lo),
        hi_(curve.node(node).hi),
        pivot_at_(curve.pivot_at(curve.node(node))) {}

  /// What is known of component `row` on this side.
  const PlaneCurve::Component& component(std::size_t row) const { return components_[row]; }
  /// Through its values and slopes at the ends: nearly the component itself.
  ResidualCubic cubic(std::size_t row) const {
    const PlaneCurve::Component& of = component(row);
    return {of.first, of.last, width() * of.first_slope, width() * of.last_slope};
  }
  /// The ends of x: s, or an angle where the finger pivots.
  double lo() const { return lo_; }
  double hi() const { return hi_; }
  double width() const { return hi_ - lo_; }
  double middle() const { return 0.5 * (lo_ + hi_); }
  /// The finger stands at a convex corner on this side, and x is the angle that it has pivoted by.
  bool pivots() const { return pivot_at_.has_value(); }
  /// The place on the boundary.
  double s(double x) const { return pivot_at_ ? *pivot_at_ : x; }
  std::size_t rows() const { return curve_->rows(); }
  /// Bounds on a component and on its slope by x.
  const Range& value(std::size_t row) const { return components_[row].value; }
  const Range& slope(std::size_t row) const { return components_[row].slope; }
  /// Slopes are constant, as of rolls on lines, on arcs and at pivots.
  bool is_straight() const {
    return std::all_of(components_, components_ + rows(),
                       [](const PlaneCurve::Component& of) { return of.slope.spread() == 0; });
  }
  /// Bounds on a component's slope between two places of the side.
  Range slope_between(const CurvePoint& one, const CurvePoint& two, std::size_t row) const {
    return curve_->slope_between(curve_->node(node_), one, two, row);
  }
  /// The curve, continued beyond this side's ends by its tangents there: slopes keep this side's bounds.
  CurvePoint point(double x) const { return curve_->point(curve_->node(node_), x); }
  /// One component alone at x.
  PlaneCurve::Place place(double x, std::size_t row) const { return curve_->place(curve_->node(node_), x, row); }
  /// Places closer together than this are one: a share of the perimeter, or of a radian where the finger pivots.
  double same_place(const PairLimits& limits) const { return pivots() ? kLengthAccuracy : limits.same_place; }

 private:
  const PlaneCurve* curve_;
  const PlaneCurve::Component* components_;  // good until a node is halved
  std::int32_t node_;
  double lo_;
  double hi_;
  std::optional<double> pivot_at_;
};

/// Two sides and the equations f = A(s) - B(t) - shift = 0 between them.
struct PairBoxSides {
  BoxSide a;
  BoxSide b;
  double lap = 0;  // the multiple of 2 pi that the facing row means here

  /// What a row's f takes off: whole turns in the facing row, else 0.
  double shift(std::size_t row, const PairLimits& limits) const {
    return limits.facing && row + 1 == a.rows() ? lap : 0;
  }
  /// Bounds on f of a row all over the box.
  Range value(std::size_t row, const PairLimits& limits) const {
    const double by = shift(row, limits);
    return a.value(row) - b.value(row) - Range{by, by};
  }
  bool pivots() const { return a.pivots() || b.pivots(); }
};

// What is near is looked for along a slant, s + kSlant t: on a part that repeats itself as many pieces as repetitions
// have the same s, or the same t. By the golden ratio, which is far from all fractions.
inline constexpr double kSlant = 0.6180339887498949;

/// The place of a point along the slant, of a box the places of all its points; length.
inline double along_slant(const PairPoint& at) { return at[0] + kSlant * at[1]; }

inline Interval along_slant(const PairBox& box) {
  return {along_slant(PairPoint{box[0].lo, box[1].lo}), along_slant(PairPoint{box[0].hi, box[1].hi})};
}

/// The same box, larger by this on all four sides.
inline PairBox widened(const PairBox& box, double by) {
  return {Interval{box[0].lo - by, box[0].hi + by}, Interval{box[1].lo - by, box[1].hi + by}};
}

/// Their indices in order of where they begin.
inline std::vector<std::size_t> by_place(const std::vector<Interval>& intervals) {
  std::vector<std::size_t> order(intervals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::tie(intervals[a].lo, a) < std::tie(intervals[b].lo, b); });
  return order;
}

// Lines that end closer together than this share of the perimeter continue each other.
inline constexpr double kJointWidth = 1e-8;

/// A piece that touches another one.
struct PieceLink {
  std::size_t to;
  Shift shift;  // added to the other piece brings it here
};

/// A line through all the exact pieces of a set, unwrapped.
struct FamilyLine {
  std::vector<PairPoint> points;  // each next to the one before; branches are passed twice
  double error = 0;               // how far the line may be off the set
};

/// Depth first through the exact ones among the `members` of a set; where a branch ends the line goes back the way it
/// came. REQUIRES an exact member, and of each piece the links to exact ones first.
FamilyLine line_through_family(const std::vector<PairPiece>& pieces, const std::vector<std::vector<PieceLink>>& links,
                               const std::vector<std::size_t>& members, double period);

/// Does a line, moved by `shift`, come as near as `slack` to a box?
bool line_meets(const std::vector<PairPoint>& line, const Shift& shift, const PairBox& box, double slack);

/// Of each piece those that it touches, across s = 0 and t = 0 on a closed outline; exact ones first, so that a walk
/// along a family leaves it only where it must. Elsewhere it is enough that what hangs together does so by some links.
/// `same_place`: pieces that come as near as this are one.
std::vector<std::vector<PieceLink>> links_of(const std::vector<PairPiece>& pieces, const Boundary& boundary,
                                             double same_place);

/// Pieces that touch, across s = 0 and t = 0 on a closed outline, and the roots in them.
struct PairCluster {
  PairBox extent;  // unwrapped: it may begin below 0
  std::array<bool, 2> whole_loop{};
  bool exact = false;
  bool corner = false;  // all of its pieces are
  std::vector<PairRoot> roots;
  PairPoint first{};              // of an exact one: where s is least, of those where t is
  std::vector<PairPoint> family;  // of an exact one: a line through all its exact pieces, unwrapped
  double family_error = 0;
};

/// Joins what touches, sorted by place.
std::vector<PairCluster> join_pieces(const Part& part, const PairFindings& findings, double same_place);

/// One placement for each connected set: its kind, its roots, how sure they are; ordered by start.
std::vector<Placement> make_placements(const ContactEquations& question, const std::vector<PairCluster>& clusters);

}  // namespace rollfix::locating
