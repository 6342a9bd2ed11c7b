#pragma once

// A chain of curves by arc length: the tangent's angle to 1e-17, and bounds on the curvature over any stretch.

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "oracle/curve.hpp"

namespace oracle {

/// Which of two neighbours is meant where they meet.
enum class Side { before, after };

/// A jump of the tangent's angle.
struct Corner {
  Real s = 0;     // in [0, P)
  Real turn = 0;  // in (-pi, pi)
};

/// A jump below this is a drawing's rounding.
inline constexpr Real kNoCorner = 1e-12L;

/// A place on the boundary, s any number on a closed one.
struct Contact {
  Real s = 0;
  Real angle = 0;  // of the tangent, unwrapped
  std::size_t cell = 0;
  Real u = 0;
};

class Boundary {
 public:
  /// `fold`: turned by 2 pi / fold it is the same.
  Boundary(Curves curves, bool closed, int fold = 1) : curves_(std::move(curves)), closed_(closed), fold_(fold) {
    for (std::size_t curve = 0; curve < curves_.size(); ++curve) add(curve);
    if (closed_) join(cells_.back(), cells_.front(), cells_.back().angle + cells_.back().turn);
  }

  bool closed() const { return closed_; }
  Real perimeter() const { return perimeter_; }
  Real total_turn() const { return total_turn_; }
  /// How far two places are from ones at which the curvature is the same, whatever the first one is: on a closed
  /// boundary a lap, on a symmetric one less. A circle has a fold of 0.
  Real off_by(Real length) const {
    if (fold_ == 0 || length == 0) return 0;
    return closed_ ? std::remainder(length, perimeter_ / fold_) : length;
  }
  /// Whether a stretch lies on one curve, and on which: only there the rate tells all that the curvature does.
  std::optional<std::size_t> curve_of(const Contact& from, const Contact& to) const {
    const std::size_t curve = cells_[from.cell].curve;
    if (cells_[to.cell].curve != curve || to.cell < from.cell || to.s - from.s > perimeter_ / 2) return {};
    return curve;
  }
  const std::vector<Corner>& corners() const { return corners_; }
  Real most_curvature() const { return most_curvature_; }

  /// Of the perimeter: what s may be rounded by.
  static constexpr Real kNear = 1e-17L;

  Contact contact(Real s, Side side = Side::after, Real near = kNear) const {
    Real laps = closed_ ? std::floor(s / perimeter_) : 0;
    Real base = closed_ ? s - laps * perimeter_ : std::clamp<Real>(s, 0, perimeter_);
    near *= perimeter_ + std::abs(s);
    std::size_t cell = cell_of(base);
    bool at_start = base - cells_[cell].s <= near;
    if (!at_start && cells_[cell].s + cells_[cell].length - base <= near) {
      at_start = cell + 1 < cells_.size() || closed_;
      if (!at_start) return {s, cells_[cell].angle + cells_[cell].turn, cell, cells_[cell].u.hi};
      if (++cell == cells_.size()) {
        cell = 0;
        laps += 1;
      }
    }
    if (!at_start) return inside(s, cell, base, laps);
    if (side == Side::after || (cell == 0 && !closed_))
      return {s, laps * total_turn_ + cells_[cell].angle, cell, cells_[cell].u.lo};
    if (cell == 0) laps -= 1;
    cell = (cell == 0 ? cells_.size() : cell) - 1;
    return {s, laps * total_turn_ + cells_[cell].angle + cells_[cell].turn, cell, cells_[cell].u.hi};
  }

  Real curvature(const Contact& at) const { return curves_[cells_[at.cell].curve]->curvature(at.u); }

