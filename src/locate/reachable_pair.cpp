#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "corner_sets.hpp"
#include "rollfix/locate/reachable.hpp"
#include "rollfix/part/period.hpp"

namespace rollfix {
namespace {

// A continuum of pairs is looked at in pieces whose fingers move by less than this share of the smaller radius, or by
// as little as this many pieces allow.
constexpr double kPiece = 0.1;
constexpr int kMostPieces = 400;

/// Where a finger's centre can be while its contact is in an interval: in a disk.
struct Ball {
  Vec2 centre;
  double radius = 0;
};

/// The tangent's angles anywhere in an interval of s: on spirals they are monotone.
Interval tangents(const Part& part, const Interval& contacts) {
  const TurningFunction& turning = part.turning();
  Interval angles = angle_set(part, contacts.lo).angles;
  const auto include = [&](const Interval& more) {
    angles = {std::min(angles.lo, more.lo), std::max(angles.hi, more.hi)};
  };
  include(angle_set(part, contacts.hi).angles);
  const double period = part.perimeter();
  for (const Spiral& spiral : turning.spirals()) {
    const double first = part.closed() ? spiral.lo + std::ceil((contacts.lo - spiral.lo) / period) * period : spiral.lo;
    for (double s = first; s <= contacts.hi && s >= contacts.lo; s += period) {
      include(angle_set(part, s).angles);
      if (!part.closed()) break;
    }
  }
  return angles;
}

Ball centre_of(const Part& part, double radius, const Interval& contacts) {
  const Interval angles = tangents(part, contacts);
  const double angle = angles.middle();
  const Vec2 normal(std::sin(angle), -std::cos(angle));
  return {part.point(contacts.middle()) + radius * normal, 0.5 * contacts.width() + 0.5 * radius * angles.width()};
}

class PairSieve {
 public:
  PairSieve(const Part& part, const std::array<Reach, 2>& reach, const std::vector<PairReading>& readings,
            const std::vector<PairReading>& more, double length_error)
      : part_(part), reach_(reach), rolls_{{0, 0, 0}} {
    rolls_.insert(rolls_.end(), readings.begin(), readings.end());
    rolls_.insert(rolls_.end(), more.begin(), more.end());
    for (const PairReading& reading : rolls_) {
      const std::array<double, 2> lengths{reading.length_a, reading.length_b};
      for (std::size_t f = 0; f < 2; ++f) {
        roll_[f] = {std::min(roll_[f].lo, lengths[f]), std::max(roll_[f].hi, lengths[f])};
      }
    }
    for (Interval& roll : roll_) {
      roll = {std::min(0.0, roll.lo + length_error), std::max(0.0, roll.hi - length_error)};
    }
    are_disks_ = reach[0].curvature > 0 && reach[1].curvature > 0;
  }

  /// Why a placement is impossible; nothing when it may be possible.
  std::optional<PairImpossible> look_at(const PairPlacement& placement) const {
    const std::vector<PairBox> boxes = boxes_of(placement);
    if (std::all_of(boxes.begin(), boxes.end(), [&](const PairBox& box) { return leaves_reach(box); })) {
      PairImpossible found{placement, PairImpossible::Cause::reach, 0, {}, 0, 0};
      for (std::size_t f = 0; f < 2; ++f) {
        const auto obstruction = obstruction_of(part_, reach_[f], placement.start[f], roll_[f]);
        if (!obstruction) continue;
        found.finger = f;
        found.obstruction = *obstruction;
        break;
      }
      return found;
    }
    if (!are_disks_) return std::nullopt;
    const auto is_out = [&](const PairBox& box) { return leaves_reach(box) || overlaps(box); };
    if (!std::all_of(boxes.begin(), boxes.end(), is_out)) return std::nullopt;
    PairImpossible found{placement, PairImpossible::Cause::overlap, 0, {}, 0, 0};
    const PairBox start{Interval{placement.start[0], placement.start[0]},
                        Interval{placement.start[1], placement.start[1]}};
    for (std::size_t k = 0; k < rolls_.size(); ++k) {
      const double depth = overlap(start, k);
      if (depth <= found.depth) continue;
      found.instant = k;
      found.depth = depth;
    }
    return found;
  }

