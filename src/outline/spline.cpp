#include "outline/spline.hpp"

#include <fmt/format.h>
#include <Eigen/SparseCholesky>
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
#include "rollfix/outline.hpp"

// Notation:
//   t_i, q_i        parameters and points
//   f(t)            sum of N_j(t) c_j: cubic B-splines, `basis`, and their control points, `controls_`
//   A c = b         normal equations of |f(t_i) - q_i|^2 and, with a small weight, of the third derivative: `blocks`
//   knot            where spans meet: counted once, three times where f is sharp, four times at an end: `repeated_`
// Follows C. de Boor, "A Practical Guide to Splines" (1978).
// Idea: four B-splines are not zero on a span, so that A is banded (of a closed f cyclically): sparse elimination takes
// linear time.
namespace rollfix {

namespace {

constexpr int kSharp = 3;  // a cubic spline's knot counted this often leaves only the position continuous
constexpr int kEnd = 4;    // and this often it is an end
/// Bending counts this much beside the third derivative: nothing, except where no point says anything.
constexpr double kBending = 1e-3;

}  // namespace

/// Binary search; before the first break the first span, behind the last one the last span. At a break the span that
/// starts there.
std::size_t Knots::span_at(double t) const {
  const auto after = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, t);
  return static_cast<std::size_t>(after - breaks.begin()) - 1;
}

/// No break is sharp.
Knots even_knots(double lo, double hi, std::size_t spans, bool closed) {
  Knots knots{{}, std::vector<char>(spans + 1, 0), closed};
  for (std::size_t k = 0; k < spans; ++k) {
    knots.breaks.push_back(lo + (hi - lo) * static_cast<double>(k) / static_cast<double>(spans));
  }
  // Set, not computed: the end is exact.
  knots.breaks.push_back(hi);
  return knots;
}

/// Linear in the number of points and spans.
FittedSpline::FittedSpline(Knots knots, const std::vector<double>& parameters, const std::vector<Vec2>& points,
                           double stiffness)
    : knots_(std::move(knots)) {
  lay_knots();
  solve(parameters, points, stiffness);
  make_spans();
}

void FittedSpline::lay_knots() {
  const std::size_t spans = knots_.spans();
  for (std::size_t k = 0; k < knots_.breaks.size(); ++k) {
    // An end counts 4 times, so that the curve ends at its last control point; a corner 3 times, which leaves position
    // alone continuous.
    const bool is_end = !knots_.closed && (k == 0 || k == spans);
    const int count = is_end ? kEnd : (knots_.sharp[k] != 0 ? kSharp : 1);
    // Closed: the last break is the first, one period on, and is not repeated.
    if (k < spans || !knots_.closed)
      repeated_.insert(repeated_.end(), static_cast<std::size_t>(count), knots_.breaks[k]);
    if (k < spans) last_knot_.push_back(static_cast<long>(repeated_.size()) - 1);
  }
  controls_.resize(knots_.closed ? repeated_.size() : repeated_.size() - kEnd);
}

double FittedSpline::knot(long index) const {
  const auto count = static_cast<long>(repeated_.size());
  if (!knots_.closed) return repeated_[static_cast<std::size_t>(std::clamp(index, 0L, count - 1))];
  const double period = knots_.breaks.back() - knots_.breaks.front();
  long laps = index / count;
  long rest = index % count;
  if (rest < 0) {
    rest += count;
    --laps;
  }
  return repeated_[static_cast<std::size_t>(rest)] + static_cast<double>(laps) * period;
}

std::size_t FittedSpline::coefficient(long index) const {
  const auto count = static_cast<long>(controls_.size());
  const long rest = index % count;
  return static_cast<std::size_t>(rest < 0 ? rest + count : rest);
}

/// The values at t of the four B-splines that are not zero on the span: Cox and de Boor's recurrence. None is below 0
/// for t on the span, and their sum is 1.
FittedSpline::Weights FittedSpline::basis(std::size_t span, double t) const {
  const long j = last_knot_[span];
  Weights n = {1, 0, 0, 0};
  // From the B-splines of one degree less: each new one is a mix of two neighbours. n[0 ... degree] are valid after
  // each turn.
  for (int degree = 1; degree <= 3; ++degree) {
    double carried = 0;
    for (int r = 0; r < degree; ++r) {
      const double right = knot(j + r + 1);
      const double left = knot(j + 1 - degree + r);
      const double share = n[static_cast<std::size_t>(r)] / (right - left);
      n[static_cast<std::size_t>(r)] = carried + (right - t) * share;
      carried = (t - left) * share;
    }
    n[static_cast<std::size_t>(degree)] = carried;
  }
  return n;
}

