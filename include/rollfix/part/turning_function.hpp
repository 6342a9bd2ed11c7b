#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rollfix/outline/curve.hpp"
#include "rollfix/part/boundary.hpp"

namespace rollfix {

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