  /// Bounds on the curvature and its rate over the stretch from one contact forward to another.
  Bend bend(const Contact& from, const Contact& to) const {
    const bool is_around = from.cell == to.cell && to.s - from.s > 1.5L * cells_[to.cell].length;
    if (from.cell == to.cell && !is_around) return part({from.cell, from.u, to.u});
    const std::size_t next = (from.cell + 1) % cells_.size();
    const Bend first = part({from.cell, from.u, cells_[from.cell].u.hi});
    const Bend last = part({to.cell, cells_[to.cell].u.lo, to.u});
    Bend all = joined(first, last);
    for (std::size_t cell = next; cell != to.cell; cell = (cell + 1) % cells_.size())
      all = joined(all, cells_[cell].bend);
    return all;
  }

 private:
  struct Cell {
    std::size_t curve = 0;
    Interval u;
    Real s = 0;      // where it starts ...
    Real angle = 0;  // ... and which way
    Real length = 0;
    Real turn = 0;
    Real speed_first = 0, speed_last = 0;  // |r'| at the ends
    Bend bend;
  };
  struct Part {
    std::size_t cell;
    Real from, to;
  };

  static constexpr Real kMostBend = 0.05L;       // radians by which a cell's turn may be unknown
  static constexpr Real kQuadrature = 2e-18L;    // of a cell's length, by which halves may disagree, ...
  static constexpr Real kRounding = 3e-20L;      // ... or of its curve's: no halving takes the rounding of r' away
  static constexpr Real kSmallStep = 1e-3L;      // of a cell's parameters
  static constexpr Real kLastStep = 1e-10L;      // the error that is left is its square
  static constexpr Real kShareOfBounds = 0.75L;  // of a cell whose own bounds are taken for a stretch

  static Bend joined(const Bend& one, const Bend& other) {
    return {hull(one.speed, other.speed), hull(one.curvature, other.curvature), hull(one.rate, other.rate)};
  }

  Real length(std::size_t curve, Real from, Real to) const {
    if (from == to) return 0;
    return boost::math::quadrature::gauss<Real, 10>::integrate(
        [&](Real u) { return norm(curves_[curve]->velocity(u)); }, from, to);
  }

  void add(std::size_t curve) {
    Cell first;
    first.curve = curve;
    first.u = curves_[curve]->domain();
    cut(first, kRounding * length(curve, first.u.lo, first.u.hi));
  }

  /// Halves until arc length is certain and the curvature is known well.
  void cut(Cell cell, Real rounding) {
    const Real amid = cell.u.middle();
    const Real halves = length(cell.curve, cell.u.lo, amid) + length(cell.curve, amid, cell.u.hi);
    cell.length = length(cell.curve, cell.u.lo, cell.u.hi);
    cell.bend = curves_[cell.curve]->bend(cell.u);
    const Real slack = std::max(kQuadrature * cell.length, rounding);
    const bool is_fine = std::abs(halves - cell.length) <= slack && cell.bend.speed.lo > 0 &&
                         cell.bend.curvature.width() * cell.length <= kMostBend &&
                         cell.bend.curvature.size() * cell.length < 1;
    if (!is_fine && amid > cell.u.lo && amid < cell.u.hi) {
      for (const Interval& half : {Interval(cell.u.lo, amid), Interval(amid, cell.u.hi)}) {
        Cell part = cell;
        part.u = half;
        cut(part, rounding);
      }
      return;
    }
    const Vector first = curves_[cell.curve]->velocity(cell.u.lo), last = curves_[cell.curve]->velocity(cell.u.hi);
    cell.turn = angle_between(first, last);
    cell.speed_first = norm(first);
    cell.speed_last = norm(last);
    if (cells_.empty()) {
      cell.angle = std::atan2(first.y, first.x);
    } else {
      cell.s = perimeter_;
      cell.angle = join(cells_.back(), cell, cells_.back().angle + cells_.back().turn);
    }
    perimeter_ = cell.s + cell.length;
    most_curvature_ = std::max(most_curvature_, cell.bend.curvature.size());
    cells_.push_back(cell);
  }

