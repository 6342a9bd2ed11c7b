#include "rollfix/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "outline/corners.hpp"
#include "outline/turn.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"

// Notation:
//   p_i, h_i        points and chords' lengths: Chords
//   t               parameter, the length along the chords; f(t): cubic on each
//   d_i             slope of chord i: (p_i+1 - p_i) / h_i
//   M_i             f'' at p_i: h_i-1 M_i-1 + 2 (h_i-1 + h_i) M_i + h_i M_i+1 = 6 (d_i - d_i-1): `add_knot`
// Follows C. de Boor, "A Practical Guide to Splines" (1978); docs/files.md, "Points and scans".
// Idea: between corners f'' is continuous and 0 at both ends (natural), without corners all is periodic: a tridiagonal
// system, cyclic then, whose diagonal dominates.
namespace rollfix {

namespace {

/// A symmetric, strictly diagonally dominant tridiagonal system, cyclic where `wrap` is not zero:
///   off[i-1] x[i-1] + diagonal[i] x[i] + off[i] x[i+1] = right[i],
/// with off[i] between unknowns i and i + 1 (the last entry is not used), and `wrap` between the last and the first
/// (then at least 3 unknowns).
struct TridiagonalSystem {
  std::vector<double> diagonal;
  std::vector<double> off;
  double wrap = 0;
  std::vector<Vec2> right;
};

/// The solution. Elimination needs no pivoting because the diagonal dominates.
std::vector<Vec2> solve(TridiagonalSystem system) {
  std::vector<double>& diagonal = system.diagonal;
  const std::vector<double>& off = system.off;
  const double wrap = system.wrap;
  std::vector<Vec2>& right = system.right;
  // Forward: unknown i is taken out of row i + 1 and of the last row, into which the cyclic entry moves on.
  const std::size_t last = diagonal.size() - 1;
  // border[i]: what elimination leaves between unknown i and the last one.
  // Without a cyclic entry all of it stays 0, but for the last.
  std::vector<double> border(last, 0.0);
  if (last > 0) {
    border[0] = wrap;
    // Row i has three entries left: the diagonal, off[i] and border[i].
    for (std::size_t i = 0; i + 1 < last; ++i) {
      const double factor = off[i] / diagonal[i];
      diagonal[i + 1] -= factor * off[i];
      border[i + 1] = -factor * border[i];
      right[i + 1] -= factor * right[i];
      const double last_factor = border[i] / diagonal[i];
      diagonal[last] -= last_factor * border[i];
      right[last] -= last_factor * right[i];
    }
    // The last but one is next to the last in both ways.
    border[last - 1] += off[last - 1];
    const double factor = border[last - 1] / diagonal[last - 1];
    diagonal[last] -= factor * border[last - 1];
    right[last] -= factor * right[last - 1];
  }
  // Backward: the last unknown, then each from the one behind it and from the last.
  std::vector<Vec2>& solution = right;
  solution[last] /= diagonal[last];
  for (std::size_t i = last; i-- > 0;) {
    solution[i] -= border[i] * solution[last];
    if (i + 1 < last) solution[i] -= off[i] * solution[i + 1];
    solution[i] /= diagonal[i];
  }
  return std::move(solution);
}

/// Points that are off a straight line by this share of their largest coordinate are on it: rounding of the input.
constexpr double kStraight = 4 * std::numeric_limits<double>::epsilon();

/// Throws InputError: too few points, a corner angle outside [0, pi], or a point that is not finite.
void require_usable(const std::vector<Vec2>& points, bool closed, double corner_angle) {
  const std::size_t needed = closed ? 3 : 2;
  if (points.size() < needed) {
    throw InputError(fmt::format("a spline through {} points: {} curve needs at least {}", points.size(),
                                 closed ? "a closed" : "an open", needed));
  }
  if (!(corner_angle >= 0 && corner_angle <= std::numbers::pi)) {
    throw InputError(
        fmt::format("a corner angle of {} rad: expected 0 to pi (degrees are written as in 59deg)", corner_angle));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      throw InputError(
          fmt::format("point {} of a spline is ({}, {}): expected finite numbers", i, points[i].x(), points[i].y()));
    }
  }
}

/// The polygon that a spline runs along. On a closed one, chord i goes from point i to point i + 1 modulo their number.
class Chords {
 public:
  /// Keeps a reference to the points. Throws InputError: two neighbours are the same.
  Chords(const std::vector<Vec2>& points, bool closed) : points_(points), closed_(closed) {
    lengths_.reserve(size());
    for (std::size_t i = 0; i < size(); ++i) {
      const double length = chord(i).norm();
      if (!(length > 0)) {
        throw InputError(fmt::format("points {} and {} of a spline are both ({}, {}); leave one out", i, end_index(i),
                                     points_[i].x(), points_[i].y()));
      }
      lengths_.push_back(length);
    }
  }

