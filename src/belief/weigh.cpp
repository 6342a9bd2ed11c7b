#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "belief/posterior.hpp"
#include "locate/corner_sets.hpp"
#include "outline/turn.hpp"
#include "rollfix/belief.hpp"

namespace rollfix {

namespace {

// A placement of the search further than this many standard deviations from a mode is another one.
constexpr double kNear = 3;
// 95 % of a normal distribution are within so many standard deviations.
constexpr double kTwoSides = 1.96;
// A place that is nearer to a corner than this share of the perimeter is at it.
constexpr double kAtCorner = 1e-9;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One finger: curvatures at both ends of the roll decide how the start moves with the reading.
Sensitivity sensitivity_at(const Part& part, const std::vector<Reading>& readings, double s) {
  Sensitivity sensitivity;
  for (const Reading& reading : readings) {
    const double here = part.turning().curvature(s);
    const double there = part.turning().curvature(s + reading.length[0]);
    const bool is_simple = there != here;
    sensitivity.per_turn[0].push_back(is_simple ? 1 / (there - here) : kNaN);
    sensitivity.per_length[0].push_back(is_simple ? -there / (there - here) : kNaN);
  }
  return sensitivity;
}

/// How far a mode's start is outside a placement's extent, in the mode's standard deviations.
double off_placement(const Placement& placement, const Mode& mode, const Part& part) {
  double most = 0;
  for (std::size_t finger = 0; finger < mode.start.size(); ++finger) {
    if (placement.whole_loop[finger]) continue;
    const double off = part.boundary().distance(placement.extent[finger], mode.start[finger]);
    if (off > 0) most = std::max(most, off / std::max(mode.sd[finger], 1e-300));
  }
  return most;
}

bool lies_in(const PerFinger<Interval>& box, const PerFinger<double>& at, const Part& part) {
  for (std::size_t finger = 0; finger < at.size(); ++finger) {
    if (!part.boundary().contains(box[finger], at[finger])) return false;
  }
  return true;
}

/// What a mode is by itself: nothing of the search holds it.
Placement placement_of(const Mode& mode) {
  Placement placement;
  placement.kind = Kind::touching;
  placement.extent = mode.interval;
  placement.whole_loop = PerFinger<bool>::of(mode.start.size());
  placement.point = PerFinger<Vec2>::of(mode.start.size(), Vec2::Zero());
  placement.error = kInfinity;
  return placement;
}

/// What the search knows of a mode's place: the part of a placement that lies in the mode's region.
Placement within(const Placement& found, const Mode& mode, const Part& part) {
  Placement placement = found;
  placement.roots.clear();
  for (const PerFinger<double>& root : found.roots) {
    if (lies_in(mode.region, root, part)) placement.roots.push_back(root);
  }
  if (found.kind == Kind::corner) return placement;
  for (std::size_t finger = 0; finger < mode.start.size(); ++finger) {
    const Interval& region = mode.region[finger];
    const Interval& extent = found.extent[finger];
    const bool is_all = part.boundary().contains(region, extent.lo) && extent.width() <= region.width();
    if (is_all) continue;
    if (found.whole_loop[finger] || extent.width() > region.width()) placement.extent[finger] = region;
    placement.whole_loop[finger] = false;
  }
  return placement;
}

/// Whether a finger can be at a convex corner at the first contact or where one of the readings ends, as far as 95 %
/// go.
bool is_at_a_corner(const Part& part, const std::vector<Reading>& readings, const Mode& mode) {
  const auto holds_one = [&](const Interval& s) {
    return std::any_of(part.corners().begin(), part.corners().end(), [&](const Corner& corner) {
      return !corner.is_concave() && part.boundary().distance(s, corner.s) <= kAtCorner * part.perimeter();
    });
  };
  for (std::size_t finger = 0; finger < mode.start.size(); ++finger) {
    const Interval& first = mode.interval[finger];
    if (holds_one(first)) return true;
    const double beyond = kTwoSides * mode.end_sd[finger];
    for (const Reading& reading : readings) {
      const double length = reading.length[finger];
      if (holds_one({first.lo + length - beyond, first.hi + length + beyond})) return true;
    }
  }
  return false;
}

/// With what all samples together say of it.
Placement with_mode(Placement placement, const Mode& mode, const Part& part) {
  placement.start = mode.start;
  placement.end = mode.end;
  placement.tangent = mode.tangent;
  for (std::size_t finger = 0; finger < mode.start.size(); ++finger) {
    placement.point[finger] = part.point(mode.start[finger]);
    placement.tangent[finger] = nearest_angle(mode.tangent[finger]);
  }
  placement.probability = mode.probability;
  placement.mean = mode.mean;
  placement.sd = mode.sd;
  placement.covariance = mode.covariance;
  placement.interval = mode.interval;
  placement.end_mean = mode.end_mean;
  placement.end_sd = mode.end_sd;
  return placement;
}

}  // namespace

Weighed weigh(const Part& part, const std::vector<Reading>& readings, const std::optional<double>& facing,
              const std::vector<Placement>& found, Belief& belief) {
  const ContactEquations question{part, readings, facing};
  Weighed weighed;
  std::vector<bool> has_mode(found.size(), false);
  for (const Mode& mode : belief.modes()) {
    const Placement* nearest = nullptr;
    double least = kInfinity;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const double off = off_placement(found[k], mode, part);
      if (off < least) {
        least = off;
        nearest = &found[k];
      }
      // A wide mode can hold several.
      if (off <= kNear || lies_in(mode.interval, found[k].start, part)) has_mode[k] = true;
    }
    // What the tolerance reaches with a pivot, all samples together may have elsewhere.
    const bool is_elsewhere =
        nearest != nullptr && nearest->kind == Kind::corner && !is_at_a_corner(part, readings, mode);
    const bool is_found = nearest != nullptr && least <= kNear && !is_elsewhere;
    Placement placement = with_mode(is_found ? within(*nearest, mode, part) : placement_of(mode), mode, part);
    // Within a wide tolerance one placement spans several corners, and its pivot is of one of them.
    if (placement.pivot) placement.pivot = pivots_at(question, mode.start, placement.end);
    const bool is_of_one = mode.start.size() == 1;
    if (!is_of_one || placement.kind != Kind::corner) placement.residual = residual_at(question, mode.start);
    if (is_of_one && placement.kind != Kind::corner) {
      placement.sensitivity = sensitivity_at(part, readings, mode.start[0]);
    }
    weighed.placements.push_back(std::move(placement));
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!has_mode[k]) weighed.improbable.push_back(found[k]);
  }
  return weighed;
}

}  // namespace rollfix

