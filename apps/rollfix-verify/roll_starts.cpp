#include "roll_starts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "boundary.hpp"
#include "document.hpp"

// Notation:
//   Theta(s)        the tangent's angle
//   L, theta        of a reading: RollReading
//   alpha           the tangent's angle at the start: Theta(s), or at a corner that of the pivot
//   f               Theta(s + L) - alpha - theta: `misses`
// Follows docs/certificates.md, "Touches".
// Idea: a roll can have started at a place if every |f| is within the tolerance. At a convex corner Theta(s + L) may be
// anything between its two sides. Everything is a ball, so that what is excluded is excluded.
namespace rollfix_verify {
namespace {

// A roll's end is moved off a joint by so much of the perimeter, then further and further: only outwards.
constexpr double kStepOff = kLengthSlack;
constexpr double kFurther = 8;
constexpr int kMostSteps = 9;
// Rolls that end on a stretch over more joints than this are told on shorter stretches.
constexpr long kMostEndJoints = 6;
constexpr double kUnknownSpread = std::numeric_limits<double>::infinity();

/// How far a reading can be off at the ends in these sets, with the tangent at the start in this one.
std::vector<Ball> misses(const std::vector<Ball>& ends, const Ball& start, const Ball& turn) {
  std::vector<Ball> result;
  for (const Ball& end : ends) result.push_back(end - start - turn);
  return result;
}

/// Every possible value is certainly outside.
bool are_beyond(const std::vector<Ball>& misses, double most) {
  return std::all_of(misses.begin(), misses.end(),
                     [&](const Ball& f) { return f.is_above(most) || f.is_below(-most); });
}

/// Every possible value is certainly inside.
bool are_within(const std::vector<Ball>& misses, double most) {
  return std::all_of(misses.begin(), misses.end(), [&](const Ball& f) { return abs(f).is_below(most); });
}

/// Half the width of the widest set, radians; infinite where nothing is known.
double widest(const std::vector<Ball>& misses) {
  double most = 0;
  for (const Ball& f : misses) most = f.is_finite() ? std::max(most, 0.5 * spread(f)) : kUnknownSpread;
  return most;
}

}  // namespace

RollStarts::RollStarts(const Boundary& boundary, const CentreTree& tree, std::vector<RollReading> readings,
                       double tolerance)
    : boundary_(boundary),
      tree_(tree),
      readings_(std::move(readings)),
      tolerance_(tolerance),
      period_(boundary.perimeter().middle()),
      base_(tree.direction(boundary.front(0))) {}

/// Computed once for each node, and kept.
const RollStarts::On& RollStarts::on(int node) {
  const auto index = static_cast<std::size_t>(node);
  if (index >= known_.size()) known_.resize(index + 1);
  if (!known_[index]) known_[index] = look(tree_.node(node));
  return *known_[index];
}

/// The place so far along, or beyond it that way where a joint is too near to tell; of an open outline no further than
/// its ends.
std::optional<Place> RollStarts::clear_of_joints(const Ball& s, int way) const {
  double step = 0;
  for (int k = 0; k < kMostSteps; ++k) {
    if (std::optional<Place> place = boundary_.after_or_end(s + way * step * period_)) return place;
    step = step > 0 ? kFurther * step : kStepOff;
  }
  return std::nullopt;
}

/// The tangent's angles where rolls by this length end that start between two places, as sets; none: not known.
std::optional<std::vector<Ball>> RollStarts::ends(const Ball& from, const Ball& to, const Ball& length) const {
  const std::optional<Place> first = clear_of_joints(from + length, -1);
  const std::optional<Place> last = clear_of_joints(to + length, 1);
  if (!first || !last || last->curve - first->curve > kMostEndJoints) return std::nullopt;
  return angles(boundary_, segments(boundary_, *first, *last));
}

/// Whether such rolls all end beyond an end of an open outline.
bool RollStarts::leaves(const Ball& from, const Ball& to, const Ball& length) const {
  if (boundary_.closed()) return false;
  const double slack = kLengthSlack * period_;
  return (to + length).is_below(-slack) || (from + length).is_above(boundary_.perimeter() + slack);
}

/// Of a reading on a stretch without corners at rolls' ends: from what it is at its first place by its slope, the
/// difference of the curvatures, which is all there is along lines and circles. None: not known.
std::optional<Ball> RollStarts::by_slope(const CentreTree::Node& node, const RollReading& reading) const {
  if (node.is_corner) return std::nullopt;
  const Place from = boundary_.at(node.curve, node.u.lo);
  const Place to = boundary_.at(node.curve, node.u.hi);
  const std::optional<Place> first = boundary_.after(from.s + reading.length);
  const std::optional<Place> last = boundary_.after(to.s + reading.length);
  if (!first || !last || last->curve - first->curve > kMostEndJoints) return std::nullopt;
  if (has_corner(boundary_, *first, *last)) return std::nullopt;
  const std::vector<Segment> ends = segments(boundary_, *first, *last);
  const Ball slope = curvatures(boundary_, ends) - curvatures(boundary_, segments(boundary_, from, to));
  const Ball off = first->angle - from.angle - reading.turn + up_to(to.s - from.s) * slope;
  return off + jumps(boundary_, ends);
}

/// All readings on a node: beyond by one of them excludes it; within by all of them on all of it proves it.
RollStarts::On RollStarts::look(const CentreTree::Node& node) const {
  if (node.curve < 0) return {true, false, kUnknownSpread};  // of several curves: its halves say
  const Ball from = node.s.lo;
  const Ball to = node.s.hi;
  // alpha on all of the node, from Theta at s = 0 on.
  const Ball start = Ball(node.angle) + around_zero(node.half_turn) - base_;
  On result{true, true, 0};
  for (const RollReading& reading : readings_) {
    if (leaves(from, to, reading.length)) return {false, false, 0};
    const std::optional<std::vector<Ball>> ends = this->ends(from, to, reading.length);
    if (!ends) {
      result.all_start = false;
      result.spread = kUnknownSpread;
      continue;
    }
    std::vector<Ball> off = misses(*ends, start, reading.turn);
    if (are_beyond(off, tolerance_)) return {false, false, 0};
    // Bounds on both tangents do not know that these change together; the slope of f does.
    if (const std::optional<Ball> finer = are_within(off, tolerance_) ? std::nullopt : by_slope(node, reading)) {
      if (are_beyond({*finer}, tolerance_)) return {false, false, 0};
      if (finer->is_finite() && widest({*finer}) < widest(off)) off = {*finer};
    }
    if (are_within(off, tolerance_)) continue;
    result.all_start = false;
    result.spread = std::max(result.spread, widest(off) / tolerance_);
  }
  return result;
}

/// The test of one stated place, to the slack of stated lengths and angles: no reading excludes it, and it is known of
/// each where its roll ends.
bool RollStarts::may_start(const Place& place, const Ball& direction) const {
  const Ball own = place.angle;
  const Ball start = own + to_nearest_turn(direction - base_ - own) + around_zero(kTurnSlack);
  const Ball reach = kLengthSlack * period_;
  return std::all_of(readings_.begin(), readings_.end(), [&](const RollReading& reading) {
    if (leaves(place.s, place.s, reading.length)) return false;
    const std::optional<std::vector<Ball>> ends = this->ends(place.s - reach, place.s + reach, reading.length);
    return ends && !are_beyond(misses(*ends, start, reading.turn), tolerance_);
  });
}

}  // namespace rollfix_verify