  /// The number of chords: of a closed polygon one ends at the first point.
  std::size_t size() const { return closed_ ? points_.size() : points_.size() - 1; }
  bool closed() const { return closed_; }
  /// Chord i of a closed polygon, i counted on over the seam by less than a lap.
  std::size_t wrapped(std::size_t i) const { return i < size() ? i : i - size(); }
  const Vec2& from(std::size_t i) const { return points_[i]; }
  const Vec2& to(std::size_t i) const { return points_[end_index(i)]; }
  Vec2 chord(std::size_t i) const { return to(i) - from(i); }
  double length(std::size_t i) const { return lengths_[i]; }
  /// d_i: the unit vector along the chord.
  Vec2 slope(std::size_t i) const { return chord(i) / lengths_[i]; }

  /// How far the polygon turns where chord `next` follows chord `previous`, in [0, pi].
  double turn(std::size_t previous, std::size_t next) const {
    return std::abs(angle_between(slope(previous), slope(next)));
  }

  /// Points at which a new spline starts, in order; on an open curve they include its first.
  std::vector<std::size_t> breaks(double corner_angle) const {
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < size(); ++i) {
      // The chord before the first one of a closed polygon is the last one.
      const bool is_end = i == 0 && !closed_;
      if (is_end || turn(i == 0 ? size() - 1 : i - 1, i) >= corner_angle) result.push_back(i);
    }
    return result;
  }

 private:
  /// The point where chord i ends.
  std::size_t end_index(std::size_t i) const { return i + 1 < points_.size() ? i + 1 : 0; }

  const std::vector<Vec2>& points_;
  bool closed_;
  std::vector<double> lengths_;
};

/// A run of neighbouring chords, across the seam if need be.
struct Run {
  std::size_t first;  // chord
  std::size_t count;  // of chords
};

/// Appends the equation of continuous slope at the knot between two chords: the slopes of both cubics there, by p and
/// M, are the same.
void add_knot(TridiagonalSystem& system, const Chords& chords, std::size_t before, std::size_t after) {
  system.diagonal.push_back(2 * (chords.length(before) + chords.length(after)));
  system.off.push_back(chords.length(after));
  system.right.push_back(6 * (chords.slope(after) - chords.slope(before)));
}

/// An empty system with memory for so many unknowns.
TridiagonalSystem room_for(std::size_t knots) {
  TridiagonalSystem system;
  system.diagonal.reserve(knots);
  system.off.reserve(knots);
  system.right.reserve(knots);
  return system;
}

/// Second derivatives, by chord length, at the start of every chord of a periodic spline.
std::vector<Vec2> periodic_moments(const Chords& chords) {
  TridiagonalSystem system = room_for(chords.size());
  // One equation for each point, all of them joints between two chords.
  for (std::size_t i = 0; i < chords.size(); ++i) {
    add_knot(system, chords, i == 0 ? chords.size() - 1 : i - 1, i);
  }
  // The last chord lies between the last unknown and the first.
  system.wrap = chords.length(chords.size() - 1);
  return solve(std::move(system));
}

/// Second derivatives at the run's count + 1 points; zero at both ends.
std::vector<Vec2> natural_moments(const Chords& chords, const Run& run) {
  std::vector<Vec2> moments;
  // Unknown are the inner points only. A single chord has none: both moments are 0, a straight line.
  if (run.count > 1) {
    TridiagonalSystem system = room_for(run.count - 1);
    for (std::size_t k = 1; k < run.count; ++k) {
      add_knot(system, chords, chords.wrapped(run.first + k - 1), chords.wrapped(run.first + k));
    }
    moments = solve(std::move(system));
  }
  // "Natural": f'' = 0 at both ends of the run.
  moments.insert(moments.begin(), Vec2::Zero());
  moments.push_back(Vec2::Zero());
  return moments;
}

