#include "rollfix/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "outline/box.hpp"
#include "outline/corners.hpp"
#include "outline/spline.hpp"
#include "outline/turn.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "work/pulse.hpp"

// Notation:
//   q_i, tol        points of a scan, and how near f has to be to each: `points_`, `tolerance_`
//   t_i             length to the place nearest q_i along the course, a polygon of averages over 4 tol: Course
//   f(t)            cubic spline of least squares, sharp at corners: FittedSpline
//   e_i             distance of q_i from f, by Newton's method on (q_i - f(t)) . f'(t) = 0: `nearest`
//   misfit          the largest e_i of each span: Misfit
// Follows docs/files.md, "Points and scans".
// Idea: the spans that are off most are halved until all e_i <= tol. Averaging keeps noise from lengthening the course.
// Where f turns by less than half the corner angle at a corner, that corner is given up, and all is fitted again.
namespace rollfix {

namespace {

/// Points are averaged over stretches this many tolerances long before lengths are measured: noise of one tolerance
/// at either end still leaves half of the stretch.
constexpr double kStretch = 4;
/// Decides where points are missing, and shifts the curve by about this share of the noise.
constexpr double kStiffness = 1e-6;
/// A closed curve without corners, and a piece between corners, starts with this many spans.
constexpr std::size_t kFirstSpans = 4;
/// In one round only spans this near to the worst are split: a misfit shows in the neighbours as well.
constexpr double kWorstShare = 0.5;
/// A span with fewer points is not split: it would follow each of them.
constexpr std::size_t kLeastSpanPoints = 3;
/// A corner whose fitted turn is below this share of the corner angle is none.
constexpr double kLeastCornerShare = 0.5;
// Of the search for one point's nearest place, and of splitting spans.
constexpr int kNewtonRounds = 8;
constexpr int kMostRounds = 60;
constexpr double kNewtonStep = 1e-9;  // of a span

/// Without those that repeat the one before (closed: or the first).
std::vector<Vec2> distinct(const std::vector<Vec2>& points, bool closed) {
  std::vector<Vec2> result;
  for (const Vec2& point : points) {
    if (result.empty() || point != result.back()) result.push_back(point);
  }
  while (closed && result.size() > 1 && result.back() == result.front()) result.pop_back();
  return result;
}

/// Throws InputError: not above 0, or above kMostSmoothing of the points' size. Also where it is not a number.
void require_tolerance(const std::vector<Vec2>& points, double tolerance) {
  const double size = box_around(points).diagonal().norm();
  if (tolerance > 0 && tolerance <= kMostSmoothing * size) return;
  throw InputError(
      fmt::format("points smoothed within {}: expected a length above 0 and at most {:.4g}, a twentieth of the part's "
                  "size of {:.4g}; about the size of a pixel or of the noise is right",
                  tolerance, kMostSmoothing * size, size));
}

/// The polygon along which a scan's points are measured: corners, and averages of the stretches between them.
struct Course {
  std::vector<double> parameters;  // of each point: the length along the polygon to its nearest place
  std::vector<double> corners;     // of each corner
  double length = 0;
};

/// Makes the course of a scan: averages the points between corners over stretches of 4 tolerances, and measures each
/// point along the polygon of these averages. Linear in the number of points.
class CourseMaker {
 public:
  CourseMaker(const std::vector<Vec2>& points, bool closed, double tolerance)
      : points_(points), closed_(closed), stretch_(kStretch * tolerance) {}