 private:
  bool leaves_reach(const PairBox& box) const {
    return !can_roll(reach_[0], box[0], roll_[0]) || !can_roll(reach_[1], box[1], roll_[1]);
  }

  bool overlaps(const PairBox& box) const {
    const double slack = std::max(reach_[0].slack, reach_[1].slack);
    for (std::size_t k = 0; k < rolls_.size(); ++k) {
      if (overlap(box, k) > slack) return true;
    }
    return false;
  }

  /// By how much the fingers overlap at an instant, at least, from wherever in the box they started.
  double overlap(const PairBox& box, std::size_t instant) const {
    const double radius_a = 1 / reach_[0].curvature;
    const double radius_b = 1 / reach_[1].curvature;
    const PairReading& roll = rolls_[instant];
    const Ball a = centre_of(part_, radius_a, {box[0].lo + roll.length_a, box[0].hi + roll.length_a});
    const Ball b = centre_of(part_, radius_b, {box[1].lo + roll.length_b, box[1].hi + roll.length_b});
    return radius_a + radius_b - (a.centre - b.centre).norm() - a.radius - b.radius;
  }

  /// What a placement consists of: its extent, or of a continuum small boxes along its line.
  std::vector<PairBox> boxes_of(const PairPlacement& placement) const {
    if (placement.kind != Kind::stretch || placement.family.size() < 2) return {placement.extent};
    std::vector<PairBox> boxes;
    double step = part_.perimeter();
    for (const Reach& reach : reach_) {
      if (reach.curvature > 0) step = std::min(step, kPiece / reach.curvature);
    }
    double length = 0;
    for (std::size_t k = 1; k < placement.family.size(); ++k) length += distance(placement, k);
    step = std::max(step, length / kMostPieces);
    for (std::size_t k = 1; k < placement.family.size(); ++k) {
      const int count = 1 + static_cast<int>(distance(placement, k) / step);
      for (int i = 0; i < count; ++i) boxes.push_back(piece(placement, k, i, count));
    }
    return boxes;
  }

  static double distance(const PairPlacement& placement, std::size_t k) {
    const PairPoint& from = placement.family[k - 1];
    const PairPoint& to = placement.family[k];
    return std::max(std::abs(to[0] - from[0]), std::abs(to[1] - from[1]));
  }

  static PairBox piece(const PairPlacement& placement, std::size_t k, int i, int count) {
    PairBox box;
    for (std::size_t f = 0; f < 2; ++f) {
      const double from = placement.family[k - 1][f];
      const double step = (placement.family[k][f] - from) / count;
      const double one = from + i * step;
      const double two = one + step;
      box[f] = {std::min(one, two) - placement.family_error, std::max(one, two) + placement.family_error};
    }
    return box;
  }

  const Part& part_;
  const std::array<Reach, 2>& reach_;
  std::vector<PairReading> rolls_;  // the first contacts first
  std::array<Interval, 2> roll_{};
  bool are_disks_ = false;
};

}  // namespace

std::vector<PairImpossible> drop_unreachable(const Part& part, const std::array<Reach, 2>& reach,
                                             const std::vector<PairReading>& readings, PairSearch& search,
                                             const std::vector<PairReading>& more, double length_error) {
  const PairSieve sieve(part, reach, readings, more, length_error);
  std::vector<PairImpossible> dropped;
  std::vector<PairPlacement> kept;
  for (PairPlacement& placement : search.placements) {
    if (auto impossible = sieve.look_at(placement)) {
      dropped.push_back(std::move(*impossible));
    } else {
      kept.push_back(std::move(placement));
    }
  }
  search.placements = std::move(kept);
  return dropped;
}

}  // namespace rollfix
