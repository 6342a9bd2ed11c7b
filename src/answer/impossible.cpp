#include "steps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "finger/convex_body.hpp"
#include "locate/searches.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/rolling.hpp"
#include "work/pulse.hpp"

// What fingers can't do: reach a place, or overlap each other.
// Notation, all of it as the part sees it:
//   p, Theta     a contact on the part, and the tangent there
//   N, c(u)      the finger's own normal and its rim where it touches, in its frame
//   beta         how its frame is turned: Theta + pi / 2 - N; its origin is p - R(beta) c(u)
// Follows docs/rolling.md, "Fingers of any convex shape".
// Idea: two bodies any of whose points is off by no more than `moved` are in one another by no less than what their
// middle poses are, less both. So a box of first contacts goes only where no pair in it keeps the fingers apart.
namespace rollfix::answer {
namespace {

// Of the part's and the fingers' size: fingers that touch are apart.
constexpr double kTouchingRounding = 1e-9;
// A continuum of pairs is looked at in pieces of this share of the smaller finger's size.
constexpr double kBodyPiece = 0.05;
// A million normal numbers are within so many standard deviations.
constexpr double kFarthestRow = 5;
// A disk with an uncertain radius is not taken to be smaller than this share of what was said.
constexpr double kSmallestDisk = 0.01;

/// No two points of a finger's body are farther apart; of a jaw, which has no ends, 0.
double extent_of(const Finger& finger) {
  if (finger.is_disk()) return 2 * finger.length_per_u();
  if (finger.is_jaw()) return 0;
  return finger.outline()->closed() ? finger.outline()->perimeter() / 2 : finger.outline()->perimeter();
}

/// A finger at one instant when its contact is somewhere on an arc.
/// `half_turn` and `moved` bound the body's motion for all contacts on the arc and all u within its error.
struct Lying {
  Pose pose;             // of its frame
  Vec2 contact;          // the middle of the arc
  double half_turn = 0;  // its orientation is off by no more than this, radians
  double moved = 0;      // any of its points by no more than this; of a jaw: the contact
};

/// `u`: where on the finger the contact is, off by `error` at most. Theta on the arc and N at u are intervals; the pose
/// is that of their middles.
Lying lying(const Part& part, const Finger& finger, const Interval& arc, double u, double error) {
  // beta + N = Theta + pi / 2: the finger's normal points into the part.
  const Interval tangents = tangents_over(part, arc);
  const double inward = tangents.middle() + 0.5 * std::numbers::pi;
  const Vec2 contact = part.point(arc.middle());
  if (finger.is_disk()) {  // the same however it is turned
    const double radius = finger.length_per_u();
    const Vec2 centre = contact - radius * Vec2(std::cos(inward), std::sin(inward));
    return {{centre.x(), centre.y(), 0}, contact, 0, 0.5 * (arc.width() + radius * tangents.width())};
  }
  const Interval ends = finger.ends();
  const double lo = std::clamp(u - error, ends.lo, ends.hi);
  const double hi = std::clamp(u + error, ends.lo, ends.hi);
  const double rounding = kTouchingRounding * extent_of(finger);
  const Interval normals{finger.normals(lo, rounding).lo, finger.normals(hi, rounding).hi};
  // The origin is the contact less the turned place on the finger.
  const Pose turned{0, 0, inward - normals.middle()};
  const Vec2 origin = contact - turned.turned(finger.point(0.5 * (lo + hi)));
  const double half_turn = 0.5 * (tangents.width() + normals.width());
  // A point moves with the contact along the arc and on the finger, and by the turn times its distance from the
  // contact.
  const double moved = 0.5 * (arc.width() + hi - lo) + half_turn * extent_of(finger);
  // A jaw has no ends: only its contact's motion is bounded, `least_depth` takes its turn.
  return {{origin.x(), origin.y(), turned.heading}, contact, half_turn, finger.is_jaw() ? 0.5 * arc.width() : moved};
}

/// A lower bound on how far a body is beyond a jaw's line, over all poses of both. The farther the body's point is
/// along the line, the more the jaw's turn moves the line there.
double least_depth(const Lying& jaw, const ConvexBody& body, double body_moved) {
  const double up = jaw.pose.heading + 0.5 * std::numbers::pi;
  const Vec2 arm = body.farthest(up) - jaw.contact;
  const double moved = jaw.moved + body_moved;
  return arm.dot(Vec2(std::cos(up), std::sin(up))) - moved - jaw.half_turn * (arm.norm() + moved);
}

/// Two fingers in all rows of a log. `length_error`: how far each rolled length and u may be off.
class Rows {
 public:
  /// `slack_`: what rounding of contacts, and the uncertain radius of a disk, may make of a depth.
  Rows(const Problem& problem, const Observation& observed, double length_error)
      : part_(problem.part),
        contacts_(*observed.contacts),
        rolls_(observed.rolls),
        error_(length_error),
        fingers_(finger_of(problem.fingers, 0), finger_of(problem.fingers, 1)) {
    const double radius = problem.noise ? kFarthestRow * problem.noise->radius : 0;
    for (const Finger* finger : fingers_) {
      slack_ += kTouchingRounding * (part_.perimeter() + extent_of(*finger)) + (finger->is_disk() ? radius : 0);
    }
  }

