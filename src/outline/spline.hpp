#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix {

/// Where a cubic spline's spans meet.
struct Knots {
  std::vector<double> breaks;  // rising; closed: the last is the first, one period on
  std::vector<char> sharp;  // of each break: only the position is continuous there (the ends' are not used when open)
  bool closed = false;

  std::size_t spans() const { return breaks.size() - 1; }
  /// The span that holds t, a parameter between the first and the last break.
  std::size_t span_at(double t) const;
};

/// So many spans of one width.
Knots even_knots(double lo, double hi, std::size_t spans, bool closed);

/// The cubic spline (C2 but for sharp breaks) of least squared distance to points at given parameters.
class FittedSpline {
 public:
  /// `stiffness` weighs the third derivative against the points: what decides where points are missing. It
  /// should be above 0 and small beside 1.
  FittedSpline(Knots knots, const std::vector<double>& parameters, const std::vector<Vec2>& points, double stiffness);

  const Knots& knots() const { return knots_; }
  /// One for each span, its own parameter in [0, 1].
  const std::vector<CubicSpan>& spans() const { return spans_; }

 private:
  using Weights = std::array<double, 4>;

  /// Number `index` of `repeated_`. Closed: any index, on another lap whole periods further on. Open: an index beyond
  /// an end gives that end.
  double knot(long index) const;
  /// The control point that B-spline number `index` belongs to: closed, cyclic.
  std::size_t coefficient(long index) const;
  /// Fills `repeated_` and `last_knot_`, and makes room for the control points.
  void lay_knots();
  Weights basis(std::size_t span, double t) const;
  std::array<Weights, 2> second_derivatives(std::size_t span) const;
  /// The control points of least squares.
  void solve(const std::vector<double>& parameters, const std::vector<Vec2>& points, double stiffness);
  /// The spans of the control points.
  void make_spans();
  /// The span's four control points by these weights.
  Vec2 sum(std::size_t span, const Weights& weights) const;

  Knots knots_;
  std::vector<double> repeated_;  // every knot as often as it counts; closed: of one period
  std::vector<long> last_knot_;   // of each span: the knot at its start that counts last
  std::vector<Vec2> controls_;    // of the B-splines; closed: one for each knot
  std::vector<CubicSpan> spans_;
};

}  // namespace rollfix