  /// `corners`: numbers of points, in order. The course starts at the first point and ends at the last one, or at the
  /// first again.
  Course make(const std::vector<std::size_t>& corners) {
    course_.parameters.assign(points_.size(), 0);
    nodes_ = {points_.front()};
    std::vector<std::size_t> node_of(points_.size(), 0);
    std::vector<std::size_t> corner_nodes;
    // Between two stops the points are averaged; the stops themselves, corners and ends, stay where they are.
    std::vector<std::size_t> stops = corners;
    const std::size_t end = closed_ ? points_.size() : points_.size() - 1;
    if (stops.empty() || stops.front() != 0) stops.insert(stops.begin(), 0);
    if (stops.back() != end) stops.push_back(end);
    for (std::size_t k = 0; k + 1 < stops.size(); ++k) add_run(stops[k], stops[k + 1], node_of);
    // With the nodes known, each point is projected on the chords near its own node.
    measure();
    for (std::size_t i = 0; i < points_.size(); ++i) course_.parameters[i] = place_of(points_[i], node_of[i]);
    // A corner is a node: its parameter is that node's, exactly, so that the knot of the spline is there.
    for (const std::size_t corner : corners) {
      course_.parameters[corner] = lengths_[node_of[corner]];
      course_.corners.push_back(course_.parameters[corner]);
    }
    course_.length = lengths_.back();
    return std::move(course_);
  }

 private:
  /// Point i; of a closed scan i may be their number, which is the first one again.
  const Vec2& point(std::size_t i) const { return points_[i < points_.size() ? i : i - points_.size()]; }

  /// Nodes for the points behind `from`, up to and with `to`.
  void add_run(std::size_t from, std::size_t to, std::vector<std::size_t>& node_of) {
    node_of[from] = nodes_.size() - 1;
    std::size_t first = from + 1;
    while (first < to) {
      // Each turn averages the points up to one stretch away from the first of them.
      Vec2 sum = Vec2::Zero();
      std::size_t next = first;
      while (next < to && (point(next) - point(first)).norm() <= stretch_) sum += point(next++);
      const Vec2 average = sum / static_cast<double>(next - first);
      // A short rest just before the stop is left to the stop: no chord much shorter than the others.
      const bool crowds_end = next == to && first > from + 1 && (average - point(to)).norm() < 0.5 * stretch_ &&
                              (point(next - 1) - point(first)).norm() < 0.5 * stretch_;
      if (!crowds_end) nodes_.push_back(average);
      // Each point remembers the node that it went into.
      for (std::size_t i = first; i < next; ++i) node_of[i] = nodes_.size() - 1;
      first = next;
    }
    nodes_.push_back(point(to));
    if (to < points_.size()) node_of[to] = nodes_.size() - 1;
  }

  /// Lengths along the polygon up to each node.
  void measure() {
    lengths_ = {0};
    for (std::size_t k = 1; k < nodes_.size(); ++k) {
      lengths_.push_back(lengths_.back() + (nodes_[k] - nodes_[k - 1]).norm());
    }
  }

  /// The nearest place on the node's chords and those beside them.
  double place_of(const Vec2& point, std::size_t node) const {
    // Two chords to either side of the node: a point is about a stretch away from its node at most.
    const std::size_t first = node > 1 ? node - 2 : 0;
    const std::size_t last = std::min(node + 2, nodes_.size() - 1);
    double best = lengths_[node];
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = first; k < last; ++k) {
      const Vec2 chord = nodes_[k + 1] - nodes_[k];
      const double squared = chord.squaredNorm();
      // The foot of the perpendicular, or the chord's nearer end.
      const double share = squared > 0 ? std::clamp((point - nodes_[k]).dot(chord) / squared, 0.0, 1.0) : 0;
      const double distance = (nodes_[k] + share * chord - point).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      best = lengths_[k] + share * (lengths_[k + 1] - lengths_[k]);
    }
    return best;
  }

  const std::vector<Vec2>& points_;
  bool closed_;
  double stretch_;               // length
  std::vector<Vec2> nodes_;      // of the polygon, in order
  std::vector<double> lengths_;  // up to each node
  Course course_;
};

/// How far off a fitted curve is, by span.
struct Misfit {
  double largest = 0;               // distance of any point from the curve
  std::vector<double> of_span;      // the same of each span's points
  std::vector<std::size_t> points;  // nearest to each span
};

/// Fits a spline to a scan: adds spans until every point is within the tolerance.
class Smoother {
 public:
  /// The points without repetitions; tolerance (a length) above 0.
  Smoother(std::vector<Vec2> points, bool closed, double tolerance)
      : points_(std::move(points)), closed_(closed), tolerance_(tolerance) {}