  /// Whether both are in one another in some row, from wherever in the box they started.
  /// One row is enough: fingers that are in each other at one instant never were there.
  bool overlap(const PerFinger<Interval>& box) const {
    for (std::size_t row = 0; row < rolls_.size(); ++row) {
      if (depth(box, row, slack_) > slack_) return true;
    }
    return false;
  }

  /// Where they are deepest in one another from these first contacts, and by how much.
  std::pair<std::size_t, double> deepest(const PerFinger<double>& start) const {
    const PerFinger<Interval> box(Interval{start[0], start[0]}, Interval{start[1], start[1]});
    std::pair<std::size_t, double> found{0, 0};
    for (std::size_t row = 0; row < rolls_.size(); ++row) {
      const double one = depth(box, row, found.second);
      if (one > found.second) found = {row, one};
    }
    return found;
  }

  /// Length of the pieces in which a continuum is looked at.
  double piece() const {
    double least = part_.perimeter();
    for (const Finger* finger : fingers_) {
      if (!finger->is_jaw()) least = std::min(least, extent_of(*finger));
    }
    return kBodyPiece * least;
  }

 private:
  /// At least, and where that is no more than `enough` no more than it.
  double depth(const PerFinger<Interval>& box, std::size_t row, double enough) const {
    const Lying a = at(box, row, 0);
    const Lying b = at(box, row, 1);
    const ConvexBody of_a(*fingers_[0], a.pose);
    const ConvexBody of_b(*fingers_[1], b.pose);
    // Two jaws are not asked about.
    if (fingers_[0]->is_jaw()) return least_depth(a, of_b, b.moved);
    if (fingers_[1]->is_jaw()) return least_depth(b, of_a, a.moved);
    const double moved = a.moved + b.moved;
    const Vec2 way = b.contact - a.contact;
    // Any direction gives an upper bound on the depth: if that is small enough the exact depth is not needed.
    const double straight = depth_along(of_a, of_b, std::atan2(way.y(), way.x()));
    if (straight - moved <= enough) return straight - moved;  // as fingers that press against each other mostly are
    return depth_of_overlap(of_a, of_b, enough + moved) - moved;
  }

  /// In row 0 the contact is the first contact itself, with no length to be off.
  Lying at(const PerFinger<Interval>& box, std::size_t row, std::size_t finger) const {
    const double length = rolls_[row].length[finger];
    const double error = row > 0 ? error_ : 0;
    const Interval arc{box[finger].lo + length - error, box[finger].hi + length + error};
    return lying(part_, *fingers_[finger], arc, contacts_[finger][row].u, error_);
  }

