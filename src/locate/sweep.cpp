#include "sweep.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "corner_sets.hpp"
#include "part/cursor.hpp"

namespace rollfix {
namespace {

class Sweep {
 public:
  Sweep(const Part& part, const Reading& reading, const LocateOptions& options)
      : part_(part),
        turning_(part.turning()),
        reading_(reading),
        length_(reading.length[0]),
        same_place_(kLengthAccuracy * part.perimeter()),
        tolerance_(options.tolerance),
        search_(options, part.perimeter()) {}

  Swept take() { return {std::move(findings_), search_.budget()}; }

  void run(const Interval& range) {
    if (range.width() <= same_place_) {
      look_at(range);
      return;
    }
    Cursor start = Cursor::ahead(turning_, range.lo);
    Cursor end = Cursor::ahead(turning_, range.lo + length_);
    ResidualSample left = enter(start, end, range.lo);
    double here = range.lo;
    while (here < range.hi && findings_.unresolved.empty()) {
      const double offset = length_ - end.shift();
      const double start_passes = start.spiral().hi;
      const double end_passes = end.spiral().hi - offset;
      double next = std::min({start_passes, end_passes, range.hi});
      if (range.hi - next <= same_place_) next = range.hi;
      const bool start_moves = start_passes - next <= same_place_ && !start.is_last();
      const bool end_moves = end_passes - next <= same_place_ && !end.is_last();

      const SpiralPair pair = pair_of(start, end);
      const Turning at_start = start_moves ? start.spiral().end : turning_.on_spiral(start.spiral(), next);
      const Turning at_end = end_moves ? end.spiral().end : turning_.on_spiral(end.spiral(), next + offset);
      const ResidualSample right = pair.sample(next, at_start, at_end);
      findings_.counts.evaluations += (start_moves ? 0 : 1) + (end_moves ? 0 : 1);
      if (next - here > same_place_) search_.run(pair, left, right);
      if (!findings_.unresolved.empty()) findings_.unresolved.back().hi = range.hi;

      if (next >= range.hi && !end_moves) break;
      if (end_moves) {
        const double before = at_end.angle + end.lift();
        end.advance();
        const double after = end.angle_after();
        pass_corner(next, at_start.angle, before, after);
        if (start_moves && next < range.hi) {  // both at once: the start's other side
          pass_corner(next, turning_.spirals()[start.index() + 1].start.angle, before, after);
        }
      }
      if (next >= range.hi) break;
      if (start_moves) start.advance();
      left = pair_of(start, end)
                 .sample(next, start_moves ? start.spiral().start : at_start, end_moves ? end.spiral().start : at_end);
      here = next;
    }
  }

 private:
  /// A single place: what an open curve has for a roll of its own length, or what another reading's least tolerance
  /// left. Across it f changes by its slope.
  void look_at(const Interval& place) {
    const std::vector<Reading> only{reading_};
    const double s = place.middle();
    const double residual = residual_at({part_, only}, s);
    const double slope = std::abs(turning_.curvature(s)) + std::abs(turning_.curvature(s + length_));
    if (residual > tolerance_ + 0.5 * place.width() * slope) return;
    findings_.pieces.push_back({place.lo, place.hi});
    findings_.roots.push_back({s, residual <= kTurnAccuracy});
  }

  SpiralPair pair_of(const Cursor& start, const Cursor& end) const {
    return {turning_, start.spiral(), end.spiral(), length_ - end.shift(), reading_.turn - end.lift()};
  }

  /// The first sample, and the corner where the end stands, if it does.
  ResidualSample enter(Cursor& start, const Cursor& end, double lo) {
    // s = P - rounding: the same place, one lap earlier.
    if (start.winding() > 0) start = Cursor::at_spiral(turning_, start.index());
    const SpiralPair pair = pair_of(start, end);
    const ResidualSample first = pair.sample(std::max(lo, start.spiral().lo));
    findings_.counts.evaluations += 2;
    if (std::abs(lo + pair.offset - end.spiral().lo) <= same_place_ && !end.is_first()) {
      pass_corner(lo, turning_.on_spiral(start.spiral(), first.s).angle, end.angle_before(), end.angle_after());
    }
    return {lo, first.value, first.start_curvature, first.end_curvature};
  }

  /// The end of the roll passes a joint while the start is at s: where that is a convex corner, or a tiny concave one,
  /// f(s) is an interval.
  void pass_corner(double s, double start_angle, double before, double after) {
    const Corner corner{s, after - before};
    if (std::abs(corner.turn) <= kTurnAccuracy || corner.is_concave()) return;
    const double least = std::min(before, after) - start_angle - reading_.turn;
    const double most = std::max(before, after) - start_angle - reading_.turn;
    const double distance = std::max({least, -most, 0.0});
    if (distance > tolerance_) return;
    findings_.pieces.push_back({s, s, false, true});
    findings_.roots.push_back({s, distance <= kTurnAccuracy, true});
  }

  const Part& part_;
  const TurningFunction& turning_;
  const Reading& reading_;
  double length_;  // L
  double same_place_;
  double tolerance_;
  RootSearch search_;
  Findings& findings_ = search_.findings;
};

}  // namespace

Swept sweep(const Part& part, const Reading& reading, const Interval& range, const LocateOptions& options) {
  Sweep sweep(part, reading, options);
  sweep.run(range);
  return sweep.take();
}

}  // namespace rollfix
