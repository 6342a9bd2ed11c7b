#include "searches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "part/turning_range.hpp"
#include "rollfix/locate.hpp"

// Notation:
//   s_k             contact of a finger at instant k: its first contact s plus L_k, with L_0 = 0: `rolls_`
//   roll            [least, most] L_k of a finger, so that all of s + roll is on its way: `roll_`
//   arc, pivot      where the finger can touch without running into the part, and at a corner at which tangents: Reach
//   r               radius of a finger; a jaw has none (curvature 0)
//   c(s)            centre of the finger that touches at s, p(s) + r n(s), n the outward normal: in a `Ball` while s is
//                   in an interval
//   depth           by how much two fingers overlap, at least: r_a + r_b - |c_a - c_b|; of a jaw r + (c - p) . n
// Follows docs/reach.md and docs/two_fingers.md.
// Idea: a placement goes where no piece of it (a box of first contacts) can do all of its roll within the reach, pivot
// at its corners as it must, and keep the fingers apart at every instant. Bounds over a piece err on its side.
namespace rollfix {
namespace {

// A continuum's line is cut into about this many pieces at most: of a long one the pieces are longer than the step that
// was asked for.
constexpr int kMostPieces = 400;

/// How far segment k of the family's line, from point k - 1 to k, moves the finger that it moves further; length.
double family_step(const Placement& placement, std::size_t k) {
  const PerFinger<double>& from = placement.family[k - 1];
  const PerFinger<double>& to = placement.family[k];
  return std::max(std::abs(to[0] - from[0]), std::abs(to[1] - from[1]));
}

/// Part i of `count` equal parts of segment k, as a box of first contacts, widened by the line's error.
PerFinger<Interval> piece(const Placement& placement, std::size_t k, int i, int count) {
  PerFinger<Interval> box = placement.extent;
  for (std::size_t f = 0; f < 2; ++f) {
    const double from = placement.family[k - 1][f];
    const double step = (placement.family[k][f] - from) / count;
    const double one = from + i * step;
    const double two = one + step;
    box[f] = {std::min(one, two) - placement.family_error, std::max(one, two) + placement.family_error};
  }
  return box;
}

// Lengths that are given or were computed elsewhere, as those in a Reach, are rounded to this share of the perimeter.
constexpr double kGivenRounding = 1e-9;

/// Are two places of the boundary one, but for the rounding of given lengths? Across s = 0 as elsewhere.
bool same_place(const Part& part, double one, double two) {
  return part.boundary().distance(one, two) <= kGivenRounding * part.perimeter();
}

/// What the finger can do at the convex corner at s; nullptr: no such corner there.
const PivotReach* pivot_at(const Part& part, const Reach& reach, double s) {
  for (const PivotReach& pivot : reach.pivots) {
    if (same_place(part, pivot.s, s)) return &pivot;
  }
  return nullptr;
}

bool is_concave_corner(const Part& part, double s) {
  return std::any_of(part.corners().begin(), part.corners().end(),
                     [&](const Corner& corner) { return corner.is_concave() && same_place(part, corner.s, s); });
}

/// The same tangents, turned by whole turns so that they are near those of a pivot.
Interval near(const Interval& angles, const Interval& pivot) {
  const double turn = 2 * std::numbers::pi;
  const double shift = turn * std::round((pivot.middle() - angles.middle()) / turn);
  return {angles.lo + shift, angles.hi + shift};
}

/// Have they an angle in common, or come as near as `slack`?
bool meets(const Interval& one, const Interval& two, double slack) {
  return one.lo <= two.hi + slack && two.lo <= one.hi + slack;
}

/// A contact that is at a corner but for rounding has the tangent of a place beside it.
double slack_of_tangents(const Part& part) {
  return kGivenRounding * (1 + part.turning().most_curvature() * part.perimeter());
}

/// Can a finger that pivots at a corner between these tangents come from the boundary before it or after it, or go
/// there? Neither asked: can it be there at all?
bool can_pivot(const PivotReach& pivot, const Interval& tangents, bool before, bool after, double slack) {
  // One interval of possible angles must do: between two of them the finger would enter the part. From the boundary
  // before the corner it must reach down to Theta's limit there, to the boundary after it up to the other limit.
  const Interval wanted = near(tangents, pivot.whole);
  return std::any_of(pivot.angles.begin(), pivot.angles.end(), [&](const Interval& angles) {
    if (before && angles.lo > pivot.whole.lo) return false;
    if (after && angles.hi < pivot.whole.hi) return false;
    return meets(angles, wanted, slack);
  });
}

/// The finger stands at the convex corner at s and can't pivot there as it would have to.
Obstruction at_pivot(const Part& part, const Reach& reach, double s) {
  return {part.boundary().base(s), false, deepest_hit(part, reach.curvature, {s, s})};
}

/// Where the finger stands still too deep, between the end of an arc and the start of the next, or the roll's end.
Obstruction beyond(const Part& part, const Reach& reach, double from, double to) {
  if (is_concave_corner(part, part.boundary().base(from)))
    return {part.boundary().base(from), true, {from, from, 0, part.point(from)}};
  const PivotReach* pivot = pivot_at(part, reach, part.boundary().base(from));
  if (pivot != nullptr && !pivot->is_whole()) return at_pivot(part, reach, from);
  // Look as far as the nearest end of an arc in the direction of the roll.
  double end = to;
  for (const Interval& arc : reach.arcs) {
    for (const double edge : {arc.lo, arc.hi}) {
      const double ahead = part.boundary().ahead(from, edge);
      // How far the arc's end is from `from`, below 0 where the roll goes backwards.
      const double signed_ahead = to >= from || !part.closed() ? ahead : ahead - part.perimeter();
      const double least = kGivenRounding * part.perimeter();
      if (to >= from && signed_ahead > least) end = std::min(end, from + signed_ahead);
      if (to < from && signed_ahead < -least) end = std::max(end, from + signed_ahead);
    }
  }
  const Interval contacts{std::min(from, end), std::max(from, end)};
  Obstruction found{0, false, deepest_hit(part, reach.curvature, contacts)};
  found.s = part.boundary().base(found.hit.contact);
  return found;
}

/// One finger's pivots at both ends of a roll that starts or ends at a corner: can it pivot as a placement asks?
/// `roll`: from the first contact to the furthest on both sides; `last`: to the last.
bool can_pivot(const Part& part, const Reach& reach, const Placement& placement, std::size_t finger,
               const Interval& roll, double last) {
  if (!placement.pivot) return true;
  const Pivot& tangents = (*placement.pivot)[finger];
  const double slack = slack_of_tangents(part);
  const PivotReach* start = pivot_at(part, reach, placement.start[finger]);
  // A roll that goes back from the corner leaves it by the boundary before it, one that goes forwards by that after it.
  if (start != nullptr && !can_pivot(*start, tangents.start, roll.lo<0, roll.hi> 0, slack)) return false;
  const PivotReach* end = pivot_at(part, reach, placement.end[finger]);
  if (end == nullptr) return true;
  // It arrives by the boundary before the corner if it went forwards and no row went further, likewise by that after it
  // if it went backwards. Else it is only asked whether it can be there at all.
  return can_pivot(*end, tangents.end, last > 0 && last >= roll.hi, last < 0 && last <= roll.lo, slack);
}

/// What is in the way of a finger that can't.
Obstruction pivot_obstruction(const Part& part, const Reach& reach, const Placement& placement, std::size_t finger) {
  const PivotReach* start = pivot_at(part, reach, placement.start[finger]);
  const bool at_start = start != nullptr && !start->is_whole();
  return at_pivot(part, reach, at_start ? placement.start[finger] : placement.end[finger]);
}

// A continuum of pairs is looked at in pieces whose fingers move by less than this share of the smaller radius.
constexpr double kPiece = 0.1;

/// Where a finger's centre can be while its contact is in an interval: in a disk.
struct Ball {
  Vec2 centre;
  double radius = 0;
};

/// The centre of a disk that touches somewhere in `contacts`. The contact is within half the width of p(middle), and
/// the normal turns by at most half the spread of the tangent's angles, which moves the centre by that times the
/// radius.
Ball centre_of(const Part& part, double radius, const Interval& contacts) {
  const Interval angles = tangents_over(part, contacts);
  const double angle = angles.middle();
  // The tangent turned by -90 degrees: outward, for the material is on the left.
  const Vec2 normal(std::sin(angle), -std::cos(angle));
  return {part.point(contacts.middle()) + radius * normal, 0.5 * contacts.width() + 0.5 * radius * angles.width()};
}

/// The least (c - p) . n for c in the ball and a jaw that touches at p in an interval of s, n the part's outward normal
/// there: how far c lies on the jaw's side of its line. Both c and p move by `moved` together, and n turns by half the
/// spread of the angles, which changes the product by that times |c - p| at most.
double least_depth(const Part& part, const Interval& contacts, const Ball& ball) {
  const Interval angles = tangents_over(part, contacts);
  const Vec2 normal(std::sin(angles.middle()), -std::cos(angles.middle()));
  const Vec2 from_contact = ball.centre - part.point(contacts.middle());
  const double moved = 0.5 * contacts.width() + ball.radius;
  return from_contact.dot(normal) - moved - 0.5 * angles.width() * (from_contact.norm() + moved);
}

/// Decides for one placement after the other whether the fingers can do the whole roll from it.
class Sieve {
 public:
  /// The arguments are those of `drop_unreachable`. Each roll is shortened by `length_error` at both ends before it is
  /// tested, so that only rolls that are surely impossible are dropped.
  Sieve(const Part& part, const PerFinger<Reach>& reach, const std::vector<Reading>& readings,
        const std::vector<Reading>& more, double length_error, bool may_overlap)
      : part_(part), reach_(reach), length_error_(length_error), last_(PerFinger<double>::of(reach.size())) {
    Reading first;
    first.length = last_;
    rolls_.push_back(first);
    rolls_.insert(rolls_.end(), readings.begin(), readings.end());
    rolls_.insert(rolls_.end(), more.begin(), more.end());
    roll_ = PerFinger<Interval>::of(reach.size());
    for (std::size_t finger = 0; finger < reach.size(); ++finger) {
      Interval& roll = roll_[finger];
      for (const Reading& reading : rolls_) {
        roll = {std::min(roll.lo, reading.length[finger]), std::max(roll.hi, reading.length[finger])};
      }
      // Each end is taken back by the error, not beyond the first contact.
      roll = {std::min(0.0, roll.lo + length_error), std::max(0.0, roll.hi - length_error)};
      if (!readings.empty()) last_[finger] = readings.back().length[finger];
    }
    must_be_apart_ = !may_overlap && reach.size() == 2 && (reach[0].curvature > 0 || reach[1].curvature > 0);
  }

