#include <algorithm>
#include <cmath>
#include <utility>

#include "pieces.hpp"
#include "pivots.hpp"
#include "rollfix/locate.hpp"

namespace rollfix {
namespace {

// A continuum of pairs is looked at in pieces whose fingers move by less than this share of the smaller radius.
constexpr double kPiece = 0.1;

/// Where a finger's centre can be while its contact is in an interval: in a disk.
struct Ball {
  Vec2 centre;
  double radius = 0;
};

Ball centre_of(const Part& part, double radius, const Interval& contacts) {
  const Interval angles = tangents_over(part, contacts);
  const double angle = angles.middle();
  const Vec2 normal(std::sin(angle), -std::cos(angle));
  return {part.point(contacts.middle()) + radius * normal, 0.5 * contacts.width() + 0.5 * radius * angles.width()};
}

/// How far a place in a ball is behind the line of a jaw that touches in an interval of s, at least: along the part's
/// outward normal there.
double least_depth(const Part& part, const Interval& contacts, const Ball& ball) {
  const Interval angles = tangents_over(part, contacts);
  const Vec2 normal(std::sin(angles.middle()), -std::cos(angles.middle()));
  const Vec2 from_contact = ball.centre - part.point(contacts.middle());
  const double moved = 0.5 * contacts.width() + ball.radius;
  return from_contact.dot(normal) - moved - 0.5 * angles.width() * (from_contact.norm() + moved);
}

/// Takes out what the fingers can't do.
class Sieve {
 public:
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
      roll = {std::min(0.0, roll.lo + length_error), std::max(0.0, roll.hi - length_error)};
      if (!readings.empty()) last_[finger] = readings.back().length[finger];
    }
    must_be_apart_ = !may_overlap && reach.size() == 2 && (reach[0].curvature > 0 || reach[1].curvature > 0);
  }

  /// Why a placement is impossible; nothing when it may be possible.
  std::optional<Impossible> look_at(const Placement& placement) const {
    const std::vector<PerFinger<Interval>> boxes = boxes_of(placement);
    const auto is_beyond = [&](const PerFinger<Interval>& box) { return leaves_reach(box); };
    if (!can_pivot(placement) || std::all_of(boxes.begin(), boxes.end(), is_beyond)) return beyond_reach(placement);
    if (!must_be_apart_) return std::nullopt;
    const auto is_out = [&](const PerFinger<Interval>& box) { return leaves_reach(box) || overlaps(box); };
    if (!std::all_of(boxes.begin(), boxes.end(), is_out)) return std::nullopt;
    Impossible found{placement, Impossible::Reason::overlap, 0, {}, 0, 0};
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
  bool can_pivot(const Placement& placement) const {
    for (std::size_t finger = 0; finger < reach_.size(); ++finger) {
      if (!rollfix::can_pivot(part_, reach_[finger], placement, finger, roll_[finger], last_[finger])) return false;
    }
    return true;
  }

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
      const double radius = 1 / reach_[finger].curvature;
      balls[finger] = centre_of(part_, radius, contacts(box, instant, finger));
      depth += radius - balls[finger].radius;
    }
    return depth - (balls[0].centre - balls[1].centre).norm();
  }

  /// The same of a jaw, which has no ends, and a disk.
  double depth_under_jaw(const PerFinger<Interval>& box, std::size_t instant, std::size_t jaw) const {
    const double radius = 1 / reach_[1 - jaw].curvature;
    const Ball centre = centre_of(part_, radius, contacts(box, instant, 1 - jaw));
    return radius + least_depth(part_, contacts(box, instant, jaw), centre);
  }

  /// Where a finger touches at an instant that has started in the box.
  Interval contacts(const PerFinger<Interval>& box, std::size_t instant, std::size_t finger) const {
    const double length = rolls_[instant].length[finger];
    const double error = instant > 0 ? length_error_ : 0;
    return {box[finger].lo + length - error, box[finger].hi + length + error};
  }

  /// What a placement consists of.
  std::vector<PerFinger<Interval>> boxes_of(const Placement& placement) const {
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
