#include "trace.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

// Notation:
//   s, p(s)         arc length and the boundary; a trace is p at some s, with straight edges in between: Trace
//   tolerance       as far an edge's middle may be off the curve: Sampler; half of it, as far a vertex that is left out
//                   may be off the edge that takes its place: `simplify`
// Follows D. H. Douglas and T. K. Peucker, "Algorithms for the reduction of the number of points required to represent
// a digitized line or its caricature" (1973).
// Idea: s stays with each vertex, so that a place of the boundary is found on the polyline by its arc length.
namespace rollfix::draw {
namespace {

constexpr std::size_t kSeeds = 256;           // vertices that every boundary starts with
constexpr std::size_t kMostSpirals = 8192;    // beyond this their ends are not worth a vertex each
constexpr std::size_t kMostSampled = 400000;  // vertices before simplification
constexpr std::size_t kRun = 1024;            // vertices simplified at a time: keeps the worst case linear

/// Arc lengths at which the boundary is surely sampled. Between neighbouring spirals' ends the curvature keeps its
/// sign, so that the middle of a stretch is about the farthest from its chord.
std::vector<double> seeds(const Part& part) {
  const double P = part.perimeter();
  const std::vector<Spiral>& spirals = part.turning().spirals();
  const std::size_t even = spirals.size() > kMostSpirals ? 8 * kMostSpirals : kSeeds;
  std::vector<double> s;
  for (std::size_t i = 0; i <= even; ++i) s.push_back(P * static_cast<double>(i) / static_cast<double>(even));
  if (spirals.size() <= kMostSpirals) {
    for (const Spiral& spiral : spirals) s.push_back(std::min(std::max(spiral.lo, 0.0), P));
  }
  std::sort(s.begin(), s.end());
  s.erase(std::unique(s.begin(), s.end()), s.end());
  return s;
}

double distance_to_chord(const Vec2& point, const Vec2& from, const Vec2& to) {
  const Vec2 chord = to - from;
  const double squared = chord.squaredNorm();
  if (squared == 0) return (point - from).norm();
  const double along = std::clamp((point - from).dot(chord) / squared, 0.0, 1.0);
  return (point - from - along * chord).norm();
}

/// Samples a part by halving stretches until each is within the tolerance of its chord.
class Sampler {
 public:
  Sampler(const Part& part, double tolerance) : part_(part), tolerance_(tolerance) {}

  Trace run() {
    const double P = part_.perimeter();
    const std::vector<double> at = seeds(part_);
    out_.closed = part_.closed();
    out_.length = P;
    add(0, part_.point(0));
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      const Vec2 to = i + 2 == at.size() && part_.closed() ? out_.points.front() : part_.point(at[i + 1]);
      halve(at[i], at[i + 1], out_.points.back(), to);
      add(at[i + 1], to);
    }
    return std::move(out_);
  }

 private:
  void add(double s, const Vec2& point) {
    out_.s.push_back(s);
    out_.points.push_back(point);
  }

  void halve(double lo, double hi, const Vec2& from, const Vec2& to) {
    // A stretch shorter than a few tolerances can't stray far; the count guards against endless boundaries.
    if (hi - lo < 4 * tolerance_ || out_.points.size() > kMostSampled) return;
    const double middle = lo + 0.5 * (hi - lo);
    const Vec2 point = part_.point(middle);
    const bool straight = distance_to_chord(point, from, to) <= tolerance_;
    // An arc length well above the chord means that the stretch winds, whatever its middle says.
    if (straight && (to - from).norm() > 0.99 * (hi - lo)) return;
    halve(lo, middle, from, point);
    add(middle, point);
    halve(middle, hi, point, to);
  }

  const Part& part_;
  double tolerance_;
  Trace out_;
};

/// Douglas-Peucker on points[first..last]; appends the kept indices except `last`.
void simplify_run(const std::vector<Vec2>& points, std::size_t first, std::size_t last, double tolerance,
                  std::vector<std::size_t>& kept) {
  double farthest = 0;
  std::size_t where = first;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double distance = distance_to_chord(points[i], points[first], points[last]);
    if (distance > farthest) {
      farthest = distance;
      where = i;
    }
  }
  if (farthest <= tolerance) {
    kept.push_back(first);
    return;
  }
  simplify_run(points, first, where, tolerance, kept);
  simplify_run(points, where, last, tolerance, kept);
}