  /// Why a placement is impossible; nothing when it may be possible.
  std::optional<Impossible> look_at(const Placement& placement) const {
    // Reach first: a placement goes if every piece of it leaves the reach, or a pivot is impossible.
    const std::vector<PerFinger<Interval>> boxes = boxes_of(placement);
    const auto is_beyond = [&](const PerFinger<Interval>& box) { return leaves_reach(box); };
    if (!can_pivot(placement) || std::all_of(boxes.begin(), boxes.end(), is_beyond)) return beyond_reach(placement);
    if (!must_be_apart_) return std::nullopt;
    // Then both together: pieces that leave the reach, and pieces in which the fingers overlap.
    const auto is_out = [&](const PerFinger<Interval>& box) { return leaves_reach(box) || overlaps(box); };
    if (!std::all_of(boxes.begin(), boxes.end(), is_out)) return std::nullopt;
    Impossible found{placement, Impossible::Reason::overlap, 0, {}, 0, 0};
    // Impossible. The instant that is reported is the one of the deepest overlap from the placement's own start.
    const PerFinger<Interval> start(Interval{placement.start[0], placement.start[0]},
                                    Interval{placement.start[1], placement.start[1]});
    for (std::size_t k = 0; k < rolls_.size(); ++k) {
      const double depth = overlap(start, k);
      if (depth <= found.depth) continue;
      found.instant = k;
      found.depth = depth;
    }
    return found;
  }