  const Part& part_;
  const PerFinger<std::vector<Contact>>& contacts_;
  const std::vector<Reading>& rolls_;
  double error_;
  double slack_ = 0;
  PerFinger<const Finger*> fingers_;
};

/// In one another in some row, from wherever in its extent a placement starts.
/// `placements` keeps the others. If all fingers are disks or jaws, `drop_unreachable` does this instead.
std::vector<Impossible> drop_overlapping(const Problem& problem, const Observation& observed, double length_error,
                                         std::vector<Placement>& placements) {
  std::vector<Impossible> dropped;
  if (problem.may_overlap || !observed.contacts || observed.contacts->size() != 2) return dropped;
  if (finger_of(problem.fingers, 0)->is_jaw() && finger_of(problem.fingers, 1)->is_jaw()) return dropped;
  const Rows rows(problem, observed, length_error);
  std::vector<Placement> kept;
  for (Placement& placement : placements) {
    // A placement goes only if every piece of it overlaps.
    const std::vector<PerFinger<Interval>> boxes = pieces_of(placement, rows.piece());
    if (!std::all_of(boxes.begin(), boxes.end(), [&](const auto& box) { return rows.overlap(box); })) {
      kept.push_back(std::move(placement));
      continue;
    }
    const auto [row, depth] = rows.deepest(placement.start);
    dropped.push_back({std::move(placement), Impossible::Reason::overlap, 0, {}, row, depth});
  }
  placements = std::move(kept);
  return dropped;
}

/// The smallest disk that a finger may be: it lies within any larger one that touches at the same contact, so that all
/// of them hit what it hits.
Finger smallest(const Finger& finger, double radius_sd) {
  if (!finger.is_disk()) return finger;
  const double radius = finger.disk()->radius;
  return disk(std::max(radius - kFarthestRow * radius_sd, kSmallestDisk * radius));
}

/// Where each of `count` fingers can touch; computed once if both are alike.
PerFinger<Reach> reaches_of(const Problem& problem, std::size_t count) {
  const double radius_sd = problem.noise ? problem.noise->radius : 0;
  const Finger a = smallest(problem.fingers.front(), radius_sd), b = smallest(problem.fingers.back(), radius_sd);
  const Reach reach = reach_of(problem.part, a);
  if (count == 1) return reach;
  return {reach, a.curvature(0) == b.curvature(0) ? reach : reach_of(problem.part, b)};
}

/// How far a rolled length may be off: by its digits, and by its noise.
/// In the part's unit: the digits, and with noise five standard deviations of the row that is off most.
double length_error(const Problem& problem, const Observation& observed) {
  const double digits = observed.length_error();
  if (!problem.noise) return digits;
  double most = 0;
  for (const RowErrors& row :
       errors_of(problem, noise_on(problem.part, *problem.noise), observed.rolls, problem.part.perimeter())) {
    most = std::max(most, row.length);
  }
  return digits + kFarthestRow * std::sqrt(most);
}

}  // namespace

/// Disks and jaws are tested by reach and overlap along their way; fingers with an outline by overlap alone.
void drop_impossible(const Problem& problem, const Observation& observed, Answer& answer) {
  const Doing doing("looking where the fingers can reach");
  if (answer.fingers.empty()) return;
  answer.has_reach = std::all_of(answer.fingers.begin(), answer.fingers.end(), has_reach);
  const double error = length_error(problem, observed);
  answer.impossible = answer.has_reach
                          ? drop_unreachable(answer.part, reaches_of(problem, answer.finger_count()), answer.readings,
                                             answer.placements, observed.rolls, error, problem.may_overlap)
                          : drop_overlapping(problem, observed, error, answer.placements);
  for (const Impossible& item : answer.impossible) {
    ++(item.reason == Impossible::Reason::reach ? answer.dropped.reach : answer.dropped.overlap);
  }
}

}  // namespace rollfix::answer