  /// Nothing when no number of knots brings the curve near enough.
  std::optional<Smoothing> run(std::vector<std::size_t> corners, double corner_angle) {
    // Each round has fewer corners than the one before, so it ends.
    for (;;) {
      if (!fit(corners)) return std::nullopt;
      // A corner at which the fitted curve turns by little was noise: without it the curve is smooth there.
      std::vector<std::size_t> kept;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        if (turn_at(corner_breaks_[k]) >= kLeastCornerShare * corner_angle) kept.push_back(corners[k]);
      }
      if (kept.size() == corners.size()) return finish();
      corners = kept;
    }
  }

 private:
  /// Adds knots until every point is within the tolerance.
  bool fit(const std::vector<std::size_t>& corners) {
    Course course = CourseMaker(points_, closed_, tolerance_).make(corners);
    if (!(course.length > 0)) return false;
    parameters_ = std::move(course.parameters);
    // Least squares, compare, halve the spans that are off most; at most kMostRounds times.
    lay_first_knots(course);
    for (int round = 0; round < kMostRounds; ++round) {
      fitted_.emplace(knots_, parameters_, points_, kStiffness);
      const Misfit misfit = compare();
      if (misfit.largest <= tolerance_) {
        find_corner_breaks(course);
        return true;
      }
      if (!split(misfit)) return false;
    }
    return false;
  }

  /// Few spans to begin with: one between two corners, or two where a closed scan has at most two stretches between
  /// corners; kFirstSpans on a closed one without corners, as a closed spline needs several.
  void lay_first_knots(const Course& course) {
    knots_ = {{0}, {0}, closed_};
    std::vector<double> stops = course.corners;
    // A corner at the first point: the first break is sharp already.
    if (!stops.empty() && stops.front() == 0) {
      knots_.sharp.front() = 1;
      stops.erase(stops.begin());
    }
    const bool has_corners = !course.corners.empty();
    stops.push_back(course.length);
    double last = 0;
    // Each turn fills the stretch from the last stop to this one with equal spans; all stops but the end are sharp.
    for (std::size_t k = 0; k < stops.size(); ++k) {
      const std::size_t pieces = closed_ && !has_corners ? kFirstSpans : (stops.size() < 3 && closed_ ? 2 : 1);
      for (std::size_t j = 1; j <= pieces; ++j) {
        knots_.breaks.push_back(
            j == pieces ? stops[k] : last + (stops[k] - last) * static_cast<double>(j) / static_cast<double>(pieces));
        knots_.sharp.push_back(j == pieces && k + 1 < stops.size() ? 1 : 0);
      }
      last = stops[k];
    }
    // Of a closed curve the last break is the first one.
    knots_.sharp.back() = closed_ ? knots_.sharp.front() : 0;
  }