 private:
  /// Can each finger pivot as the placement's corners ask?
  bool can_pivot(const Placement& placement) const {
    for (std::size_t finger = 0; finger < reach_.size(); ++finger) {
      if (!rollfix::can_pivot(part_, reach_[finger], placement, finger, roll_[finger], last_[finger])) return false;
    }
    return true;
  }

  /// Does a finger leave its reach from wherever in the box it starts?
  bool leaves_reach(const PerFinger<Interval>& box) const {
    for (std::size_t finger = 0; finger < reach_.size(); ++finger) {
      if (!can_roll(reach_[finger], box[finger], roll_[finger])) return true;
    }
    return false;
  }

  /// The first finger that meets something on its way from the placement's own start; else it can't pivot as it must.
  Impossible beyond_reach(const Placement& placement) const {
    Impossible found{placement, Impossible::Reason::reach, 0, {}, 0, 0};
    for (std::size_t finger = 0; finger < reach_.size(); ++finger) {
      const auto obstruction = obstruction_of(part_, reach_[finger], placement.start[finger], roll_[finger]);
      if (!obstruction) continue;
      found.finger = finger;
      found.obstruction = *obstruction;
      return found;
    }
    for (std::size_t finger = 0; finger < reach_.size(); ++finger) {
      if (rollfix::can_pivot(part_, reach_[finger], placement, finger, roll_[finger], last_[finger])) continue;
      found.finger = finger;
      found.obstruction = pivot_obstruction(part_, reach_[finger], placement, finger);
      break;
    }
    return found;
  }