/// The second derivatives by t at the span's two ends, as weights of its four control points.
std::array<FittedSpline::Weights, 2> FittedSpline::second_derivatives(std::size_t span) const {
  // The derivative of a B-spline curve of degree d has the control points d (c_(i+1) - c_i) / (difference of knots),
  // and the degree d - 1.
  const long j = last_knot_[span];
  std::array<Weights, 3> first{};
  for (int k = 0; k < 3; ++k) {  // first derivatives' control points j-2 .. j
    const long i = j - 2 + k;
    const double factor = 3 / (knot(i + 3) - knot(i));
    const auto at = static_cast<std::size_t>(k);
    first[at][at + 1] = factor;
    first[at][at] = -factor;
  }
  std::array<Weights, 2> second{};
  for (int k = 0; k < 2; ++k) {  // second derivatives' control points j-1, j: they are the values at the ends
    const long i = j - 1 + k;
    const double factor = 2 / (knot(i + 2) - knot(i));
    const auto at = static_cast<std::size_t>(k);
    for (std::size_t c = 0; c < 4; ++c) second[at][c] = factor * (first[at + 1][c] - first[at][c]);
  }
  return second;
}

/// Minimizes the sum of |f(t_i) - q_i|^2 + stiffness * (third derivative)^2 as scaled below. x and y are two right
/// sides of one matrix.
void FittedSpline::solve(const std::vector<double>& parameters, const std::vector<Vec2>& points, double stiffness) {
  using Block = Eigen::Matrix4d;
  const std::size_t spans = knots_.spans();
  std::vector<Block> blocks(spans, Block::Zero());
  const auto size = static_cast<Eigen::Index>(controls_.size());
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(size, 2);
  // Each point adds the product of its four weights to the block of its span.
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t span = knots_.span_at(parameters[i]);
    const Weights weights = basis(span, parameters[i]);
    const Eigen::Map<const Eigen::Vector4d> row(weights.data());
    blocks[span] += row * row.transpose();
    for (int c = 0; c < 4; ++c) {
      const auto control = static_cast<Eigen::Index>(coefficient(last_knot_[span] - 3 + c));
      right.row(control) += row[c] * points[i].transpose();
    }
  }

  // The stiffness of a span counts as so many points as there are on average on its width: it does not depend on the
  // unit or on the number of points.
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(16 * spans);
  const double whole = knots_.breaks.back() - knots_.breaks.front();
  const double density = static_cast<double>(points.size()) / whole;
  for (std::size_t span = 0; span < spans; ++span) {
    const double width = knots_.breaks[span + 1] - knots_.breaks[span];
    const auto ends = second_derivatives(span);
    const Eigen::Map<const Eigen::Vector4d> from(ends[0].data());
    const Eigen::Map<const Eigen::Vector4d> to(ends[1].data());
    // f'' is straight on a span. Its change is the third derivative times the width; `bend` is its mean. Both by the
    // span's own parameter, in [0, 1].
    const Eigen::Vector4d jump = (to - from) * (width * width);
    const Eigen::Vector4d bend = (to + from) * (0.5 * width * width);
    const double weight = stiffness * density * width;
    blocks[span] += weight * (jump * jump.transpose() + kBending * bend * bend.transpose());
    // Each block adds to the 4 by 4 entries of its control points; triplets at one place are summed.
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        entries.emplace_back(static_cast<int>(coefficient(last_knot_[span] - 3 + a)),
                             static_cast<int>(coefficient(last_knot_[span] - 3 + b)), blocks[span](a, b));
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  // Symmetric and banded; the stiffness keeps it regular where a span has no points.
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factored(matrix);
  const Eigen::MatrixX2d solution = factored.solve(right);
  for (Eigen::Index k = 0; k < size; ++k) controls_[static_cast<std::size_t>(k)] = solution.row(k).transpose();
}

Vec2 FittedSpline::sum(std::size_t span, const Weights& weights) const {
  Vec2 total = Vec2::Zero();
  for (int c = 0; c < 4; ++c) {
    total += weights[static_cast<std::size_t>(c)] * controls_[coefficient(last_knot_[span] - 3 + c)];
  }
  return total;
}

/// Each span as a cubic, by its ends and the second derivatives there, scaled to its own parameter.
void FittedSpline::make_spans() {
  const std::size_t spans = knots_.spans();
  std::vector<Vec2> ends;  // computed once for both spans that meet there: they meet to the last bit
  for (std::size_t span = 0; span < spans; ++span) ends.push_back(sum(span, basis(span, knots_.breaks[span])));
  ends.push_back(knots_.closed ? ends.front() : sum(spans - 1, basis(spans - 1, knots_.breaks.back())));
  for (std::size_t span = 0; span < spans; ++span) {
    const double width = knots_.breaks[span + 1] - knots_.breaks[span];
    const auto second = second_derivatives(span);
    spans_.push_back(CubicSpan::with_second_derivatives(
        ends[span], ends[span + 1], width * width * sum(span, second[0]), width * width * sum(span, second[1])));
  }
}

// ---- through all points
// Notation:
//   p_i, h_i        points and chords' lengths: Chords
//   t               parameter, the length along the chords; f(t): cubic on each
//   d_i             slope of chord i: (p_i+1 - p_i) / h_i
//   M_i             f'' at p_i: h_i-1 M_i-1 + 2 (h_i-1 + h_i) M_i + h_i M_i+1 = 6 (d_i - d_i-1): `add_knot`
// Follows C. de Boor, "A Practical Guide to Splines" (1978); docs/files.md, "Points and scans".
// Idea: between corners f'' is continuous and 0 at both ends (natural), without corners all is periodic: a tridiagonal
// system, cyclic then, whose diagonal dominates.

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
