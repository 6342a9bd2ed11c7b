#pragma once

// Antipodal pairs, whose normals lie on the line between them: what two fingers squeeze, or push apart from inside a
// notch. A question that the search for two rolls knows nothing of, told as two curves that meet.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "locate/pair/box_search.hpp"
#include "locate/pair/components.hpp"
#include "locate/pair/plane_curve.hpp"
#include "rollfix/part.hpp"

namespace antipodal {

using rollfix::Corner;
using rollfix::Interval;
using rollfix::Part;
using rollfix::Range;
using rollfix::Spiral;
using rollfix::Turning;
using rollfix::Vec2;
using rollfix::locating::CurvePoint;
using rollfix::locating::PlaneCurve;

// Notation:
//   p, T, N         the point at s, its tangent and the normal to the left of it; q, at t
//   g(s)            p . T, by the perimeter (row 0); g' = (1 + kappa p . N) / P
//   Theta(s)        the tangent's angle (row 1)
// At p and q a line hits the outline at right angles from both sides when T_q = -T_p and (q - p) . T_p = 0: Theta(s) =
// Theta(t) + pi modulo 2 pi and g(s) = -g(t). At a convex corner p stays and T turns; at a concave one no finger fits.

/// `sign` g(s) and Theta(s) + `shift`: +1 and 0 for p, -1 and pi for q.
class Curve final : public PlaneCurve {
 public:
  Curve(const Part& part, double sign, double shift) : PlaneCurve(2), part_(part), sign_(sign), shift_(shift) {
    const std::vector<Spiral>& spirals = part.turning().spirals();
    for (const Spiral& spiral : spirals) {
      const auto corner = std::find_if(part.corners().begin(), part.corners().end(),
                                       [&](const Corner& at) { return at.s == spiral.lo; });
      if (corner != part.corners().end() && corner->turn > 0) {
        add_piece({0, corner->turn}, {{}, corner->s, spiral.start.angle - corner->turn});
      }
      add_piece({spiral.lo, spiral.hi}, {&spiral, {}, 0});
    }
    set_root(join(0, static_cast<std::int32_t>(count())));
  }

  std::optional<double> pivot_at(const Node& node) const override { return pieces_[node.piece].pivot_at; }

  CurvePoint point(const Node& node, double x) const override {
    const double nearest = std::clamp(x, node.lo, node.hi);
    const Here at = here(pieces_[node.piece], nearest);
    CurvePoint point(nearest, rows(), 3);
    for (const std::size_t row : {0U, 1U}) {
      point.values()[row] = value(at, row);
      point.slopes()[row] = slope(at, row);
    }
    const double across = at.tangent.curvature * at.point.dot(normal(at.tangent.angle));
    point.rates()[0] = at.tangent.curvature;
    point.rates()[1] = 1 / part_.perimeter();
    point.rates()[2] = across / part_.perimeter();
    point.step(x - nearest);
    return point;
  }

  Place place(const Node& node, double x, std::size_t row) const override {
    const Here at = here(pieces_[node.piece], x);
    return {value(at, row), slope(at, row)};
  }

  Range slope_between(const Node& node, const CurvePoint& one, const CurvePoint& two, std::size_t row) const override {
    if (row == 1) return rollfix::hull(one.slope(1), two.slope(1));
    const Interval x{std::clamp(std::min(one.x, two.x), node.lo, node.hi),
                     std::clamp(std::max(one.x, two.x), node.lo, node.hi)};
    return slopes(pieces_[node.piece], x);
  }

 private:
  struct Piece {
    const Spiral* spiral;  // none at a corner
    std::optional<double> pivot_at;
    double angle;  // of a corner's tangent before it
  };
  struct Here {
    Vec2 point;
    Turning tangent;
    bool pivots;
  };

  void add_piece(const Interval& x, const Piece& piece) {
    pieces_.push_back(piece);
    make(static_cast<std::uint32_t>(pieces_.size() - 1), x);
  }

