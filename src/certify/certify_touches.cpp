#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "places.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/error.hpp"
#include "touch/steps.hpp"

// Notation:
//   pose            x, y and heading of the part; a set of them is an extent: CertifiedPose
//   told            what tells a pose: where a centre was, and whether a normal: Told
//   margin          by how much a pose may move and turn while shares of the tolerances, `kWider`, make up for it
// Follows docs/certificates.md, "Touches".
// Idea: the certificate is the question, and boxes that hold all sets of poses; the verifier searches by itself. What
// an answer leaves out is within the tolerances as well, so that it has to be among the boxes.
namespace rollfix::certifying {
namespace {

/// The question of an answer, with only what decides which poses fit: touches, finger, noise or tolerance, side. No
/// prior and no clear paths, which only weigh poses or drop them.
TouchProblem asked(const TouchAnswer& answer, std::optional<std::size_t> budget) {
  TouchProblem problem{answer.part, answer.touches};
  if (answer.radius > 0) problem.finger = disk(answer.radius);
  problem.noise = answer.noise;
  if (!problem.noise) problem.tolerance = answer.tolerance.back();  // of a touch, if there is one
  problem.mirrored = answer.mirrored;
  problem.budget = budget;
  return problem;
}

/// How much wider extents are written down than they are, in shares of the tolerances: where a pose is at their very
/// edge no box of poses is on one side of it.
constexpr double kWider = 0.05;

/// By how much a pose may move and turn for that.
struct Margin {
  double place = 0;           // of `about`, in the part's unit
  double turn = 0;            // of the heading, radians
  Vec2 about = Vec2::Zero();  // the middle of the measured centres, world
};

/// What tells a pose: where a centre was, if that is known, and whether a normal.
struct Told {
  std::optional<Vec2> at;
  bool normal = false;
};

/// One entry for each contact in the order of `tolerance`: rolls first, whose first contact always has a normal.
std::vector<Told> told_by(const TouchAnswer& answer) {
  std::vector<Told> told;
  for (const RollFacts& roll : answer.rolls) told.push_back({roll.searched.at, true});
  for (const MeasuredTouch& touch : answer.touches) {
    told.push_back({touch.has_place() ? std::optional(touch.at) : std::nullopt, touch.normal.has_value()});
  }
  return told;
}

/// The largest margin that spends no more than `kWider` of each contact's tolerance. A touch that is `away` from the
/// middle moves by away * turn when the part turns about it. `away` counts as no less than the tolerance: a touch in
/// the very middle must not allow every turn.
Margin margin_of(const TouchAnswer& answer) {
  const std::vector<Told> told = told_by(answer);
  const auto count = std::count_if(told.begin(), told.end(), [](const Told& one) { return one.at.has_value(); });
  Margin margin;
  for (const Told& one : told) {
    if (one.at) margin.about += *one.at / static_cast<double>(count);
  }
  margin.place = margin.turn = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < told.size(); ++k) {
    const TouchTolerance& tolerance = answer.tolerance[k];
    if (told[k].normal) margin.turn = std::min(margin.turn, kWider * tolerance.angle);
    if (!told[k].at) continue;
    const double away = (*told[k].at - margin.about).norm();
    margin.place = std::min(margin.place, kWider * tolerance.length);
    margin.turn = std::min(margin.turn, kWider * tolerance.length / std::max(away, tolerance.length));
  }
  return margin;
}

/// Below it the verifier's doubles decide, radians.
constexpr double kLeastAngle = 1e-9;

/// Throws InputError: what certificates have no claim for.
void require_certifiable(const TouchAnswer& answer) {
  if (answer.contact_count() < 2) {
    throw InputError(
        "a certificate of touches: expected at least two contacts, found 1, which leaves all poses along the "
        "boundary; of one roll without noise certify its readings");
  }
  if (answer.robust && !answer.touches.empty()) {
    throw InputError(
        "a certificate of touches: expected all touches to count, found `robust`, by which any of them may be an "
        "outlier: leave it out, and the touches that are");
  }
  if (answer.rolls.empty()) return;
  const bool any_single =
      std::any_of(answer.rolls.begin(), answer.rolls.end(), [](const RollFacts& roll) { return roll.rows == 1; });
  // A roll with one row has no reading: only its first contact counts.
  if (any_single) {
    throw InputError(
        "a certificate of rolls: expected two rows of each, found one row: give it as a touch with its normal");
  }
  if (answer.noise) {
    throw InputError(
        "a certificate of rolls: expected a tolerance, found noise, under which no pose is out of the question: give "
        "`tolerance` LENGTH,ANGLE in its place");
  }
  for (const RollFacts& roll : answer.rolls) {
    const double angle = 0.5 * roll.searched.tolerance;
    if (angle >= kLeastAngle) continue;
    throw InputError(
        fmt::format("a certificate of rolls: expected a `tolerance` of angles of at least {:.0e} rad, "
                    "found {:.3g}: give LENGTH,ANGLE",
                    2 * kLeastAngle, roll.searched.tolerance));
  }
}

/// With its extent a little wider.
CertifiedPose certified(const Part& part, const TouchPose& pose, const Margin& margin, bool listed) {
  // NaN where nothing tells the place: only headings are claimed then.
  const bool has_place = !std::isnan(pose.extent[0].lo);
  CertifiedPose result{pose, {}, listed, pose.contacts.empty() || !has_place || touch::is_own(pose)};
  // The part's origin is no further from the touches than in the extent's corner that is furthest from them.
  const double away = std::hypot(
      std::max(std::abs(pose.extent[0].lo - margin.about.x()), std::abs(pose.extent[0].hi - margin.about.x())),
      std::max(std::abs(pose.extent[1].lo - margin.about.y()), std::abs(pose.extent[1].hi - margin.about.y())));
  const std::array<double, 3> by{margin.place + away * margin.turn, margin.place + away * margin.turn, margin.turn};
  for (std::size_t k = 0; k < 3; ++k) {
    Interval& extent = result.pose.extent[k];
    extent = {extent.lo - by[k], extent.hi + by[k]};
  }
  // Places by the outline's formulas, which the verifier computes again.
  for (const TouchContact& contact : pose.contacts) result.at.push_back(place_of(part, contact.s));
  return result;
}

/// Arcs, each longer by `by` at both ends, so that no place at their ends is in doubt. Of a closed outline each starts
/// in [0, P), and a full lap is [0, P].
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

}  // namespace rollfix::certifying

