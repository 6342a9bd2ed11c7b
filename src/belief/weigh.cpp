#include "rollfix/belief/weigh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "belief/policy.hpp"
#include "part/angle.hpp"

namespace rollfix {

namespace {

using belief::distance_to;
using belief::kNear;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Curvatures at both ends of the roll decide how the start moves with the reading.
Sensitivity sensitivity_at(const Part& part, const std::vector<Reading>& readings, double s) {
  Sensitivity sensitivity;
  for (const Reading& reading : readings) {
    const double here = part.turning().curvature(s);
    const double there = part.turning().curvature(s + reading.length);
    const bool is_simple = there != here;
    sensitivity.per_turn.push_back(is_simple ? 1 / (there - here) : kNaN);
    sensitivity.per_length.push_back(is_simple ? -there / (there - here) : kNaN);
  }
  return sensitivity;
}

double residual_at(const Part& part, const std::vector<Reading>& readings, double s) {
  double most = 0;
  for (const Reading& reading : readings) {
    const double turned = part.turning().angle(s + reading.length) - part.turning().angle(s);
    most = std::max(most, std::abs(turned - reading.turn));
  }
  return most;
}

/// What a mode is by itself: nothing of the search holds it.
Placement placement_of(const Mode& mode) {
  Placement placement;
  placement.kind = Kind::touching;
  placement.extent = mode.interval;
  placement.error = std::numeric_limits<double>::infinity();
  return placement;
}

/// What the search knows of a mode's place: the part of a placement that lies in the mode's region.
Placement within(const Placement& found, const Mode& mode, const Part& part) {
  Placement placement = found;
  placement.roots.clear();
  for (const double root : found.roots) {
    if (distance_to(mode.region, root, part) == 0) placement.roots.push_back(root);
  }
  const bool is_all =
      distance_to(mode.region, found.extent.lo, part) == 0 && found.extent.width() <= mode.region.width();
  if (!is_all && found.kind != Kind::corner) {
    placement.extent = found.whole_loop || found.extent.width() > mode.region.width() ? mode.region : found.extent;
    placement.whole_loop = false;
  }
  return placement;
}

}  // namespace

Weighed weigh(const Part& part, const std::vector<Reading>& readings, const Search& found, Belief& belief) {
  Weighed weighed;
  std::vector<bool> has_mode(found.placements.size(), false);
  for (const Mode& mode : belief.modes()) {
    std::size_t nearest = found.placements.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < found.placements.size(); ++k) {
      const double distance =
          found.placements[k].whole_loop ? 0 : distance_to(found.placements[k].extent, mode.start, part);
      if (distance < least) {
        least = distance;
        nearest = k;
      }
      // A wide mode can hold several.
      if (distance <= kNear * mode.sd || distance_to(mode.interval, found.placements[k].start, part) == 0) {
        has_mode[k] = true;
      }
    }
    const bool is_found = nearest < found.placements.size() && least <= kNear * mode.sd;
    Placement placement = is_found ? within(found.placements[nearest], mode, part) : placement_of(mode);
    placement.start = mode.start;
    placement.end = mode.end;
    placement.point = part.point(mode.start);
    placement.tangent = nearest_angle(mode.tangent);
    if (placement.kind != Kind::corner) {
      placement.residual = residual_at(part, readings, mode.start);
      placement.sensitivity = sensitivity_at(part, readings, mode.start);
    }
    weighed.placements.push_back(std::move(placement));
    weighed.modes.push_back(mode);
  }
  for (std::size_t k = 0; k < found.placements.size(); ++k) {
    if (!has_mode[k]) weighed.improbable.push_back(found.placements[k]);
  }
  return weighed;
}

}  // namespace rollfix