/// Index of the edge that contains s, 0 <= s <= length; at a vertex the one after it or before it.
std::size_t edge_at(const Trace& trace, double s, Side side) {
  const auto after = side == Side::after ? std::upper_bound(trace.s.begin(), trace.s.end(), s)
                                         : std::lower_bound(trace.s.begin(), trace.s.end(), s);
  const auto index = std::distance(trace.s.begin(), after);
  const auto last = static_cast<std::ptrdiff_t>(trace.s.size()) - 2;
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(index - 1, 0, last));
}

Vec2 on_edge(const Trace& trace, std::size_t edge, double s) {
  const double width = trace.s[edge + 1] - trace.s[edge];
  if (s >= trace.s[edge + 1]) return trace.points[edge + 1];
  const double fraction = width > 0 ? std::max((s - trace.s[edge]) / width, 0.0) : 0;
  return trace.points[edge] + fraction * (trace.points[edge + 1] - trace.points[edge]);
}

}  // namespace

Trace trace(const Part& part, double tolerance, std::size_t most) {
  const Trace fine = Sampler(part, tolerance).run();
  Trace out;
  out.closed = fine.closed;
  out.length = fine.length;
  for (std::size_t i : simplify(fine.points, 0.5 * tolerance, most)) {
    out.s.push_back(fine.s[i]);
    out.points.push_back(fine.points[i]);
  }
  return out;
}

std::vector<std::size_t> simplify(const std::vector<Vec2>& points, double tolerance) {
  std::vector<std::size_t> kept;
  if (points.empty()) return kept;
  for (std::size_t first = 0; first + 1 < points.size();) {
    const std::size_t last = std::min(first + kRun, points.size() - 1);
    simplify_run(points, first, last, tolerance, kept);
    first = last;
  }
  kept.push_back(points.size() - 1);
  return kept;
}

std::vector<std::size_t> simplify(const std::vector<Vec2>& points, double tolerance, std::size_t most) {
  std::vector<std::size_t> kept = simplify(points, tolerance);
  while (kept.size() > std::max<std::size_t>(most, 2 * points.size() / kRun + 2)) {
    tolerance *= 1.5;
    kept = simplify(points, tolerance);
  }
  return kept;
}

std::vector<Vec2> pick(const std::vector<Vec2>& points, const std::vector<std::size_t>& indices) {
  std::vector<Vec2> out;
  out.reserve(indices.size());
  for (std::size_t i : indices) out.push_back(points[i]);
  return out;
}

Vec2 point_at(const Trace& trace, double s) {
  const double at = trace.boundary().base(s);
  return on_edge(trace, edge_at(trace, at, Side::after), at);
}

Vec2 direction_at(const Trace& trace, double s, Side side) {
  const double at = trace.boundary().reduced(s, side).base;
  const std::size_t edge = edge_at(trace, at, side);
  const Vec2 step = trace.points[edge + 1] - trace.points[edge];
  const double size = step.norm();
  return size > 0 ? Vec2(step / size) : Vec2(1, 0);
}

Trace slice(const Trace& trace, double lo, double hi) {
  Trace out;
  out.closed = false;
  if (!trace.closed) {
    lo = std::clamp(lo, 0.0, trace.length);
    hi = std::clamp(hi, lo, trace.length);
  }
  out.length = hi - lo;
  out.s.push_back(lo);
  out.points.push_back(point_at(trace, lo));
  const Wrapped start = trace.boundary().reduced(lo);
  double shift = start.winding * trace.length;
  std::size_t i = edge_at(trace, start.base, Side::after) + 1;
  while (trace.s[i] + shift < hi) {
    // The seam's vertex is there twice: as the last one and as the first.
    if (trace.s[i] + shift > lo) {
      out.s.push_back(trace.s[i] + shift);
      out.points.push_back(trace.points[i]);
    }
    if (++i < trace.s.size()) continue;
    if (!trace.closed) break;
    i = 1;
    shift += trace.length;
  }
  out.s.push_back(hi);
  out.points.push_back(point_at(trace, hi));
  return out;
}

Trace densify(const Trace& trace, double step) {
  Trace out;
  out.closed = trace.closed;
  out.length = trace.length;
  for (std::size_t i = 0; i + 1 < trace.points.size(); ++i) {
    const Vec2 edge = trace.points[i + 1] - trace.points[i];
    const double count = std::max(1.0, std::ceil(edge.norm() / step));
    for (double k = 0; k < count; ++k) {
      out.s.push_back(trace.s[i] + (trace.s[i + 1] - trace.s[i]) * k / count);
      out.points.emplace_back(trace.points[i] + k / count * edge);
    }
  }
  out.s.push_back(trace.s.back());
  out.points.push_back(trace.points.back());
  return out;
}

}  // namespace rollfix::draw