  /// At some instant the fingers overlap by more than the larger slack, from wherever in the box they started.
  bool overlaps(const PerFinger<Interval>& box) const {
    const double slack = std::max(reach_[0].slack, reach_[1].slack);
    for (std::size_t k = 0; k < rolls_.size(); ++k) {
      if (overlap(box, k) > slack) return true;
    }
    return false;
  }

  /// By how much the fingers overlap at an instant, at least, from wherever in the box they started.
  double overlap(const PerFinger<Interval>& box, std::size_t instant) const {
    if (reach_[0].curvature == 0) return depth_under_jaw(box, instant, 0);
    if (reach_[1].curvature == 0) return depth_under_jaw(box, instant, 1);
    double depth = 0;
    std::array<Ball, 2> balls;
    for (const std::size_t finger : {0U, 1U}) {
      // Any two centres are at most as far apart as the middles and both balls' radii together.
      const double radius = 1 / reach_[finger].curvature;
      balls[finger] = centre_of(part_, radius, contacts(box, instant, finger));
      depth += radius - balls[finger].radius;
    }
    return depth - (balls[0].centre - balls[1].centre).norm();
  }

  /// The same of a jaw and a disk: the disk reaches beyond the jaw's line by its radius and by how far its centre is
  /// behind that line. The jaw has no ends.
  double depth_under_jaw(const PerFinger<Interval>& box, std::size_t instant, std::size_t jaw) const {
    const double radius = 1 / reach_[1 - jaw].curvature;
    const Ball centre = centre_of(part_, radius, contacts(box, instant, 1 - jaw));
    return radius + least_depth(part_, contacts(box, instant, jaw), centre);
  }

  /// Where a finger that started in the box touches at an instant: not wrapped, widened by the length's error.
  Interval contacts(const PerFinger<Interval>& box, std::size_t instant, std::size_t finger) const {
    const double length = rolls_[instant].length[finger];
    const double error = instant > 0 ? length_error_ : 0;
    return {box[finger].lo + length - error, box[finger].hi + length + error};
  }

  /// The boxes of first contacts that a placement is looked at in.
  std::vector<PerFinger<Interval>> boxes_of(const Placement& placement) const {
    // Short against the radii, so that the balls of the fingers' centres stay small.
    double step = part_.perimeter();
    for (const Reach& reach : reach_) {
      if (reach.curvature > 0) step = std::min(step, kPiece / reach.curvature);
    }
    return pieces_of(placement, step);
  }