  std::int32_t make(std::uint32_t index, const Interval& x) {
    Node node;
    node.lo = x.lo;
    node.hi = x.hi;
    node.piece = index;
    const Piece& piece = pieces_[index];
    const Here lo = here(piece, x.lo);
    const Here hi = here(piece, x.hi);
    return make_on_piece(node, [&](std::size_t row) {
      Component of;
      of.first = value(lo, row);
      of.last = value(hi, row);
      of.first_slope = slope(lo, row);
      of.last_slope = slope(hi, row);
      of.slope = row == 0 ? slopes(piece, x) : rollfix::hull(of.first_slope, of.last_slope);
      const double change = 0.5 * (of.last_slope - of.first_slope);
      const double most = 0.5 * of.slope.spread();
      of.own = row == 0 ? Range{-most, most} : rollfix::hull(0, change);
      of.value = rollfix::value_range(of.first, of.last, of.slope, x.width());
      return of;
    });
  }

  void divide(std::int32_t index) override {
    const Node node = this->node(index);
    if (!node.on_one_piece()) return;
    const double middle = 0.5 * (node.lo + node.hi);
    const std::int32_t left = make(node.piece, {node.lo, middle});
    adopt(index, left, make(node.piece, {middle, node.hi}));
  }

  Here here(const Piece& piece, double x) const {
    if (piece.pivot_at) return {part_.point(*piece.pivot_at), {piece.angle + x, 1}, true};
    return {part_.point(x), part_.turning().on_spiral(*piece.spiral, x), false};
  }

  double value(const Here& at, std::size_t row) const {
    if (row == 1) return at.tangent.angle + shift_;
    return sign_ * at.point.dot(along(at.tangent.angle)) / part_.perimeter();
  }
  double slope(const Here& at, std::size_t row) const {
    if (row == 1) return at.tangent.curvature;
    const double across = at.tangent.curvature * at.point.dot(normal(at.tangent.angle));
    return sign_ * ((at.pivots ? 0 : 1) + across) / part_.perimeter();
  }

  /// Of row 0 anywhere on an interval: (p . N)' = -kappa p . T, and kappa is monotone.
  Range slopes(const Piece& piece, const Interval& x) const {
    const Here middle = here(piece, x.middle());
    const double from = middle.point.norm() + (middle.pivots ? 0 : 0.5 * x.width());
    const Range bend = rollfix::hull(here(piece, x.lo).tangent.curvature, here(piece, x.hi).tangent.curvature);
    const double across = middle.point.dot(normal(middle.tangent.angle));
    const double off = 0.5 * x.width() * bend.size() * from;
    const Range all = bend * Range{across - off, across + off};
    const double goes_on = middle.pivots ? 0 : 1;
    return (sign_ / part_.perimeter()) * (all + Range{goes_on, goes_on});
  }

  static Vec2 along(double angle) { return {std::cos(angle), std::sin(angle)}; }
  static Vec2 normal(double angle) { return {-std::sin(angle), std::cos(angle)}; }

  const Part& part_;
  double sign_;
  double shift_;
  std::vector<Piece> pieces_;
};

/// All of them, each from both of its ends, in connected sets; nothing is left undecided, or it throws.
inline std::vector<rollfix::locating::PairCluster> pairs(const Part& part) {
  Curve p(part, 1, 0);
  Curve q(part, -1, std::numbers::pi);
  rollfix::locating::PairLimits limits;
  limits.tolerance = 1e-9;
  limits.perimeter = part.perimeter();
  limits.same_place = rollfix::kLengthAccuracy * part.perimeter();
  limits.facing = true;
  rollfix::locating::PairFindings findings;
  std::size_t budget = 200'000;
  rollfix::locating::PairBoxSearch(p, q, limits, budget, findings).run();
  if (!findings.unresolved.empty()) throw std::runtime_error("some boxes could not be decided");
  return rollfix::locating::join_pieces(part, findings, limits.same_place);
}

}  // namespace antipodal
