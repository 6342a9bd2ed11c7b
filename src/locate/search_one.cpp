#include <algorithm>
#include <cmath>
#include <utility>

#include "corner_sets.hpp"
#include "part/cursor.hpp"
#include "root_search.hpp"
#include "searches.hpp"

// Notation:
//   s, s + L        start and end of a roll: `here` (up to `next`), and `here + pair.offset` on the end's own spiral
//   L, theta        the reading: `length_`, `reading_->turn`
//   f(s)            Theta(s + L) - Theta(s) - theta; where the end is at a convex corner, an interval of values
//   shift, lift     of a cursor: length and turn of the whole laps that it has gone round
//   pieces          the starts on which |f| is within the tolerance; `roots`: the places worth listing in them
// Follows eqs. (4) and (5) of the paper (Jia, IROS 2001); docs/search.md, "Once per reading", steps 2 and 6. Step 1,
// what is passed over, is candidates.cpp; steps 3 to 5 are root_search.cpp.
// Idea: s runs along the boundary and s + L runs with it. Where either of them passes to another spiral is a cut;
// between cuts one pair of spirals is searched. A further reading is searched only on the pieces that those before it
// left.
namespace rollfix::locating {
namespace {

/// Moves the first contact along stretches of the boundary and searches f of one reading on every pair of spirals that
/// the roll's two ends pass.
class Sweep {
 public:
  Sweep(const ContactEquations& question, const LocateOptions& options)
      : part_(question.part),
        turning_(part_.turning()),
        same_place_(kLengthAccuracy * part_.perimeter()),
        allowed_(options.tolerance),
        tolerance_(options.tolerance),
        search_(options.tolerance, options.budget, part_.perimeter()) {}

  /// What is run from here on is about this reading.
  void ask(const Reading& reading) {
    reading_ = &reading;
    length_ = reading.length[0];
    tolerance_ = allowed_ + reading.pivot;
    search_.allow(allowed_, reading.pivot);
  }

  /// What all runs found together.
  Findings& found() { return search_.findings; }

  /// Walks the first contact s along [lo, hi] of the boundary: cuts it where s or its end s + L passes from one spiral
  /// to the next, searches each piece, and looks at the pivot wherever the end passes a convex corner. Stops where it
  /// gives up: after that there must be no other run.
  void run(const Interval& range) {
    if (range.width() <= same_place_) {
      look_at(range);
      return;
    }
    // On every turn of the loop all s < here are decided, and from_start and from_end are Theta and kappa at s = here
    // and at its end, as limits from above.
    Cursor start = Cursor::ahead(turning_, range.lo);
    Cursor end = Cursor::ahead(turning_, range.lo + length_);
    auto [from_start, from_end] = enter(start, end, range.lo);
    double here = range.lo;
    while (here < range.hi && search_.findings.unresolved.empty()) {
      const SpiralPair pair = pair_of(start, end);
      // The s at which the start passes to the next spiral, and the s at which the end does.
      const double start_passes = pair.start.hi;
      const double end_passes = pair.end.hi - pair.offset;
      double next = std::min({start_passes, end_passes, range.hi});
      if (range.hi - next <= same_place_) next = range.hi;
      // Both may pass at once, as where L is the period of a symmetric part.
      const bool start_moves = start_passes - next <= same_place_ && !start.is_last();
      const bool end_moves = end_passes - next <= same_place_ && !end.is_last();

      // A spiral's own end costs no evaluation, so that a cut takes one evaluation at most.
      const Turning at_start = start_moves ? end_of(pair.start, next) : turning_.on_spiral(pair.start, next);
      const Turning at_end =
          end_moves ? end_of(pair.end, next + pair.offset) : turning_.on_spiral(pair.end, next + pair.offset);
      search_.findings.counts.evaluations += (start_moves ? 0 : 1) + (end_moves ? 0 : 1);
      // Cuts that differ by rounding leave nothing between them.
      if (next - here > same_place_) {
        search_.run(pair, pair.sample(here, from_start, from_end), pair.sample(next, at_start, at_end));
      }
      // The budget is used up: what lies ahead is not decided either.
      if (!search_.findings.unresolved.empty()) search_.findings.unresolved.back().hi = range.hi;

      if (next >= range.hi && !end_moves) break;
      if (end_moves) {
        // Theta on both sides of the joint that the end passes, unwrapped. Between them f(next) is a set.
        const double before = pair.end.end.angle + end.lift();
        end.advance();
        const double after = end.angle_after();
        pass_corner(next, at_start.angle, before, after);
        if (start_moves && next < range.hi) {  // both at once: the start's other side
          pass_corner(next, turning_.spirals()[start.index() + 1].start.angle, before, after);
        }
      }
      if (next >= range.hi) break;
      if (start_moves) start.advance();
      // The same place, as the limits from above: on the spirals that begin there.
      const SpiralPair onwards = pair_of(start, end);
      from_start = start_moves ? start_of(start.spiral(), next) : at_start;
      from_end = end_moves ? start_of(end.spiral(), next + onwards.offset) : at_end;
      here = next;
    }
  }