  /// The distance of every point from the fitted curve, sorted by spans.
  Misfit compare() const {
    Misfit misfit;
    misfit.of_span.assign(knots_.spans(), 0);
    misfit.points.assign(knots_.spans(), 0);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Place place = nearest(points_[i], parameters_[i]);
      misfit.largest = std::max(misfit.largest, place.distance);
      misfit.of_span[place.span] = std::max(misfit.of_span[place.span], place.distance);
      ++misfit.points[place.span];
    }
    return misfit;
  }

  /// A place on the fitted curve, and how far a point is from it.
  struct Place {
    double parameter = 0;  // t
    std::size_t span = 0;
    double distance = 0;  // of the point, a length
  };

  /// The place u in [0, 1] of this span.
  Place at(const Vec2& point, std::size_t span, double u) const {
    const double lo = knots_.breaks[span];
    const double width = knots_.breaks[span + 1] - lo;
    return {lo + u * width, span, (fitted_->spans()[span].jet(u).position - point).norm()};
  }

  /// Newton's method from t on, across spans; where it stops at a break, the other side is tried as well. The distance
  /// is to a place on the curve, so never below the distance to the curve.
  Place nearest(const Vec2& point, double t) const {
    // Minimizes |q - f(u)|^2 / 2. Its derivative is -(q - f) . f', the second one f'^2 - (q - f) . f''.
    const std::size_t spans = knots_.spans();
    std::size_t span = knots_.span_at(t);
    const double width = knots_.breaks[span + 1] - knots_.breaks[span];
    double u = std::clamp((t - knots_.breaks[span]) / width, 0.0, 1.0);
    beat();
    // The best of all places that are visited counts, so that a step that leads away does no harm.
    Place best = at(point, span, u);
    for (int round = 0; round < kNewtonRounds; ++round) {
      const Jet jet = fitted_->spans()[span].jet(u);
      const Vec2 off = point - jet.position;
      const double slope = off.dot(jet.first);
      const double square = jet.first.squaredNorm();
      const double bend = square - off.dot(jet.second);
      // Where the second derivative is small or negative Newton's step would run off: then Gauss and Newton's, without
      // f''.
      const double step = slope / (bend > 0.25 * square ? bend : square);
      // A span of no length has no direction to go in.
      if (!std::isfinite(step)) break;
      // A step is one span long at most.
      double next = u + std::clamp(step, -1.0, 1.0);
      // Only a step out of the very end changes the span: a step beyond it first stops there.
      const bool was_at_end = (next < 0 && u == 0) || (next > 1 && u == 1);
      if (was_at_end) {  // over to the neighbour
        const bool ahead = next > 1;
        const bool leaves = ahead ? span + 1 == spans : span == 0;
        // The end of an open curve is the nearest place.
        if (leaves && !closed_) break;
        span = ahead ? (span + 1) % spans : (span + spans - 1) % spans;
        u = ahead ? 0 : 1;
        const Jet there = fitted_->spans()[span].jet(u);
        const double pull = (point - there.position).dot(there.first);
        if (ahead ? pull <= 0 : pull >= 0) break;  // a corner, and the point is off its tip
        continue;
      }
      next = std::clamp(next, 0.0, 1.0);
      const double moved = std::abs(next - u);
      u = next;
      const Place place = at(point, span, u);
      if (place.distance < best.distance) best = place;
      // Converged.
      if (moved < kNewtonStep) break;
    }
    return best;
  }

  /// Halves the spans that are off by at least the tolerance and by at least half of the worst, if they have points
  /// enough. False when there is nothing left to split.
  bool split(const Misfit& misfit) {
    double worst = 0;  // of those that have enough points
    for (std::size_t span = 0; span < knots_.spans(); ++span) {
      if (misfit.points[span] >= kLeastSpanPoints) worst = std::max(worst, misfit.of_span[span]);
    }
    // Spans that have too few points don't count for the worst, else nothing might be split.
    const double limit = std::max(tolerance_, kWorstShare * worst);
    // The breaks as they are, and a new one in the middle of each span that is split.
    Knots finer{{}, {}, closed_};
    for (std::size_t span = 0; span < knots_.spans(); ++span) {
      finer.breaks.push_back(knots_.breaks[span]);
      finer.sharp.push_back(knots_.sharp[span]);
      if (misfit.of_span[span] < limit || misfit.points[span] < kLeastSpanPoints) continue;
      finer.breaks.push_back(0.5 * (knots_.breaks[span] + knots_.breaks[span + 1]));
      finer.sharp.push_back(0);
    }
    finer.breaks.push_back(knots_.breaks.back());
    finer.sharp.push_back(knots_.sharp.back());
    const bool is_finer = finer.spans() > knots_.spans();
    knots_ = std::move(finer);
    return is_finer;
  }

  /// The breaks at the corners: a corner's parameter is one of the breaks, to the bit, as lay_first_knots made it so.
  void find_corner_breaks(const Course& course) {
    corner_breaks_.clear();
    for (const double corner : course.corners) {
      corner_breaks_.push_back(static_cast<std::size_t>(
          std::lower_bound(knots_.breaks.begin(), knots_.breaks.end(), corner) - knots_.breaks.begin()));
    }
  }

  /// How far the curve turns at a break, in [0, pi]; the break across the seam included.
  double turn_at(std::size_t brk) const {
    const std::size_t spans = knots_.spans();
    const Vec2 before = fitted_->spans()[(brk + spans - 1) % spans].velocity(1);
    const Vec2 after = fitted_->spans()[brk].velocity(0);
    return std::abs(angle_between(before, after));
  }

  /// The result. A span between two corners that a line fits within the tolerance becomes that line.
  Smoothing finish() {
    Smoothing result;
    result.corners = corner_breaks_;
    std::vector<double> of_span(knots_.spans(), 0);
    std::vector<double> off_line(knots_.spans(), 0);
    // For each span, how far its points are from it and from the line between its ends.
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Place place = nearest(points_[i], parameters_[i]);
      of_span[place.span] = std::max(of_span[place.span], place.distance);
      off_line[place.span] = std::max(off_line[place.span], distance_to_line(place.span, points_[i]));
    }
    for (std::size_t span = 0; span < knots_.spans(); ++span) {
      const CubicSpan& cubic = fitted_->spans()[span];
      const bool is_line = is_alone(span) && off_line[span] <= tolerance_;
      const Vec2 from = cubic.jet(0).position;
      const Vec2 to = cubic.jet(1).position;
      result.curves.push_back(is_line ? Curve(Line(from, to)) : Curve(cubic));
      result.deviation = std::max(result.deviation, is_line ? off_line[span] : of_span[span]);
    }
    return result;
  }

  /// Between two corners or ends: the only kind of span that can be straightened without making corners.
  bool is_alone(std::size_t span) const {
    // At a corner, or at an end of an open curve.
    const bool starts = knots_.sharp[span] != 0 || (!closed_ && span == 0);
    const bool ends = knots_.sharp[span + 1] != 0 || (!closed_ && span + 1 == knots_.spans());
    return starts && ends;
  }

  /// From the segment between the span's ends.
  double distance_to_line(std::size_t span, const Vec2& point) const {
    const Vec2 from = fitted_->spans()[span].jet(0).position;
    const Vec2 chord = fitted_->spans()[span].jet(1).position - from;
    const double share = std::clamp((point - from).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
    return (from + share * chord - point).norm();
  }

  std::vector<Vec2> points_;
  bool closed_;
  double tolerance_;                        // length, above 0
  std::vector<double> parameters_;          // t of each point, along the course
  Knots knots_;                             // of this round
  std::optional<FittedSpline> fitted_;      // with these knots
  std::vector<std::size_t> corner_breaks_;  // of each corner, the break where it is
};