namespace rollfix {

/// Turns an answer into a certificate. `budget`: of the search for sets that the answer leaves out. Throws InputError:
/// fewer than two contacts, robust touches, rolls with noise or too small a tolerance, a curve without a formula.
TouchCertificate certify_touches(const TouchAnswer& answer, std::optional<std::size_t> budget) {
  certifying::require_certifiable(answer);
  TouchCertificate certificate;
  static_cast<CertifiedOutline&>(certificate) = certifying::certified_outline(answer.part);
  certificate.mirrored = answer.mirrored;
  certificate.radius = answer.radius;
  for (const RollFacts& roll : answer.rolls) certificate.rolls.push_back(roll.searched);
  certificate.touches = answer.touches;
  certificate.tolerance = answer.tolerance;
  // Places that the disk can't touch without entering the part elsewhere are left out of the verifier's search.
  if (answer.radius > 0) {
    Reach reach = reach_of_disk(answer.part, answer.radius);
    if (!reach.is_whole()) certificate.reach = std::move(reach);
  }
  const certifying::Margin margin = certifying::margin_of(answer);
  const auto add = [&](const TouchPose& pose, bool listed) {
    certificate.poses.push_back(certifying::certified(answer.part, pose, margin, listed));
  };
  for (const TouchPose& pose : answer.poses) add(pose, true);
  std::vector<Interval> unresolved = answer.unresolved;
  certificate.unresolved_touch = answer.unresolved_touch;
  // With noise, paths or rolls the answer leaves out poses within the tolerances. The verifier finds them, so they must
  // be among the boxes.
  if (answer.noise || !answer.clear.empty() || !answer.rolls.empty()) {
    const TouchAnswer beyond =
        touch::poses_beyond(certifying::asked(answer, budget), certificate.rolls, answer.tolerance, answer.poses);
    for (const TouchPose& pose : beyond.poses) add(pose, false);
    unresolved = beyond.unresolved;  // what could not be weighed is among its sets
    certificate.unresolved_touch = beyond.unresolved_touch;
  }
  // Arcs of open contacts are wider by the tolerance of the touch whose contacts they are.
  const double by = certificate.tolerance[certificate.unresolved_touch].length;
  certificate.unresolved = certifying::widened(std::move(unresolved), by, answer.part.boundary());
  return certificate;
}

}  // namespace rollfix
