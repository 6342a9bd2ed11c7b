#include "sweep.hpp"

#include <algorithm>
#include <cmath>

#include "corner_sets.hpp"

namespace rollfix {
namespace {

/// A point that moves along the boundary from spiral to spiral.
struct Walker {
  const TurningFunction& turning;
  std::size_t index;
  double winding = 0;

  const Spiral& spiral() const { return turning.spirals()[index]; }
  bool at_open_end() const { return !turning.closed() && index + 1 == turning.spirals().size(); }
  void advance() {
    if (++index < turning.spirals().size()) return;
    index = 0;
    winding += 1;
  }
};

class Sweep {
 public:
  Sweep(const Part& part, const Reading& reading, RootSearch& search, Findings& findings, const LocateOptions& options)
      : part_(part),
        turning_(part.turning()),
        reading_(reading),
        period_(part.perimeter()),
        same_place_(kLengthAccuracy * part.perimeter()),
        tolerance_(std::max(options.tolerance, kTurnAccuracy)),
        search_(search),
        findings_(findings) {}

  void run(const Interval& range) {
    if (range.width() <= same_place_) {
      look_at(range.lo);
      return;
    }
    Walker start = place(range.lo);
    Walker end = place(range.lo + reading_.length);
    ResidualSample left = enter(start, end, range.lo);
    double here = range.lo;
    while (here < range.hi && findings_.unresolved.empty()) {
      const double offset = reading_.length - end.winding * period_;
      const double start_passes = start.spiral().hi;
      const double end_passes = end.spiral().hi - offset;
      double next = std::min({start_passes, end_passes, range.hi});
      if (range.hi - next <= same_place_) next = range.hi;
      const bool start_moves = start_passes - next <= same_place_ && !start.at_open_end();
      const bool end_moves = end_passes - next <= same_place_ && !end.at_open_end();

      const SpiralPair pair = pair_of(start, end);
      const Turning at_start = start_moves ? start.spiral().end : turning_.on_spiral(start.spiral(), next);
      const Turning at_end = end_moves ? end.spiral().end : turning_.on_spiral(end.spiral(), next + offset);
      const ResidualSample right = pair.sample(next, at_start, at_end);
      findings_.counts.evaluations += (start_moves ? 0 : 1) + (end_moves ? 0 : 1);
      if (next - here > same_place_) search_.run(pair, left, right);
      if (!findings_.unresolved.empty()) findings_.unresolved.back().hi = range.hi;

      if (next >= range.hi && !end_moves) break;
      if (end_moves) {
        const double before = at_end.angle + end.winding * turning_.period_turn();
        end.advance();
        const double after = end.spiral().start.angle + end.winding * turning_.period_turn();
        pass_corner(next, at_start.angle, before, after);
        if (start_moves && next < range.hi) {  // both at once: the start's other side
          pass_corner(next, turning_.spirals()[start.index + 1].start.angle, before, after);
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
  /// An open curve that is just as long as the roll has a single place for it.
  void look_at(double s) {
    const double residual = residual_at(part_, {reading_}, s);
    if (residual > tolerance_) return;
    findings_.pieces.push_back({s, s});
    findings_.roots.push_back({s, residual <= kTurnAccuracy});
  }

  SpiralPair pair_of(const Walker& start, const Walker& end) const {
    return {turning_, start.spiral(), end.spiral(), reading_.length - end.winding * period_,
            reading_.turn - end.winding * turning_.period_turn()};
  }

  /// A walker at s; a place a rounding error before the next spiral is on the next one.
  Walker place(double s) const {
    const Wrapped wrapped = turning_.closed() ? wrap(s, period_) : Wrapped{std::clamp(s, 0.0, period_), 0};
    Walker walker{turning_, turning_.spiral_at(wrapped.base), wrapped.winding};
    if (walker.spiral().hi - wrapped.base <= same_place_ && !walker.at_open_end()) walker.advance();
    return walker;
  }

  /// The first sample, and the corner where the end stands, if it does.
  ResidualSample enter(Walker& start, Walker& end, double lo) {
    if (start.winding > 0) start.winding = 0;  // s = P - rounding: the same place, one lap earlier
    const SpiralPair pair = pair_of(start, end);
    const ResidualSample first = pair.sample(std::max(lo, start.spiral().lo));
    findings_.counts.evaluations += 2;
    if (std::abs(lo + pair.offset - end.spiral().lo) <= same_place_ && (turning_.closed() || end.index > 0)) {
      const std::size_t before = end.index > 0 ? end.index - 1 : turning_.spirals().size() - 1;
      const double lap = (end.winding - (end.index > 0 ? 0 : 1)) * turning_.period_turn();
      pass_corner(lo, turning_.on_spiral(start.spiral(), first.s).angle, turning_.spirals()[before].end.angle + lap,
                  end.spiral().start.angle + end.winding * turning_.period_turn());
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
  double period_;
  double same_place_;
  double tolerance_;
  RootSearch& search_;
  Findings& findings_;
};

}  // namespace

void sweep(const Part& part, const Reading& reading, const Interval& range, RootSearch& search, Findings& findings,
           const LocateOptions& options) {
  Sweep(part, reading, search, findings, options).run(range);
}

}  // namespace rollfix