/// Where a closed scan starts within reach of a corner, that corner becomes the first point: a sliver of a span between
/// the two would follow the noise.
void start_at_corner(std::vector<Vec2>& points, std::vector<std::size_t>& corners, double reach) {
  // The corner nearest to the first point, within reach.
  std::size_t start = 0;
  double least = reach;
  for (const std::size_t corner : corners) {
    const double distance = (points[corner] - points.front()).norm();
    if (distance > least) continue;
    least = distance;
    start = corner;
  }
  if (start == 0) return;
  // That point first; the corners' numbers go with it, cyclically.
  std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(start), points.end());
  for (std::size_t& corner : corners) corner = (corner + points.size() - start) % points.size();
  std::sort(corners.begin(), corners.end());
}

}  // namespace

/// Where adding knots does not bring the curve within the tolerance, or points are missing or not finite, the spline
/// through all of them, which also words the error.
Smoothing smooth_spline(const std::vector<Vec2>& points, bool closed, double tolerance, double corner_angle) {
  std::vector<Vec2> clean = distinct(points, closed);
  const std::size_t needed = closed ? 3 : 2;
  const bool is_usable = std::all_of(clean.begin(), clean.end(), [](const Vec2& point) { return point.allFinite(); });
  if (clean.size() < needed || !is_usable) return {spline_through(clean, closed, corner_angle), 0, {}};
  require_tolerance(clean, tolerance);
  const double reach = kCornerReach * tolerance;
  std::vector<std::size_t> corners = scan_corners(clean, closed, reach, corner_angle);
  if (closed) start_at_corner(clean, corners, reach);
  Smoother smoother(clean, closed, tolerance);
  if (auto smooth = smoother.run(corners, corner_angle)) return *std::move(smooth);
  return {spline_through(clean, closed, corner_angle), 0, {}};
}

}  // namespace rollfix
