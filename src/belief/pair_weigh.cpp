#include "rollfix/belief/pair_weigh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "belief/policy.hpp"
#include "locate/pair/pair_residual.hpp"
#include "part/angle.hpp"
#include "rollfix/part/period.hpp"

namespace rollfix {

namespace {

using belief::distance_to;
using belief::kNear;

/// How far a pair is outside a placement's extent, in standard deviations of a mode.
double off_placement(const PairPlacement& placement, const PairPoint& at, const PairMode& mode, const Part& part) {
  double most = 0;
  for (const std::size_t finger : {0U, 1U}) {
    if (placement.whole_loop[finger]) continue;
    const double off = distance_to(placement.extent[finger], at[finger], part);
    if (off > 0) most = std::max(most, off / std::max(mode.sd[finger], 1e-300));
  }
  return most;
}

bool lies_in(const PairBox& box, const PairPoint& at, const Part& part) {
  return distance_to(box[0], at[0], part) == 0 && distance_to(box[1], at[1], part) == 0;
}

/// What a mode is by itself: nothing of the search holds it.
PairPlacement placement_of(const PairMode& mode) {
  PairPlacement placement;
  placement.kind = Kind::touching;
  placement.extent = mode.interval;
  placement.error = std::numeric_limits<double>::infinity();
  return placement;
}

/// What the search knows of a mode's places: the part of a placement that lies in its region.
PairPlacement within(const PairPlacement& found, const PairMode& mode, const Part& part) {
  PairPlacement placement = found;
  placement.roots.clear();
  for (const PairPoint& root : found.roots) {
    if (lies_in(mode.region, root, part)) placement.roots.push_back(root);
  }
  for (const std::size_t finger : {0U, 1U}) {
    const bool is_wider = found.whole_loop[finger] || found.extent[finger].width() > mode.region[finger].width();
    if (!is_wider || found.kind == Kind::corner) continue;
    placement.extent[finger] = mode.region[finger];
    placement.whole_loop[finger] = part.closed() && mode.region[finger].width() >= part.perimeter();
  }
  return placement;
}

/// u + psi = heading + tangent + pi/2 at each finger's contact, and both contacts are at the same places in both
/// frames: the middle of what the two say.
Pose pose_with(const Part& part, const PairPoint& at, const std::array<double, 2>& tangent,
               const std::array<FeltContact, 2>& felt) {
  std::array<double, 2> heading{};
  for (const std::size_t finger : {0U, 1U}) {
    heading[finger] = felt[finger].facing - 0.5 * std::numbers::pi - tangent[finger];
  }
  Pose pose{0, 0, heading[0] + 0.5 * nearest_angle(heading[1] - heading[0])};
  for (const std::size_t finger : {0U, 1U}) {
    const Vec2 origin = felt[finger].where - pose.turned(part.point(at[finger]));
    pose.x += 0.5 * origin.x();
    pose.y += 0.5 * origin.y();
  }
  return pose;
}

/// A contact that is felt this far along the finger from where it is, counter-clockwise, with the finger's orientation
/// off by this angle.
FeltContact moved(const FeltContact& contact, double along, double angle) {
  FeltContact off = contact;
  const double turn = along * contact.finger_curvature + angle;
  off.facing += turn;
  const Vec2 tangent(-std::sin(contact.facing), std::cos(contact.facing));
  const double radius = contact.finger_curvature > 0 ? 1 / contact.finger_curvature : 0;
  off.where += (along + radius * angle) * tangent;
  return off;
}

}  // namespace

WeighedPairs weigh(const Part& part, const std::vector<PairReading>& readings, const std::optional<double>& facing,
                   const PairSearch& found, PairBelief& belief) {
  WeighedPairs weighed;
  std::vector<bool> has_mode(found.placements.size(), false);
  for (const PairMode& mode : belief.modes()) {
    std::size_t nearest = found.placements.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < found.placements.size(); ++k) {
      const double off = off_placement(found.placements[k], mode.start, mode, part);
      if (off < least) {
        least = off;
        nearest = k;
      }
      // A wide mode can hold several.
      if (off <= kNear || lies_in(mode.interval, found.placements[k].start, part)) has_mode[k] = true;
    }
    const bool is_found = nearest < found.placements.size() && least <= kNear;
    PairPlacement placement = is_found ? within(found.placements[nearest], mode, part) : placement_of(mode);
    placement.start = mode.start;
    placement.end = mode.end;
    for (const std::size_t finger : {0U, 1U}) {
      placement.point[finger] = part.point(mode.start[finger]);
      placement.tangent[finger] = nearest_angle(mode.tangent[finger]);
    }
    placement.residual = pair_residual(part, readings, facing, mode.start);
    weighed.placements.push_back(std::move(placement));
    weighed.modes.push_back(mode);
  }
  for (std::size_t k = 0; k < found.placements.size(); ++k) {
    if (!has_mode[k]) weighed.improbable.push_back(found.placements[k]);
  }
  return weighed;
}

PoseSpread pose_spread(const Part& part, std::size_t mode, const std::vector<PairMass>& mass,
                       const std::array<FeltContact, 2>& felt, const Noise& noise) {
  PoseSpread spread;
  const PairMass* best = nullptr;
  for (const PairMass& piece : mass) {
    if (piece.mode == mode && (best == nullptr || piece.share > best->share)) best = &piece;
  }
  if (best == nullptr) return spread;
  // Where the contacts were, as far as all the samples tell, with the orientations off by these angles.
  const auto pose_of = [&](const PairMass& piece, const std::array<double, 2>& slid,
                           const std::array<double, 2>& angle) {
    return pose_with(part, piece.start, piece.tangent,
                     {moved(felt[0], slid[0], angle[0]), moved(felt[1], slid[1], angle[1])});
  };
  const Pose reference = pose_of(*best, best->slid, {});
  const auto off_reference = [&](const Pose& pose) {
    return Eigen::Vector3d(pose.x - reference.x, pose.y - reference.y, nearest_angle(pose.heading - reference.heading));
  };
  // A small change each, for the derivatives.
  const std::array<double, 2> slid_step{1e-6 * part.perimeter(), 1e-6};
  Eigen::Matrix<double, 3, 2> by_slid;
  Eigen::Matrix<double, 3, 2> by_angle;
  for (const std::size_t finger : {0U, 1U}) {
    std::array<double, 2> slid = best->slid;
    slid[finger] += slid_step[0];
    std::array<double, 2> angle{};
    angle[finger] = slid_step[1];
    by_slid.col(static_cast<Eigen::Index>(finger)) = off_reference(pose_of(*best, slid, {})) / slid_step[0];
    by_angle.col(static_cast<Eigen::Index>(finger)) = off_reference(pose_of(*best, best->slid, angle)) / slid_step[1];
  }
  double total = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const PairMass& piece : mass) {
    if (piece.mode != mode) continue;
    const Eigen::Vector3d off = off_reference(pose_of(piece, piece.slid, {}));
    total += piece.share;
    sum += piece.share * off;
    squares += piece.share * (off * off.transpose() + by_slid * piece.slid_covariance * by_slid.transpose());
  }
  const Eigen::Vector3d mean = sum / total;
  spread.mean = {reference.x + mean.x(), reference.y + mean.y(), nearest_angle(reference.heading) + mean.z()};
  spread.covariance =
      squares / total - mean * mean.transpose() + noise.angle * noise.angle * by_angle * by_angle.transpose();
  return spread;
}

}  // namespace rollfix
