#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "pair_find.hpp"
#include "plane_curve.hpp"
#include "range.hpp"

namespace rollfix::locating {

/// Where a residual varies by this share of the tolerance, all is in or out as its middle is.
inline constexpr double kSmallVariation = 0.25;

/// The cubic on [0, 1] with these values and slopes at the ends (Hermite).
class Cubic {
 public:
  Cubic(double first, double last, double slope_first, double slope_last)
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
  BoxSide(const PlaneCurve& curve, std::int32_t node)
      : curve_(&curve),
        components_(curve.components(node)),
        node_(node),
        lo_(curve.node(node).lo),
        hi_(curve.node(node).hi),
        pivot_at_(curve.pivot_at(curve.node(node))) {}

  const PlaneCurve::Component& component(std::size_t row) const { return components_[row]; }
  /// Through its values and slopes at the ends: nearly the component itself.
  Cubic cubic(std::size_t row) const {
    const PlaneCurve::Component& of = component(row);
    return {of.first, of.last, width() * of.first_slope, width() * of.last_slope};
  }
  double lo() const { return lo_; }
  double hi() const { return hi_; }
  double width() const { return hi_ - lo_; }
  double middle() const { return 0.5 * (lo_ + hi_); }
  bool pivots() const { return pivot_at_.has_value(); }
  double s(double x) const { return pivot_at_ ? *pivot_at_ : x; }
  std::size_t rows() const { return curve_->rows(); }
  const Range& value(std::size_t row) const { return components_[row].value; }
  const Range& slope(std::size_t row) const { return components_[row].slope; }
  /// Lines, arcs and pivots: no rate changes.
  bool is_straight() const {
    return std::all_of(components_, components_ + rows(),
                       [](const PlaneCurve::Component& of) { return of.slope.spread() == 0; });
  }
  Range slope_between(const CurvePoint& one, const CurvePoint& two, std::size_t row) const {
    return curve_->slope_between(curve_->node(node_), one, two, row);
  }
  /// The curve, continued beyond this side's ends by its tangents there: slopes keep this side's bounds.
  CurvePoint point(double x) const { return curve_->point(curve_->node(node_), x); }
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

  double shift(std::size_t row, const PairLimits& limits) const {
    return limits.facing && row + 1 == a.rows() ? lap : 0;
  }
  Range value(std::size_t row, const PairLimits& limits) const {
    const double by = shift(row, limits);
    return a.value(row) - b.value(row) - Range{by, by};
  }
  bool pivots() const { return a.pivots() || b.pivots(); }
};

/// Where two curves run alongside each other in a box: one equation, the guide, is solved for one of the two contacts,
/// which leaves a line through the box, and the other equations are searched along that line by branch and prune, as
/// one finger's is. Finds touching curves, and curves that overlap: stretches.
class LineSearch {
 public:
  LineSearch(const PairBoxSides& sides, const PairLimits& limits, std::size_t& budget, PairFindings& findings);

  /// False: no equation in this box can guide, or the tolerance is as wide as the box.
  bool run();

  /// Are the curves together in the middle of the line as well as on it?
  bool may_overlap();

 private:
  /// A place on the line.
  struct Place {
    CurvePoint free;   // of the contact that the line is told by
    CurvePoint bound;  // of the other one: the guide is 0
  };
  struct Stretch {
    Place lo;
    Place hi;
    int depth = 0;
    bool covered = false;  // see PairLimits
  };
  /// Bounds along a stretch of the line.
  struct Bounds {
    Range bound_x;               // of the other contact
    Range direction;             // its change by the free contact's
    std::vector<Range> slope;    // of each residual by the free contact
    std::vector<double> within;  // the tolerance of each residual, for the guide may be off as well
  };

