#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "belief/posterior.hpp"
#include "locate/searches.hpp"
#include "outline/turn.hpp"
#include "rollfix/belief.hpp"

// Notation:
//   s, t            first contacts of finger a and of finger b: `Mode::start`, `Placement::start`
//   extent          what of the boundary a placement reaches over; region, interval: a mode's whole, and its 95 %
//   off             how far a mode's start is outside an extent, in its own standard deviations: `off_placement`
//   ds/dtheta, ds/dL   1 / (kappa(s + L) - kappa(s)) and -kappa(s + L) times that: Sensitivity, of one finger
// Follows docs/search.md, "ACCURACY", and docs/belief.md, "What the verdict says".
// Idea: a mode is one placement, the nearest that it is within `kNear` of, or one by itself. What no mode is at is
// improbable; a mode that holds several placements makes none of them so.
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

/// Of one finger: with f' = kappa(s + L) - kappa(s), ds/dtheta = 1 / f' and ds/dL = -kappa(s + L) / f'. NaN where f' is
/// 0: at a double root, on an arc or a straight side.
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

/// How far a mode's start is outside a placement's extent, in the mode's standard deviations: of two fingers the larger
/// one. 0 inside.
double off_placement(const Placement& placement, const Mode& mode, const Part& part) {
  double most = 0;
  for (std::size_t finger = 0; finger < mode.start.size(); ++finger) {
    if (placement.whole_loop[finger]) continue;
    const double off = part.boundary().distance(placement.extent[finger], mode.start[finger]);
    if (off > 0) most = std::max(most, off / std::max(mode.sd[finger], 1e-300));
  }
  return most;
}

/// Each finger's place is in its interval of the box.
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
  // A pivot stays at its corner: there is no extent to cut.
  if (found.kind == Kind::corner) return placement;
  for (std::size_t finger = 0; finger < mode.start.size(); ++finger) {
    const Interval& region = mode.region[finger];
    const Interval& extent = found.extent[finger];
    // The whole extent lies in the region: nothing to cut. A wider one becomes the region.
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
  // Does the interval hold a convex corner?
  const auto holds_one = [&](const Interval& s) {
    return std::any_of(part.corners().begin(), part.corners().end(), [&](const Corner& corner) {
      return !corner.is_concave() && part.boundary().distance(s, corner.s) <= kAtCorner * part.perimeter();
    });
  };
  for (std::size_t finger = 0; finger < mode.start.size(); ++finger) {
    const Interval& first = mode.interval[finger];
    if (holds_one(first)) return true;
    // How far the end of a roll is known adds to the interval.
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

/// Each mode with the nearest placement of the search, if one is near; else by itself.
Weighed weigh(const Part& part, const std::vector<Reading>& readings, const std::optional<double>& facing,
              const std::vector<Placement>& found, Belief& belief) {
  const ContactEquations question{part, readings, facing};
  Weighed weighed;
  std::vector<bool> has_mode(found.size(), false);
  for (const Mode& mode : belief.modes()) {
    const Placement* nearest = nullptr;
    double least = kInfinity;
    // The placement that the mode's start is least outside of. All that are near have this mode.
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
    // At a corner f is not a function of s alone: there one finger keeps what the search found.
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