/// The cubic on chord i with these second derivatives by length at its ends.
Curve span(const Chords& chords, std::size_t i, const Vec2& moment_from, const Vec2& moment_to) {
  // The span's own parameter runs over [0, 1], so derivatives by chord length scale with the chord.
  const double square = chords.length(i) * chords.length(i);
  return CubicSpan::with_second_derivatives(chords.from(i), chords.to(i), square * moment_from, square * moment_to);
}

/// Whether all points of the run are on the line from its first to its last.
bool is_straight(const Chords& chords, const Run& run) {
  const Vec2& first = chords.from(run.first);
  const Vec2& last = chords.to(chords.wrapped(run.first + run.count - 1));
  const Vec2 whole = last - first;
  if (whole == Vec2::Zero()) return false;  // all the way round, from the only corner back to it
  // `limit` bounds |cross| where the distance from the line is rounding of the coordinates; inner points need not be in
  // order.
  const double largest = std::max(first.cwiseAbs().maxCoeff(), last.cwiseAbs().maxCoeff());
  const double limit = kStraight * largest * whole.norm();
  // All points between the two ends.
  for (std::size_t k = 0; k + 1 < run.count; ++k) {
    const Vec2& point = chords.to(chords.wrapped(run.first + k));
    if (std::abs(cross(whole, point - first)) > limit) return false;
  }
  return true;
}

/// One spline between two breaks; `place(i, curve)` takes the curve on chord i.
template <class Place>
void draw_run(const Chords& chords, const Run& run, const Place& place) {
  if (is_straight(chords, run)) {
    for (std::size_t k = 0; k < run.count; ++k) {
      const std::size_t i = chords.wrapped(run.first + k);
      place(i, Line(chords.from(i), chords.to(i)));
    }
    return;
  }
  const std::vector<Vec2> moments = natural_moments(chords, run);
  for (std::size_t k = 0; k < run.count; ++k) {
    const std::size_t i = chords.wrapped(run.first + k);
    place(i, span(chords, i, moments[k], moments[k + 1]));
  }
}

/// Without any corner: C2 all around, also at the first point.
std::vector<Curve> periodic_spline(const Chords& chords) {
  const std::vector<Vec2> moments = periodic_moments(chords);
  std::vector<Curve> curves;
  curves.reserve(chords.size());
  for (std::size_t i = 0; i < chords.size(); ++i) {
    curves.push_back(span(chords, i, moments[i], moments[chords.wrapped(i + 1)]));
  }
  return curves;
}

/// `breaks`: where a new spline starts, in order; of an open curve its first point among them.
std::vector<Curve> spline_in_runs(const Chords& chords, const std::vector<std::size_t>& breaks) {
  if (breaks.empty()) return periodic_spline(chords);

  // The run across the seam is drawn first and turned last: its tail belongs to the front of the list.
  std::vector<Curve> curves;
  curves.reserve(chords.size());
  std::vector<Curve> before_first_break;
  // Chords before the first break belong to the run that starts at the last break.
  const auto place = [&](std::size_t i, Curve curve) {
    (i < breaks.front() ? before_first_break : curves).push_back(std::move(curve));
  };
  // Each run goes from one break to the next; the last one of a closed curve across the seam to the first break.
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    // Counted on over the seam, for the run that goes across it.
    const std::size_t end =
        k + 1 < breaks.size() ? breaks[k + 1] : chords.size() + (chords.closed() ? breaks.front() : 0);
    draw_run(chords, {breaks[k], end - breaks[k]}, place);
  }
  curves.insert(curves.begin(), before_first_break.begin(), before_first_break.end());
  return curves;
}

}  // namespace

/// Corners are where neighbouring chords turn by the corner angle.
std::vector<Curve> spline_through(const std::vector<Vec2>& points, bool closed, double corner_angle) {
  require_usable(points, closed, corner_angle);
  const Chords chords(points, closed);
  return spline_in_runs(chords, chords.breaks(corner_angle));
}

std::vector<Curve> spline_with_corners(const std::vector<Vec2>& points, bool closed,
                                       const std::vector<std::size_t>& corners) {
  require_usable(points, closed, kCornerAngle);
  const Chords chords(points, closed);
  std::vector<std::size_t> breaks;
  if (!closed && (corners.empty() || corners.front() != 0)) breaks.push_back(0);
  for (const std::size_t corner : corners) {
    // An open curve's last point starts no chord.
    if (corner < chords.size()) breaks.push_back(corner);
  }
  return spline_in_runs(chords, breaks);
}

}  // namespace rollfix