  bool choose_guide();
  Place place(double x) const;
  double bound_at(double value) const;
  double residual(const Place& place, std::size_t row) const;
  double residual_slope(const Place& place, std::size_t row) const;
  double direction(const Place& place) const;
  Bounds bounds(const Stretch& stretch) const;
  bool turns_round(const Stretch& stretch) const;
  bool clip(Stretch& stretch, double margin) const;
  Place at_edge(const Stretch& stretch, double edge) const;
  void decide(Stretch stretch);
  std::size_t steepest(const Bounds& along) const;
  bool take_flat(const Stretch& stretch, const Bounds& along, bool is_point);
  bool overlaps(const Stretch& whole, std::vector<Place>& samples) const;
  bool is_apart_midway() const;
  bool slopes_vanish(const Place& at) const;
  bool vanishes(const Place& place) const;
  double residual_rounding(const Place& place) const;
  Place turn_between(const Place& one, const Place& two) const;
  void take_overlap(const Stretch& whole, std::vector<Place> samples);
  void add_beyond(const Place& lo, const Place& hi);
  void take_monotone(const Stretch& stretch, const Bounds& along, std::size_t row);
  void add_piece(const Place& lo, const Place& hi, const Range& y);
  bool passes_by(const Place& lo, const Place& hi, const Range& y) const;
  Polygon within_row(const Polygon& polygon, const Place& at, std::size_t row, double most) const;
  Polygon narrow(const Polygon& band, const Place& lo, const Place& hi) const;
  Polygon band(const Place& lo, const Place& hi, double bend) const;
  void add_root(const Place& place, int sign, bool exact);
  Place solve(std::size_t row, double level, const Place& from, const Place& to) const;
  PairPoint contacts(const Place& place) const;
  PairPoint contacts(const Vec2& at) const;
  bool is_inside(const Place& place) const;
  void split(const Stretch& stretch);

  const BoxSide& free() const { return free_is_a_ ? sides_.a : sides_.b; }
  const BoxSide& bound() const { return free_is_a_ ? sides_.b : sides_.a; }
  /// How far off in place a bound contact is that is so far off: not at all where it pivots, by an angle.
  double length_of(double off) const { return bound().pivots() ? 0 : off; }

  PairBoxSides sides_;
  PairLimits limits_;
  std::size_t& budget_;
  PairFindings& findings_;
  bool free_is_a_ = true;
  std::size_t guide_ = 0;
  double margin_ = 0;  // how far the bound contact may be off the line within the tolerance
  std::vector<Stretch> waiting_;
};

/// Branch and prune on boxes of two first contacts: where two curves meet, all of it, proved complete. A box goes when
/// its sides can't meet; where J has an inverse on all of it there is one root at the most, and Newton's method says
/// whether; where the curves run alongside each other one equation is followed as a line through the box; what is left
/// is halved.
class BoxSearch {
 public:
  BoxSearch(PlaneCurve& a, PlaneCurve& b, const PairLimits& limits, std::size_t& budget, PairFindings& findings);

  void run();

 private:
  struct Box {
    std::int32_t a;
    std::int32_t b;
    int depth;     // halvings since both sides are on one piece each
    bool covered;  // see PairLimits
  };

  /// Two rows whose Jacobian is invertible on a whole box.
  struct Regular {
    std::array<std::size_t, 2> rows;
    Eigen::Matrix2d inverse;  // of the middle Jacobian
    Eigen::Matrix2d off;      // bounds on 1 - inverse * J, entry by entry
    Eigen::Matrix2d slack;    // (1 - off)^-1
    double radius;            // the spectral radius of `off`: what the simplified Newton step contracts by
  };

  void decide(const Box& box);
  void decide_on_pieces(Box box, const PairBoxSides& sides, const PairLimits& limits);
  enum class Flat { no, settled, covered };

  bool meet_nowhere_across(const Box& box, double lap, double tolerance) const;
  bool is_apart(const PairBoxSides& sides, const PairLimits& limits) const;
  std::optional<Regular> regular(const PairBoxSides& sides) const;
  bool take_regular(const PairBoxSides& sides, const PairLimits& limits, const Regular& regular);
  Flat take_flat(const PairBoxSides& sides, const PairLimits& limits);
  bool corners_vanish(const PairBoxSides& sides) const;
  void halve(const Box& box, bool side_a);
  bool a_is_wider(const Box& box) const;

  PlaneCurve& a_;
  PlaneCurve& b_;
  PairLimits limits_;
  std::size_t& budget_;
  PairFindings& findings_;
  std::vector<Box> waiting_;
};

}  // namespace rollfix::locating