 private:
  /// A single place: the only first contact of an open curve for a roll as long as the curve, or what the narrowest
  /// tolerance of another reading left. |f| changes across it by its width times the slope.
  void look_at(const Interval& place) {
    const double s = place.middle();
    const double residual = residual_at({part_, {reading_, 1}}, s);
    const double slope = std::abs(turning_.curvature(s)) + std::abs(turning_.curvature(s + length_));
    if (residual > allowed_ + 0.5 * place.width() * slope) return;
    search_.findings.pieces.push_back({place.lo, place.hi});
    search_.findings.roots.push_back({s, residual <= kTurnAccuracy});
  }

  /// The pair of spirals that the start and the end of the roll are on. The end's laps are taken off L and off theta,
  /// so that Theta is evaluated on the first lap only.
  SpiralPair pair_of(const Cursor& start, const Cursor& end) const {
    return {turning_, start.spiral(), end.spiral(), length_ - end.shift(), reading_->turn - end.lift()};
  }

  /// A spiral's own ends, as seen from a place beside them that is the same up to rounding: where curvature is large
  /// that makes more of a difference than the tolerance.
  Turning start_of(const Spiral& spiral, double s) const { return beside(spiral, spiral.start, spiral.lo, s); }
  Turning end_of(const Spiral& spiral, double s) const { return beside(spiral, spiral.end, spiral.hi, s); }
  Turning beside(const Spiral& spiral, const Turning& at, double end, double s) const {
    const double turn = at.curvature * (s - end);
    if (std::abs(turn) <= kTurnAccuracy) return {at.angle + turn, at.curvature};
    // Where a curve is at rest its curvature falls from infinity: by what the spiral turns on the inside.
    const bool is_inside = s >= spiral.lo && s <= spiral.hi;
    const double inner = std::clamp(is_inside ? s : 2 * end - s, spiral.lo, spiral.hi);
    const double change = turning_.on_spiral(spiral, inner).angle - at.angle;
    return {at.angle + (is_inside ? change : -change), at.curvature};
  }

  /// Both contacts at the beginning, and the corner where the end stands, if it does.
  std::pair<Turning, Turning> enter(Cursor& start, const Cursor& end, double lo) {
    // s = P - rounding: the same place, one lap earlier.
    if (start.winding() > 0) start = Cursor::at_spiral(turning_, start.index());
    const SpiralPair pair = pair_of(start, end);
    const double s = std::max(lo, pair.start.lo);
    const Turning at_start = turning_.on_spiral(pair.start, s);
    search_.findings.counts.evaluations += 2;
    if (std::abs(lo + pair.offset - pair.end.lo) <= same_place_ && !end.is_first()) {
      pass_corner(lo, at_start.angle, end.angle_before(), end.angle_after());
    }
    return {at_start, turning_.on_spiral(pair.end, s + pair.offset)};
  }

  /// The end of the roll passes a joint while the start is at s: where that is a convex corner, or a tiny concave one,
  /// f(s) is an interval.
  void pass_corner(double s, double start_angle, double before, double after) {
    const Corner corner{s, after - before};
    if (std::abs(corner.turn) <= kTurnAccuracy || corner.is_concave()) return;
    // f(s) is anything in [least, most]: `distance` is how far 0 is outside.
    const double least = std::min(before, after) - start_angle - reading_->turn;
    const double most = std::max(before, after) - start_angle - reading_->turn;
    const double distance = std::max({least, -most, 0.0});
    if (distance > tolerance_) return;
    search_.findings.pieces.push_back({s, s, false, true});
    search_.findings.roots.push_back({s, distance <= kTurnAccuracy, true});
  }