namespace rollfix::belief {

namespace {

// Steps that derivatives are taken by: a share of the perimeter, and radians.
constexpr double kSlidStep = 1e-6;
constexpr double kAngleStep = 1e-6;

/// u + psi = heading + tangent + pi/2 at each finger's contact, and the contacts are at the same places in both frames:
/// of two fingers the middle of what they say.
/// `chord`: of two fingers, how much the direction from one contact to the other counts for the heading, the normals
/// counting for the rest.
Pose pose_with(const Part& part, const Piece& piece, const PerFinger<FeltContact>& felt, double chord) {
  const auto heading_by = [&](std::size_t finger) {
    return felt[finger].facing - 0.5 * std::numbers::pi - piece.tangent[finger];
  };
  Pose pose{0, 0, heading_by(0)};
  if (felt.size() == 2) pose.heading += 0.5 * nearest_angle(heading_by(1) - heading_by(0));
  if (chord > 0) {
    const Vec2 on_part = part.point(piece.s[1]) - part.point(piece.s[0]);
    pose.heading += chord * nearest_angle(angle_between(on_part, felt[1].where - felt[0].where) - pose.heading);
  }
  const double share = 1 / static_cast<double>(felt.size());
  for (std::size_t finger = 0; finger < felt.size(); ++finger) {
    const Vec2 origin = felt[finger].where - pose.turned(part.point(piece.s[finger]));
    pose.x += share * origin.x();
    pose.y += share * origin.y();
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

/// Where the contacts were, as far as all the samples tell.
PerFinger<FeltContact> told(const PerFinger<FeltContact>& felt, const Piece& piece) {
  PerFinger<FeltContact> contacts = felt;
  if (felt.size() == 1) return contacts;
  for (std::size_t finger = 0; finger < felt.size(); ++finger) {
    contacts[finger] = moved(felt[finger], piece.slid[finger], 0);
  }
  return contacts;
}

Eigen::Vector3d off(const Pose& pose, const Pose& reference) {
  return {pose.x - reference.x, pose.y - reference.y, nearest_angle(pose.heading - reference.heading)};
}

/// What the sensors' own errors add at one finger's first contact. The contact's moves it along the tangent and turns
/// the normal, the orientation's turns it about the contact.
Eigen::Matrix3d sensors_of_one(const FeltContact& felt, const Pose& mean, const Noise& noise) {
  const Vec2 arm = felt.where - Vec2(mean.x, mean.y);  // from the contact to the origin, turned back
  const Eigen::Vector3d by_turn(arm.y(), -arm.x(), 1);
  const Eigen::Vector3d along(-std::sin(felt.facing), std::cos(felt.facing), 0);  // counter-clockwise
  const Eigen::Vector3d by_contact = along + felt.finger_curvature * by_turn;
  Eigen::Vector3d by_angle = by_turn;
  if (felt.finger_curvature > 0) by_angle += along / felt.finger_curvature;
  return noise.contact * noise.contact * by_contact * by_contact.transpose() +
         noise.angle * noise.angle * by_angle * by_angle.transpose();
}

/// Of poses with a spread of their own.
PoseSpread spread_over(const std::vector<Piece>& pieces) {
  const Pose reference = pieces.front().pose->mean;
  double total = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Piece& piece : pieces) {
    const Eigen::Vector3d by = off(piece.pose->mean, reference);
    total += piece.share;
    sum += piece.share * by;
    squares += piece.share * (by * by.transpose() + piece.pose->covariance);
  }
  const Eigen::Vector3d mean = sum / total;
  return {{reference.x + mean.x(), reference.y + mean.y(), nearest_angle(reference.heading + mean.z())},
          squares / total - mean * mean.transpose()};
}

/// How the pose changes with what each of two fingers slid at first, and with the error of its orientation.
struct PoseSlopes {
  Eigen::Matrix<double, 3, 2> by_slid = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix<double, 3, 2> by_angle = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix<double, 3, 4> by_position = Eigen::Matrix<double, 3, 4>::Zero();  // of the centres
};

/// As the centres are known, the direction from one contact to the other tells the heading, and so do the normals: each
/// counts as much as it is sure.
double chord_share(const PerFinger<FeltContact>& felt, const Noise& noise) {
  if (felt.size() == 1 || !(noise.position > 0)) return 0;
  const double by_normals = 0.5 * noise.angle * noise.angle;
  double across = 2 * noise.position * noise.position;
  for (const FeltContact& contact : felt) {
    const double radius = contact.finger_curvature > 0 ? 1 / contact.finger_curvature : 0;
    across += square(radius * noise.angle);
  }
  const double by_chord = across / std::max((felt[1].where - felt[0].where).squaredNorm(), 1e-300);
  return by_normals / std::max(by_normals + by_chord, 1e-300);
}

PoseSlopes slopes_of_two(const Part& part, const Piece& at, const PerFinger<FeltContact>& felt, double chord) {
  const double step = kSlidStep * part.perimeter();
  const Pose reference = pose_with(part, at, told(felt, at), chord);
  PoseSlopes slopes;
  for (std::size_t finger = 0; finger < felt.size(); ++finger) {
    const auto column = static_cast<Eigen::Index>(finger);
    PerFinger<FeltContact> contacts = told(felt, at);
    contacts[finger] = moved(felt[finger], at.slid[finger] + step, 0);
    slopes.by_slid.col(column) = off(pose_with(part, at, contacts, chord), reference) / step;
    contacts[finger] = moved(felt[finger], at.slid[finger], kAngleStep);
    slopes.by_angle.col(column) = off(pose_with(part, at, contacts, chord), reference) / kAngleStep;
    for (const Eigen::Index axis : {0, 1}) {
      contacts = told(felt, at);
      contacts[finger].where[axis] += step;
      slopes.by_position.col(2 * column + axis) = off(pose_with(part, at, contacts, chord), reference) / step;
    }
  }
  return slopes;
}

}  // namespace

PoseSpread pose_spread_of(const Part& part, const std::vector<Piece>& pieces, const PerFinger<FeltContact>& felt,
                          const Noise& noise) {
  if (pieces.empty()) return {};
  if (pieces.front().pose) return spread_over(pieces);
  const bool is_one = felt.size() == 1;
  const double chord = chord_share(felt, noise);
  const Pose reference = pose_with(part, pieces.front(), told(felt, pieces.front()), chord);
  const PoseSlopes slopes = is_one ? PoseSlopes{} : slopes_of_two(part, pieces.front(), felt, chord);
  double total = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Piece& piece : pieces) {
    const Eigen::Vector3d by = off(pose_with(part, piece, told(felt, piece), chord), reference);
    total += piece.share;
    sum += piece.share * by;
    squares +=
        piece.share * (by * by.transpose() + slopes.by_slid * piece.slid_covariance * slopes.by_slid.transpose());
  }
  const Eigen::Vector3d mean = total > 0 ? Eigen::Vector3d(sum / total) : Eigen::Vector3d::Zero();
  PoseSpread spread;
  spread.mean = {reference.x + mean.x(), reference.y + mean.y(), nearest_angle(reference.heading) + mean.z()};
  if (total > 0) spread.covariance = squares / total - mean * mean.transpose();
  if (is_one) {
    spread.covariance += sensors_of_one(felt[0], spread.mean, noise);
  } else {
    spread.covariance += square(noise.angle) * slopes.by_angle * slopes.by_angle.transpose() +
                         square(noise.position) * slopes.by_position * slopes.by_position.transpose();
  }
  return spread;
}

}  // namespace rollfix::belief