  /// The angle after the joint of two cells.
  Real join(const Cell& before, const Cell& after, Real angle) {
    const bool is_last = !cells_.empty() && &after == &cells_.front();
    Real turn = 0;
    if (before.curve != after.curve || is_last) {
      turn = angle_between(curves_[before.curve]->velocity(before.u.hi), curves_[after.curve]->velocity(after.u.lo));
      if (std::abs(turn) > kNoCorner) corners_.push_back({is_last ? 0 : after.s, turn});
    }
    if (is_last) total_turn_ = std::round((angle + turn - after.angle) / (2 * kPi)) * 2 * kPi;
    return angle + turn;
  }

  std::size_t cell_of(Real base) const {
    const auto after =
        std::upper_bound(cells_.begin() + 1, cells_.end(), base, [](Real s, const Cell& cell) { return s < cell.s; });
    return static_cast<std::size_t>(after - cells_.begin()) - 1;
  }

  /// By Newton's method: u with this arc length from the cell's start.
  Contact inside(Real s, std::size_t index, Real base, Real laps) const {
    const Cell& cell = cells_[index];
    const Real wanted = base - cell.s;
    Real u = guess(cell, wanted / cell.length);
    Real so_far = length(cell.curve, cell.u.lo, u);
    for (int round = 0; round < 8; ++round) {
      const Real speed = norm(curves_[cell.curve]->velocity(u));
      const Real next = std::clamp(u + (wanted - so_far) / speed, cell.u.lo, cell.u.hi), step = next - u;
      if (std::abs(step) <= kSmallStep * cell.u.width()) {  // Simpson's rule: the fifth power of the step
        const auto at = [&](Real place) { return norm(curves_[cell.curve]->velocity(place)); };
        so_far += step * (speed + 4 * at(u + step / 2) + at(next)) / 6;
      } else {
        so_far = length(cell.curve, cell.u.lo, next);
      }
      u = next;
      if (std::abs(step) <= kLastStep * cell.u.width()) break;
    }
    const Real turned = angle_between(curves_[cell.curve]->velocity(cell.u.lo), curves_[cell.curve]->velocity(u));
    return {s, laps * total_turn_ + cell.angle + turned, index, u};
  }

  /// The parameter at a share of a cell's length, nearly: the cubic with the right slopes at both ends.
  static Real guess(const Cell& cell, Real share) {
    const Real first = cell.length / cell.speed_first - cell.u.width(),
               last = cell.length / cell.speed_last - cell.u.width();
    const Real rest = 1 - share;
    return cell.u.lo + share * cell.u.width() + share * rest * (rest * first - share * last);
  }

  Bend part(const Part& part) const {
    const Cell& cell = cells_[part.cell];
    if (part.to - part.from >= kShareOfBounds * cell.u.width()) return cell.bend;
    return curves_[cell.curve]->bend({part.from, std::max(part.from, part.to)});
  }

  Curves curves_;
  bool closed_;
  int fold_;
  std::vector<Cell> cells_;
  std::vector<Corner> corners_;
  Real perimeter_ = 0;
  Real total_turn_ = 0;
  Real most_curvature_ = 0;
};

using Contacts = std::pair<Contact, Contact>;

/// Bounds on kappa(s + L) - kappa(s) where the roll starts on one stretch and ends on the other.
inline Interval gain_of_curvature(const Boundary& boundary, Real length, const Contacts& start, const Contacts& end) {
  const Real off = boundary.off_by(length);
  if (off == 0) return 0;
  const Bend first = boundary.bend(start.first, start.second), last = boundary.bend(end.first, end.second);
  Interval gain = last.curvature - first.curvature;
  const auto curve = boundary.curve_of(start.first, start.second);
  const bool is_one_curve = curve && curve == boundary.curve_of(end.first, end.second);
  if (is_one_curve && std::abs(off) <= start.second.s - start.first.s) {
    gain = both(gain, Interval(off) * hull(first.rate, last.rate));  // what both ends have in common cancels
  }
  return gain;
}

}  // namespace oracle