  const Part& part_;
  const TurningFunction& turning_;
  const Reading* reading_ = nullptr;
  double length_ = 0;  // L
  double same_place_;
  double allowed_;    // of |f|
  double tolerance_;  // with what the reading leaves open
  RootSearch search_;
};

/// What the first reading allows on the stretches of the range.
void search_stretches(const ContactEquations& question, const Interval& range, const Stretches& stretches,
                      Sweep& sweep) {
  const double same_place = kLengthAccuracy * question.part.perimeter();
  // After an unresolved interval there is no further run: it is widened to the end of the range below.
  sweep.ask(question.readings.front());
  Findings& found = sweep.found();
  for (const Interval& stretch : stretches) {
    // A single place beside what is passed over is there for its corner.
    if (stretch.width() > same_place || range.width() <= same_place) sweep.run(stretch);
    if (!found.unresolved.empty()) break;
  }
  if (!found.unresolved.empty()) found.unresolved.back().hi = range.hi;
}

/// Pieces that touch are one: else what a reading cuts into pieces, though it allows all of it, as a finger at rest
/// does, a further one cuts again and again. Continua stay apart from what is beside them.
void join_touching(Pieces& pieces) {
  // Pieces are in rising order; [0, last] are joined already.
  const auto is_plain = [](const StartPiece& piece) { return !piece.exact && !piece.corner; };
  std::size_t last = 0;
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    if (is_plain(pieces[last]) && is_plain(pieces[k]) && pieces[k].lo <= pieces[last].hi) {
      pieces[last].hi = std::max(pieces[last].hi, pieces[k].hi);
    } else {
      pieces[++last] = pieces[k];
    }
  }
  if (!pieces.empty()) pieces.resize(last + 1);
}

/// Keeps of each piece what a further reading allows as well; at a corner's pivot what all of them allow together.
void narrow(const ContactEquations& question, const Reading& further, double tolerance, Sweep& sweep) {
  // Off corners the readings before were applied already. A pivot is shared by all readings, so all are applied
  // together.
  const ContactEquations its_own{question.part, {&further, 1}};
  Findings& kept = sweep.found();
  Pieces pieces = std::exchange(kept.pieces, {});
  join_touching(pieces);
  sweep.ask(further);
  for (const StartPiece& piece : pieces) {
    if (!kept.unresolved.empty()) {
      // Given up: what is left of the earlier readings is listed instead.
      kept.unresolved.push_back({piece.lo, piece.hi});
    } else if (piece.lo == piece.hi) {
      const double residual = residual_at(piece.corner ? question : its_own, piece.lo);
      if (residual <= tolerance) kept.pieces.push_back(piece);
    } else {
      const std::size_t first = kept.pieces.size();
      // f = 0 on the piece only if every reading's f is.
      sweep.run({piece.lo, piece.hi});
      for (std::size_t k = first; k < kept.pieces.size(); ++k) kept.pieces[k].exact &= piece.exact;
    }
  }
}

/// A first contact at a convex corner: the finger may have pivoted there by any amount, the same for all readings.
void look_at_start(const ContactEquations& question, const Corner& corner, double tolerance, Findings& findings) {
  if (corner.is_concave()) return;
  const double residual = residual_at(question, corner.s);
  if (residual > tolerance) return;
  findings.pieces.push_back({corner.s, corner.s, false, true});
  findings.roots.push_back({corner.s, residual <= kTurnAccuracy, true});
}

/// Examines each convex corner on the stretches as a first contact. The sweep takes the two limits of Theta there, not
/// the angles in between.
void add_start_corners(const ContactEquations& question, const Stretches& stretches, double tolerance,
                       Findings& findings) {
  const Part& part = question.part;
  const std::vector<Corner>& corners = part.corners();
  if (corners.empty() || stretches.empty()) return;
  const bool ends_at_seam = part.closed() && stretches.back().hi >= part.perimeter();
  // The corner at s = 0 is also the end, s = P, of the last stretch.
  if (corners.front().s == 0 && ends_at_seam && stretches.front().lo > 0) {
    look_at_start(question, corners.front(), tolerance, findings);
  }
  for (const Interval& stretch : stretches) {
    auto next = std::lower_bound(corners.begin(), corners.end(), stretch.lo,
                                 [](const Corner& corner, double s) { return corner.s < s; });
    for (; next != corners.end() && next->s <= stretch.hi; ++next) {
      look_at_start(question, *next, tolerance, findings);
    }
  }
}

/// The same intervals, those that touch made one.
std::vector<PerFinger<Interval>> joined(std::vector<Interval> intervals) {
  std::sort(intervals.begin(), intervals.end(),
            [](const Interval& one, const Interval& two) { return one.lo < two.lo; });
  std::vector<PerFinger<Interval>> result;
  for (const Interval& interval : intervals) {
    if (!result.empty() && interval.lo <= result.back()[0].hi) {
      result.back()[0].hi = std::max(result.back()[0].hi, interval.hi);
    } else {
      result.emplace_back(interval);
    }
  }
  return result;
}

}  // namespace

/// One finger: passes over what the tree excludes, sweeps the rest for the first reading, narrows by each further one,
/// adds first contacts at corners, and makes placements. `Search::status` is left to the caller.
Search search_one(const ContactEquations& question, const LocateOptions& options) {
  const Interval range = first_contacts(question, 0);
  const Candidates candidates = find_candidates(question, range, options.tolerance);
  Sweep sweep(question, options);
  search_stretches(question, range, candidates.stretches, sweep);
  for (const Reading& further : question.readings.subspan(1)) narrow(question, further, options.tolerance, sweep);
  Findings& found = sweep.found();
  add_start_corners(question, candidates.stretches, options.tolerance, found);
  Search search;
  search.unresolved = joined(std::move(found.unresolved));
  search.counts = {found.counts.intervals + candidates.counts.intervals,
                   found.counts.evaluations + candidates.counts.evaluations};
  search.placements = make_placements(question, std::move(found));
  return search;
}

}  // namespace rollfix::locating