  const Part& part_;
  const PerFinger<Reach>& reach_;
  std::vector<Reading> rolls_;  // the first contacts first
  double length_error_;
  PerFinger<Interval> roll_;    // of each finger, from its first contact to the furthest on both sides
  PerFinger<double> last_;      // to the last reading searched with
  bool must_be_apart_ = false;  // at one height, and not two jaws, which without ends would always meet
};

}  // namespace

/// Corners within rounding of an end count as in the interval: angle_set has their whole set.
Interval tangents_over(const Part& part, const Interval& contacts) {
  Interval angles = angles_over(part.turning(), contacts);
  for (const double end : {contacts.lo, contacts.hi}) {
    const Interval there = angle_set(part, end).angles;
    angles = {std::min(angles.lo, there.lo), std::max(angles.hi, there.hi)};
  }
  return angles;
}

std::vector<PerFinger<Interval>> pieces_of(const Placement& placement, double step) {
  if (placement.kind != Kind::stretch || placement.family.size() < 2) return {placement.extent};
  std::vector<PerFinger<Interval>> boxes;
  double length = 0;
  for (std::size_t k = 1; k < placement.family.size(); ++k) length += family_step(placement, k);
  step = std::max(step, length / kMostPieces);
  for (std::size_t k = 1; k < placement.family.size(); ++k) {
    const int count = 1 + static_cast<int>(family_step(placement, k) / step);
    for (int i = 0; i < count; ++i) boxes.push_back(piece(placement, k, i, count));
  }
  return boxes;
}

bool can_roll(const Reach& reach, const Interval& starts, const Interval& roll) {
  if (reach.whole_loop) return true;
  const double rounding = kGivenRounding * reach.perimeter;
  // The first contacts for which all of s + roll is on this arc.
  const auto holds = [&](const Interval& arc) {
    return reach.boundary().intersects({arc.lo - roll.lo - rounding, arc.hi - roll.hi + rounding}, starts);
  };
  if (std::any_of(reach.arcs.begin(), reach.arcs.end(), holds)) return true;
  // No arc holds the roll, and it is a roll.
  if (roll.width() > 2 * rounding) return false;
  // A finger that does not roll may pivot where it can't leave the corner.
  return std::any_of(reach.pivots.begin(), reach.pivots.end(), [&](const PivotReach& pivot) {
    return !pivot.angles.empty() && holds({pivot.s, pivot.s});
  });
}

std::optional<Obstruction> obstruction_of(const Part& part, const Reach& reach, double s, const Interval& roll) {
  if (can_roll(reach, {s, s}, roll)) return std::nullopt;
  const std::optional<Interval> arc = reach.arc_at(s);
  if (!arc) {
    Obstruction here = at_pivot(part, reach, s);
    // The finger can stand at the first contact, but not go on from there.
    if (here.hit.depth <= reach.slack) here = beyond(part, reach, s, roll.hi > 0 ? s + roll.hi : s + roll.lo);
    return here;
  }
  // The arc that goes furthest the right way: at a corner two may end.
  if (s + roll.hi > arc->hi) return beyond(part, reach, arc->hi - kGivenRounding * reach.perimeter, s + roll.hi);
  return beyond(part, reach, arc->lo + kGivenRounding * reach.perimeter, s + roll.lo);
}

std::vector<Impossible> drop_unreachable(const Part& part, const PerFinger<Reach>& reach,
                                         const std::vector<Reading>& readings, std::vector<Placement>& placements,
                                         const std::vector<Reading>& more, double length_error, bool may_overlap) {
  const Sieve sieve(part, reach, readings, more, length_error, may_overlap);
  std::vector<Impossible> dropped;
  std::vector<Placement> kept;
  for (Placement& placement : placements) {
    if (auto impossible = sieve.look_at(placement)) {
      dropped.push_back(std::move(*impossible));
    } else {
      kept.push_back(std::move(placement));
    }
  }
  placements = std::move(kept);
  return dropped;
}

}  // namespace rollfix
