#include "roll_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "answer/steps.hpp"
#include "log/jitter.hpp"
#include "outline/turn.hpp"
#include "problem.hpp"
#include "rollfix/error.hpp"
#include "rollfix/solve.hpp"

// Notation, of one roll in a problem of several contacts:
//   s              place of the roll's first contact on the boundary, and Theta(s) the tangent's angle there
//   (l_j, t_j)     its readings, how far and by how much it has turned: |Theta(s + l_j) - Theta(s) - t_j| <= tolerance
//   arcs           where s can be by the roll alone, `confined.arcs`; at a corner also which tangents: `pivots_alone`
//   q, tau         the finger's centre (or its contact) in the first row, and the part's tangent there: `Measured::at`,
//                  `tangent`, with the tolerances `place_most`, `angle_most`
//   n_k            nodes of the roll's belief, each with a mean and an information of (q, tau): RollBelief
// Follows docs/touch.md, "Several rolls", and the paper's condition for readings, docs/notation.md.
// Idea: a roll is one more touch, at its first contact, that knows where on the part it is; with noise q and tau are in
// the middle of what the nodes say, and the tolerance holds all of them.
namespace rollfix::touch {
namespace {

// Without noise centres are known to this share of the perimeter at best: an outline's own accuracy.
constexpr double kLeastPlace = 1e-6;
// Rows of a roll that are searched with at most.
constexpr std::size_t kInstants = 8;
// A normal of exact numbers is off by their rounding alone, radians.
constexpr double kLeastNormal = 1e-9;
// Arcs are rounded, a share of the perimeter.
constexpr double kArcRounding = 1e-12;
// Nearer to a corner than this share of the perimeter a contact may be at it.
constexpr double kAtCorner = 1e-9;
// A place of the boundary where the belief is less than exp(-this) of its largest has next to nothing of it.
constexpr double kLeastDensity = 25;

/// The log has columns x and y.
bool has_centres(const Log& log) { return !log.fingers.front().x.empty(); }

/// Whether the contact's place is evidence, by the problem.
/// With noise only if `position` is stated.
bool places_count(const TouchProblem& problem, const Log& log) {
  return has_centres(log) && (!problem.noise || problem.noise->position > 0);
}

/// Arcs in order that do not overlap; those nearer to each other than rounding are one. lo in [0, P), hi may exceed P.
std::vector<Interval> merged(std::vector<Interval> arcs, const Boundary& boundary) {
  const double slack = kArcRounding * boundary.perimeter;
  std::sort(arcs.begin(), arcs.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  std::vector<Interval> result;
  for (const Interval& arc : arcs) {
    if (!result.empty() && arc.lo <= result.back().hi + slack) {
      result.back().hi = std::max(result.back().hi, arc.hi);
    } else {
      result.push_back(arc);
    }
  }
  // Across the start of a closed boundary.
  // The last arc reaches past P into the first one.
  while (boundary.closed && result.size() > 1 && result.back().hi + slack >= boundary.perimeter + result.front().lo) {
    result.back().hi = std::max(result.back().hi, boundary.perimeter + result.front().hi);
    result.erase(result.begin());
  }
  return result;
}

/// By how much the worst of a roll's readings is off if it starts there, radians; none: a contact at a corner, where
/// that depends on the pivot, or beyond an end.
/// max |Theta(s + l_j) - Theta(s) - t_j| over all readings.
std::optional<double> off_from(const Answer& alone, double s) {
  const Boundary boundary = alone.part.boundary();
  const double slack = kAtCorner * boundary.perimeter;
  // Within an open outline, and not at a corner.
  const auto is_clear = [&](double at) {
    if (!boundary.closed && !(at >= 0 && at <= boundary.perimeter)) return false;
    return std::none_of(alone.part.corners().begin(), alone.part.corners().end(),
                        [&](const Corner& corner) { return boundary.distance(corner.s, at) <= slack; });
  };
  if (!is_clear(s)) return std::nullopt;
  const TurningFunction& turning = alone.part.turning();
  double worst = 0;
  for (const Reading& reading : alone.readings) {
    const double end = s + reading.length[0];
    if (!is_clear(end)) return std::nullopt;
    worst = std::max(worst, std::abs(turning.angle(end) - turning.angle(s) - reading.turn));
  }
  return worst;
}

/// An extent encloses what fits: this is it without what is off by more than the tolerance at its ends.
/// Bisection of either end against the placement's own start. A place at a corner counts as one that fits. Where the
/// start itself does not fit by this test, the extent stays.
Interval arc_of(const Answer& alone, const Placement& placement) {
  constexpr int kTrims = 50;
  Interval arc = placement.extent[0];
  const auto fits = [&](double s) {
    const std::optional<double> off = off_from(alone, s);
    return !off || *off <= alone.tolerance.value;
  };
  double inside = placement.start[0];
  if (alone.part.closed() && inside < arc.lo) inside += alone.part.perimeter();
  if (!(inside >= arc.lo && inside <= arc.hi && fits(inside))) return arc;
  for (double* end : {&arc.lo, &arc.hi}) {
    // `fitting` fits, `*end` does not: halved until the end fits, or at last is the place that does.
    double fitting = inside;
    for (int k = 0; k < kTrims && !fits(*end); ++k) {
      const double middle = 0.5 * (fitting + *end);
      (fits(middle) ? fitting : *end) = middle;
      if (k + 1 == kTrims) *end = fitting;
    }
  }
  return arc;
}

/// Where the roll can have started, by itself: what all of its rows agree with, where there is any.
/// What the search of the roll alone left undecided is kept as well, so that no place is lost.
std::vector<Interval> arcs_alone(const Answer& alone) {
  const double slack = kArcRounding * alone.part.perimeter();
  const std::vector<Corner>& corners = alone.part.corners();
  // Placements that other rows contradict count only where all are contradicted.
  const bool any_agrees = std::any_of(alone.placements.begin(), alone.placements.end(),
                                      [](const Placement& placement) { return !placement.is_contradicted; });
  std::vector<Interval> arcs;
  for (const Placement& placement : alone.placements) {
    if (any_agrees && placement.is_contradicted) continue;
    Interval arc = arc_of(alone, placement);
    // A root is more than a point, but of a start at a corner the sides next to it are no part.
    const bool is_corner = std::any_of(corners.begin(), corners.end(), [&](const Corner& corner) {
      return alone.part.boundary().distance(corner.s, arc.lo) <= slack;
    });
    if (!is_corner && arc.width() < 2 * slack) arc = {arc.lo - slack, arc.hi + slack};
    arcs.push_back(arc);
  }
  for (const PerFinger<Interval>& open : alone.unresolved) arcs.push_back(open[0]);
  return arcs;
}

/// The tangent's angles at a corner with which a roll that starts there has turned as all of its readings say.
/// Of a start at the corner s with pivot a: Theta(s + l_j) - a = t_j, where the end may be at a corner as well and
/// Theta takes every value between its sides. `angles`: all pivots there; lo above hi: none is left.
Interval pivots_alone(const Answer& alone, double s, const Interval& angles) {
  const TurningFunction& turning = alone.part.turning();
  const double slack = kArcRounding * alone.part.perimeter();
  Interval within = angles;
  for (const Reading& reading : alone.readings) {
    const double end = s + reading.length[0];
    const double before = turning.angle(end - slack) - reading.turn;
    const double behind = turning.angle(end + slack) - reading.turn;
    within.lo = std::max(within.lo, std::min(before, behind) - alone.tolerance.value);
    within.hi = std::min(within.hi, std::max(before, behind) + alone.tolerance.value);
  }
  return within;
}

/// The belief's pieces but for those from where the finger can't roll so.
/// `impossible` has placements out of the finger's reach: the mode around each is left out.
std::vector<PosePiece> possible_pieces(Belief& belief, const Answer& alone) {
  const Boundary boundary = alone.part.boundary();
  std::vector<Interval> barred;
  for (const Impossible& item : alone.impossible) {
    for (const Mode& mode : belief.modes()) {
      if (boundary.contains(mode.region[0], item.placement.start[0])) barred.push_back(mode.region[0]);
    }
  }
  std::vector<PosePiece> pieces = belief.pose_pieces();
  std::erase_if(pieces, [&](const PosePiece& piece) {
    const double middle = 0.5 * (piece.lo.s + piece.hi.s);
    return std::any_of(barred.begin(), barred.end(),
                       [&](const Interval& arc) { return boundary.contains(arc, middle); });
  });
  return pieces;
}

/// lo in [0, P); a piece within a corner is a point.
std::vector<Interval> arcs_of(const std::vector<PosePiece>& pieces, const Boundary& boundary) {
  std::vector<Interval> arcs;
  for (const PosePiece& piece : pieces) {
    const double lo = boundary.on_first_lap(piece.lo.s);
    arcs.push_back({lo, lo + (piece.hi.s - piece.lo.s)});
  }
  return arcs;
}

/// The direction of the part's tangent in the world at the first contact, and where the finger's centre was (of a disk)
/// or the contact.
/// Sets `tangent` and, if the log has centres, `at`. `radius`: of a disk; 0: another finger, whose contact is at its
/// centre less the centre's offset from a contact at the origin.
void measure_first(const Log& log, const Finger& finger, double radius, Measured& measured) {
  const FingerRows& rows = log.fingers.front();
  const Contact first = contacts_of(rows, finger).front();
  // The normal points into the part: the tangent is that + pi (the outward normal) + pi / 2.
  measured.tangent = normal_direction(finger, first) - 0.5 * std::numbers::pi;
  if (!has_centres(log)) return;
  measured.at = Vec2(rows.x.front(), rows.y.front());
  if (radius == 0) measured.at -= centre_of(finger, Vec2::Zero(), first);
}

/// With noise: an arc of each that holds what the nodes say, and the tolerance of the search beyond.
/// The middle of all nodes' means and, beyond half their range, kPossibleSigmas of the largest standard deviation: the
/// search holds every other node. Left out are nodes whose density is below exp(-kLeastDensity) of the largest.
void measure_belief(const RollBelief& belief, Measured& measured) {
  Vec2 least(1e300, 1e300), most(-1e300, -1e300);
  double before = 0, behind = 0, place_sd = 0, angle_sd = 0;
  const double about = belief.nodes().front().tangent;
  for (const RollNode& node : belief.nodes()) {
    if (node.log_density < -kLeastDensity) continue;
    least = least.cwiseMin(node.at);
    most = most.cwiseMax(node.at);
    // Tangents are unwrapped about the first node's.
    const double off = nearest_angle(node.tangent - about);
    before = std::min(before, off);
    behind = std::max(behind, off);
    if (!belief.has_place()) {
      angle_sd = std::max(angle_sd, 1 / std::sqrt(node.information(2, 2)));
      continue;
    }
    const Eigen::Matrix3d covariance = node.information.inverse();
    angle_sd = std::max(angle_sd, std::sqrt(covariance(2, 2)));
    place_sd = std::max(place_sd, std::sqrt(covariance.topLeftCorner<2, 2>().trace()));
  }
  measured.tangent = about + 0.5 * (before + behind);
  measured.angle_unit = angle_sd;
  measured.angle_most = std::min(kPossibleSigmas * angle_sd + 0.5 * (behind - before), std::numbers::pi);
  if (!belief.has_place()) return;
  measured.at = 0.5 * (least + most);
  measured.place_unit = place_sd;
  measured.place_most = kPossibleSigmas * place_sd + 0.5 * (most - least).norm();
}

/// How far centres may be off, as far as their digits show.
/// Length: the stated tolerance, or what the digits of x and y, of the other columns and of the outline leave.
double place_tolerance(const TouchProblem& problem, const Log& log, const Finger& finger) {
  if (problem.tolerance && problem.tolerance->length > 0) return problem.tolerance->length;
  std::vector<double> coordinates;  // a single column may be whole numbers by chance: along a side that is an axis
  for (const Log& roll : problem.rolls) {
    for (const std::vector<double>* column : {&roll.fingers.front().x, &roll.fingers.front().y}) {
      coordinates.insert(coordinates.end(), column->begin(), column->end());
    }
  }
  const double digits = std::numbers::sqrt2 * rounding_of_column(coordinates);
  return digits + rounding_of(log, {finger}).length + kLeastPlace * problem.part.perimeter();
}

/// Without noise, of a roll of several rows. Units are the tolerances themselves.
void measure_exactly(const TouchProblem& problem, const Log& log, RollContact& contact) {
  Measured& measured = contact.measured;
  // Two headings differ by no more than the facing of two rolls may be off.
  measured.angle_unit = measured.angle_most = 0.5 * contact.alone.tolerance.value;
  measured.place_unit = measured.place_most =
      measured.has_place ? place_tolerance(problem, log, *problem.finger) : problem.part.perimeter();
}

/// How far a single row may be off: the contact's place in the world, of a disk its centre, and its normal.
/// With noise: the angle's sd is that of u + psi, with the contact's noise turned into an angle by the finger's
/// curvature.
void measure_touch(const TouchProblem& problem, const Log& log, Measured& measured) {
  const Finger& finger = *problem.finger;
  if (!problem.noise) {
    const double digits = problem.tolerance ? 0 : rounding_of(log, {*problem.finger}).turn;
    measured.angle_unit = measured.angle_most =
        problem.tolerance && problem.tolerance->angle > 0 ? problem.tolerance->angle : digits + kLeastNormal;
    measured.place_unit = measured.place_most = place_tolerance(problem, log, finger);
    return;
  }
  const Noise& noise = *problem.noise;
  const Contact first = contacts_of(log.fingers.front(), finger).front();
  measured.angle_unit = std::max(std::hypot(noise.angle, finger.curvature(first.u) * noise.contact), kLeastNormal);
  measured.place_unit = noise.position;
  if (!finger.is_disk()) {  // of a disk the centre is what was measured
    // Of another finger the contact is computed from the centre, by the angle and by where on the finger it is.
    const double arm = centre_of(finger, Vec2::Zero(), first).norm();
    measured.place_unit = std::hypot(noise.position, noise.contact, arm * noise.angle);
  }
  measured.angle_most = std::min(kPossibleSigmas * measured.angle_unit, std::numbers::pi);
  measured.place_most = kPossibleSigmas * measured.place_unit;
}

/// Of one row: it can be anywhere on the part.
/// The path of a contact on all of the part; nothing is known of it alone.
RollContact touch_of(const TouchProblem& problem, const Log& log, RollCentre centre) {
  const double radius = problem.finger->is_disk() ? problem.finger->disk()->radius : 0;
  RollContact contact{Answer{problem.part}, {}, {}, {}, {}, {}};
  contact.alone.readings = {Reading(0, 0)};
  contact.alone.verdict.name = Verdict::unobservable;
  contact.path = std::make_unique<CentrePath>(problem.part, radius);
  contact.confined.arcs = {{0, problem.part.perimeter()}};
  if (!contact.path->stretches().empty()) contact.tree = std::make_unique<PathTree>(*contact.path);
  Measured& measured = contact.measured;
  measured.has_place = centre != RollCentre::unused;
  measured.tree = contact.tree.get();
  measure_first(log, *problem.finger, radius, measured);
  measure_touch(problem, log, measured);
  // No evidence: a place that may be off by the perimeter says nothing.
  if (centre == RollCentre::evidence) return contact;
  measured.place_unit = measured.place_most = problem.part.perimeter();
  return contact;
}

/// Builds the path and the tree of a contact within its arcs.
void confine(RollContact& contact, const Part& part, double radius) {
  contact.confined.arcs = merged(std::move(contact.confined.arcs), part.boundary());
  contact.path = std::make_unique<CentrePath>(part, radius, &contact.confined);
  contact.confined.angles = {};  // it has served
  if (!contact.path->stretches().empty()) contact.tree = std::make_unique<PathTree>(*contact.path);
}

/// Solves the roll alone, then confines it: with noise to where its belief has mass, else to where its readings fit.
RollContact contact_of(const TouchProblem& problem, const Log& log, RollCentre centre) {
  if (log.rows() == 1) return touch_of(problem, log, centre);
  const Problem single = alone(problem, log);
  RollContact contact{solve(single), {}, {}, {}, {}, {}};
  const bool is_disk = problem.finger->is_disk();
  const double radius = is_disk ? problem.finger->disk()->radius : 0;
  const Log& used = *single.measured.log;
  contact.travelled = observe(single).rolls.back().length[0];
  contact.measured.has_place = centre == RollCentre::evidence;
  measure_first(used, *problem.finger, radius, contact.measured);
  if (problem.noise) {
    std::optional<Belief> belief = believe(single, observe(single));
    // By the stated noise, not a wider one.
    contact.log_evidence = belief->evidence().with(1);
    const std::vector<PosePiece> pieces = possible_pieces(*belief, contact.alone);
    contact.confined.arcs = arcs_of(pieces, problem.part.boundary());
    confine(contact, problem.part, radius);
    if (contact.tree) contact.belief = std::make_unique<RollBelief>(*contact.path, pieces, centre);
    if (contact.belief && !contact.belief->nodes().empty()) measure_belief(*contact.belief, contact.measured);
  } else {
    confine_by_readings(contact, problem.part, radius);
    measure_exactly(problem, used, contact);
  }
  // Where the part is follows from this contact, but the search learns nothing from it.
  if (centre == RollCentre::reference) {
    contact.measured.has_place = true;
    contact.measured.place_unit = contact.measured.place_most = problem.part.perimeter();
  }
  contact.measured.is_roll = true;
  contact.measured.tree = contact.tree.get();
  contact.measured.roll = contact.belief.get();
  return contact;
}

/// Without noise rows all along the roll are searched with, so that what one of them contradicts is gone.
/// At most kInstants, evenly over the rows; a log without times gets row numbers for times.
void add_instants(Problem& single) {
  Log& log = *single.measured.log;
  if (log.time.empty()) {
    for (std::size_t k = 0; k < log.rows(); ++k) log.time.push_back(static_cast<double>(k));
  }
  const std::size_t last = log.rows() - 1;
  const std::size_t count = std::min(last, kInstants);
  // The last of them is the last row.
  for (std::size_t k = 1; k <= count; ++k) single.at.push_back(log.time[k * last / count]);
}

}  // namespace

/// The prior of the pose counts for a roll only if nothing else is solved with it: else it would count twice.
Problem alone(const TouchProblem& problem, const Log& log) {
  Problem single{problem.part, log, {*problem.finger}, problem.noise};
  // Without centres their noise has no meaning.
  if (problem.noise && !has_centres(log)) single.noise->position = 0;
  if (problem.tolerance) single.tolerance = problem.tolerance->angle;
  if (problem.rolls.size() + problem.touches.size() == 1) single.pose = problem.pose;
  single.robust = problem.robust;
  single.diagnose = false;
  // Rows that are outliers of the roll alone are left out before.
  if (single.robust) single.measured.log = without_strays(log, problem.part, single.fingers, *problem.noise);
  if (!problem.noise && problem.rolls.size() + problem.touches.size() > 1) add_instants(single);
  return single;
}

std::vector<RollContact> roll_contacts(const TouchProblem& problem) {
  const bool any_place = std::any_of(problem.touches.begin(), problem.touches.end(),
                                     [](const MeasuredTouch& touch) { return touch.has_place(); }) ||
                         std::any_of(problem.rolls.begin(), problem.rolls.end(),
                                     [&](const Log& log) { return places_count(problem, log); });
  std::vector<RollContact> contacts;
  for (const Log& log : problem.rolls) {
    // Where no place is evidence, poses are counted from the first roll's first contact.
    const bool is_reference = !any_place && contacts.empty();
    const bool counts = places_count(problem, log);
    contacts.push_back(contact_of(problem, log,
                                  is_reference ? RollCentre::reference
                                  : counts     ? RollCentre::evidence
                                               : RollCentre::unused));
  }
  return contacts;
}

void confine_by_readings(RollContact& contact, const Part& part, double radius) {
  contact.confined.arcs = arcs_alone(contact.alone);
  contact.confined.angles = [&](double s, const Interval& angles) { return pivots_alone(contact.alone, s, angles); };
  confine(contact, part, radius);
}

/// `searched`: what a certificate needs to repeat the search.
RollFacts facts_of(const RollContact& contact, const Log& log) {
  const std::vector<std::size_t>& line = log.fingers.front().line;
  RollFacts facts;
  facts.name = log.name;
  if (!line.empty()) facts.lines = {line.front(), line.back()};
  facts.rows = log.rows();
  facts.reading = contact.alone.readings.back();
  facts.has_centre = has_centres(log);
  const FingerRows& rows = log.fingers.front();
  for (std::size_t k = 0; k < rows.x.size(); ++k) facts.track.emplace_back(rows.x[k], rows.y[k]);
  facts.alone = contact.alone.verdict;
  facts.placements = contact.alone.placements.size();
  const Measured& measured = contact.measured;
  facts.searched.normal = nearest_angle(*measured.tangent - 0.5 * std::numbers::pi);
  const bool is_reference = measured.place_most >= contact.alone.part.perimeter();
  if (measured.has_place && !is_reference) facts.searched.at = measured.at;
  facts.searched.readings.assign(contact.alone.readings.begin(), contact.alone.readings.end());
  facts.searched.tolerance = contact.alone.tolerance.value;
  return facts;
}

}  // namespace rollfix::touch
