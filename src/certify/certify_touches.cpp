#include <algorithm>
#include <array>
#include <utility>

#include "places.hpp"
#include "rollfix/certify/touch_certificate.hpp"
#include "rollfix/error.hpp"
#include "touch/poses_beyond.hpp"

// Follows docs/certificates.md, "Touches".
// Idea: the certificate is the question, and boxes that hold all sets of poses; the verifier searches by itself. What
// an answer leaves out is within the tolerances as well, so that it has to be among the boxes.
namespace rollfix {
namespace {

/// The question of an answer, without what only weighs poses.
TouchProblem asked(const TouchAnswer& answer, std::optional<std::size_t> budget) {
  TouchProblem problem{answer.part, answer.touches};
  if (answer.radius > 0) problem.finger = disk(answer.radius);
  problem.noise = answer.noise;
  if (!problem.noise) problem.tolerance = answer.tolerance.front();
  problem.mirrored = answer.mirrored;
  problem.budget = budget;
  return problem;
}

CertifiedPose certified(const Part& part, const TouchPose& pose, bool listed) {
  CertifiedPose result{pose, {}, listed};
  for (const TouchContact& contact : pose.contacts) result.at.push_back(place_of(part, contact.s));
  return result;
}

/// A little longer, so that no place at their ends is in doubt.
std::vector<Interval> widened(std::vector<Interval> arcs, double by, const Boundary& boundary) {
  for (Interval& arc : arcs) {
    arc = {arc.lo - by, arc.hi + by};
    if (!boundary.closed) arc = {std::max(arc.lo, 0.0), std::min(arc.hi, boundary.perimeter)};
    if (boundary.closed && arc.width() >= boundary.perimeter) arc = {0, boundary.perimeter};
    if (arc.lo < 0) arc = {arc.lo + boundary.perimeter, arc.hi + boundary.perimeter};
  }
  return arcs;
}

}  // namespace

TouchCertificate certify_touches(const TouchAnswer& answer, std::optional<std::size_t> budget) {
  if (!answer.rolls.empty()) {
    throw InputError("expected touches alone, found rolls: certificates of both together are not written");
  }
  if (answer.touches.size() < 2) throw InputError("expected at least two touches: one alone leaves no set of poses");
  TouchCertificate certificate;
  static_cast<CertifiedOutline&>(certificate) = certified_outline(answer.part);
  certificate.mirrored = answer.mirrored;
  certificate.radius = answer.radius;
  certificate.touches = answer.touches;
  certificate.tolerance = answer.tolerance;
  if (answer.radius > 0) {
    Reach reach = reach_of_disk(answer.part, answer.radius);
    if (!reach.is_whole()) certificate.reach = std::move(reach);
  }
  for (const TouchPose& pose : answer.poses) certificate.poses.push_back(certified(answer.part, pose, true));
  std::vector<Interval> unresolved = answer.unresolved;
  certificate.unresolved_touch = answer.unresolved_touch;
  if (answer.noise || !answer.clear.empty()) {
    const TouchAnswer beyond = touch::poses_beyond(asked(answer, budget), answer.poses);
    for (const TouchPose& pose : beyond.poses) certificate.poses.push_back(certified(answer.part, pose, false));
    unresolved.insert(unresolved.end(), beyond.unresolved.begin(), beyond.unresolved.end());
    certificate.unresolved_touch = beyond.unresolved_touch;
  }
  const double by = certificate.tolerance[certificate.unresolved_touch].length;
  certificate.unresolved = widened(std::move(unresolved), by, answer.part.boundary());
  return certificate;
}

}  // namespace rollfix
