#include "problem.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "log/mirrored.hpp"
#include "outline/turn.hpp"
#include "roll/noise.hpp"
#include "rollfix/error.hpp"

// What is refused, contacts alike, and the mirror. Notation:
//   (x, y), n       a touch's centre and the outward normal in the world: `at`, `normal`; tau = n + pi/2 is the part's
//                   tangent there: Measured::tangent
//   unit, most      what residuals are divided by, and how far they may go: a standard deviation and kPossibleSigmas of
//                   it, of angles pi at most; without noise both are the tolerance
//   M               the mirror (x, y) -> (-x, y): normals become pi - n, poses (X, Y, phi) become (-X, Y, -phi), their
//                   covariances C become S C S with S = diag(-1, 1, -1)
// Follows docs/touch.md, "What to give"; M is its own inverse.
// Idea: a part that lies face down looks in the mirror as it is drawn. So all that was measured is mirrored, the search
// knows of parts face up only, and its answer is mirrored back.
namespace rollfix {

namespace touch {
namespace {

// A touch further from the origin than this many perimeters is lost in the rounding of its own coordinates.
constexpr double kMostFar = 1e6;
// Without a unit, a normal beyond this many radians was hardly meant as radians.
constexpr double kMostNormal = 4 * std::numbers::pi;
// A normal that is noisier, radians, says next to nothing, and was most likely meant in degrees.
constexpr double kMostNormalSd = BeliefOptions::kMostAngle;
constexpr double kMostNormalTolerance = 0.5 * std::numbers::pi;

/// Throws InputError.
[[noreturn]] void refuse(const std::string& what) { throw InputError("touches: " + what); }

/// `most`: beyond it the measurement says nothing.
/// `where`, `what`: of the message; `cure`: how to state it.
void require_sd(double sd, double most, const std::string& where, const char* what, const char* cure) {
  if (!(std::isfinite(sd) && sd > 0)) {
    refuse(fmt::format("{}: expected a standard deviation above 0 of {}, found {}; {}", where, what, sd, cure));
  }
  if (sd > most) {
    refuse(
        fmt::format("{}: expected a standard deviation of at most {:.6g} of {}, beyond which it says nothing, found {}",
                    where, most, what, sd));
  }
}

/// A place, or a normal alone; both within what doubles and radians make sense of; with noise standard deviations of
/// each.
void require_touch(const TouchProblem& problem, std::size_t number) {
  const MeasuredTouch& touch = problem.touches[number];
  // Numbers in messages begin at 1.
  const std::string where = fmt::format("touch {}", number + 1);
  const double far = kMostFar * problem.part.perimeter();
  // NaN is not equal to itself: both coordinates NaN with a normal is a normal alone.
  if (!touch.has_place() && !(touch.at.x() != touch.at.x() && touch.at.y() != touch.at.y() && touch.normal)) {
    refuse(fmt::format("{}: expected a place, x and y, or a normal alone, found {}", where,
                       touch.normal ? "one of x and y" : "neither"));
  }
  if (touch.has_place() && !(std::abs(touch.at.x()) <= far && std::abs(touch.at.y()) <= far)) {
    refuse(fmt::format("{}: expected a place within {:.3g} of the origin, found ({}, {})", where, far, touch.at.x(),
                       touch.at.y()));
  }
  if (touch.normal && !(std::abs(*touch.normal) <= kMostNormal)) {
    refuse(fmt::format("{}: expected a normal in radians, found {}; degrees are written {}deg", where, *touch.normal,
                       *touch.normal));
  }
  if (!problem.noise) return;
  if (touch.has_place()) {
    // A standard deviation beyond the perimeter leaves the place open.
    require_sd(touch.position_sd.value_or(problem.noise->position), problem.part.perimeter(), where, "its place",
               "give `noise` with position=SD");
  }
  if (!touch.normal) return;
  require_sd(touch.normal_sd.value_or(problem.noise->angle), kMostNormalSd, where, "its normal",
             "give `noise` with angle=SD, or leave the normals out");
}

/// Normals alone leave the place open, as rolls without x and y do.
void require_a_place(const TouchProblem& problem) {
  const bool any = std::any_of(problem.touches.begin(), problem.touches.end(),
                               [](const MeasuredTouch& one) { return one.has_place(); }) ||
                   std::any_of(problem.rolls.begin(), problem.rolls.end(),
                               [](const Log& log) { return !log.fingers.front().x.empty(); });
  // Rolls alone may tell only the heading: that is an answer, too.
  if (any || problem.touches.empty()) return;
  refuse("expected a place, x and y, of at least one contact, found normals alone, which leave open where the part is");
}

/// Rolls beside paths on which nothing was felt have to say where the part is.
void require_clear_beside_rolls(const TouchProblem& problem) {
  if (!problem.finger->is_disk()) {
    refuse(
        fmt::format("`clear`: expected a round finger, disk,r=R, found {}: leave `clear` out", problem.finger->name()));
  }
  if (problem.rolls.size() + problem.touches.size() < 2) {
    refuse("`clear`: expected another roll or a touch beside one roll, found none: give one, or leave `clear` out");
  }
  // A touch that has a place tells where the part is.
  if (!problem.touches.empty()) return;
  const bool any_centre = std::any_of(problem.rolls.begin(), problem.rolls.end(),
                                      [](const Log& roll) { return !roll.fingers.front().x.empty(); });
  if (!any_centre) {
    refuse(
        "`clear`: expected where the part is, found rolls without x and y, which tell its heading alone: give logs "
        "with x and y, or a touch, or leave `clear` out");
  }
  if (problem.noise && !(problem.noise->position > 0)) {
    refuse("`clear`: expected how exact x and y are, found no position in `noise`: give position=SD");
  }
}

/// NaN fails the comparison: it is refused as well.
void require_clear(const TouchProblem& problem) {
  if (!problem.clear.empty() && !problem.rolls.empty()) require_clear_beside_rolls(problem);
  const double far = kMostFar * problem.part.perimeter();
  for (const Clear& path : problem.clear) {
    for (const double number : {path.from.x(), path.from.y(), path.to.x(), path.to.y()}) {
      if (std::abs(number) <= far) continue;
      refuse(fmt::format("`clear`: expected places within {:.3g} of the origin, found {}", far, number));
    }
  }
}

/// Rolls tell the part's heading, which they share, by u and psi.
void require_roll(const TouchProblem& problem, std::size_t number) {
  const Log& log = problem.rolls[number];
  const std::string where = fmt::format("roll {}", number + 1);
  if (log.fingers.size() != 1) {
    refuse(fmt::format("{}: expected the log of one finger on a part at rest, found one of two; solve each by itself",
                       where));
  }
  // Lengths and turns alone tell no heading.
  if (log.kind != LogKind::contact) {
    refuse(
        fmt::format("{}: expected columns u and psi, which tell the heading that rolls share, found lengths and turns; "
                    "solve each roll by itself",
                    where));
  }
  if (!problem.finger) refuse(fmt::format("{}: expected the finger, as in disk,r=R, found none", where));
}

/// Without noise. Rolls alone need none, touches one of length, normals one of angle.
void require_tolerance(const TouchProblem& problem) {
  if (!problem.tolerance && problem.touches.empty() && !problem.pose) return;  // the rolls' digits tell it
  if (!problem.tolerance) {
    refuse(
        "expected how exact they are, found neither `noise` nor `tolerance`; standard deviations are "
        "given with `noise` position=0.05,angle=1deg");
  }
  const TouchTolerance& tolerance = *problem.tolerance;
  const double most = problem.part.perimeter();
  // With rolls 0 is allowed.
  if (!problem.rolls.empty() && !(tolerance.angle >= 0)) {
    refuse(fmt::format("expected a `tolerance` of angles of at least 0, found {}", tolerance.angle));
  }
  if (problem.touches.empty() && tolerance.length == 0) return;  // of rolls alone the digits tell it
  if (!(tolerance.length > 0 && tolerance.length <= most)) {
    refuse(fmt::format("expected a `tolerance` of length above 0 and at most the perimeter, {:.6g}, found {}", most,
                       tolerance.length));
  }
  for (const MeasuredTouch& touch : problem.touches) {
    if (!touch.normal || (tolerance.angle > 0 && tolerance.angle <= kMostNormalTolerance)) continue;
    refuse(
        fmt::format("expected a `tolerance` of the normals above 0 and at most {:.3g} rad, found {}; "
                    "degrees are written 2deg",
                    kMostNormalTolerance, tolerance.angle));
  }
  // Without noise there is no likelihood to weigh a prior against.
  if (problem.pose) {
    refuse(fmt::format("`{}` is weighed against noise: give `noise` as well",
                       std::isinf(problem.pose->place_sd) ? "heading" : "pose"));
  }
}

}  // namespace

/// In the order in which a reader would look: contacts, finger, noise or tolerance, each contact, paths.
void require_valid(const TouchProblem& problem) {
  if (problem.touches.empty() && problem.rolls.empty()) refuse("expected at least one, found none");
  if (problem.finger) {
    if (!problem.finger->is_disk() && !problem.touches.empty()) {
      refuse(fmt::format("expected a round finger, disk,r=R, or none for a point, found {}", problem.finger->name()));
    }
    rollfix::require_valid(*problem.finger);
    require_no_corners({*problem.finger}, "several rolls and touches");
  }
  if (problem.noise) {
    rollfix::require_valid(*problem.noise);
    if (problem.rolls.empty()) require_kinds(*problem.noise, {&Noise::position, &Noise::angle}, "touches");
  } else {
    require_tolerance(problem);
  }
  if (problem.robust && !problem.noise) refuse("`robust` is about noise: give `noise` as well");
  for (std::size_t k = 0; k < problem.rolls.size(); ++k) require_roll(problem, k);
  for (std::size_t k = 0; k < problem.touches.size(); ++k) require_touch(problem, k);
  require_a_place(problem);
  require_clear(problem);
}

/// Of a finger that is no disk 0: then only rolls have it.
double radius_of(const TouchProblem& problem) {
  return problem.finger && problem.finger->is_disk() ? problem.finger->disk()->radius : 0;
}

}  // namespace touch

bool have_own_noise(const std::vector<MeasuredTouch>& touches) {
  return !touches.empty() && std::all_of(touches.begin(), touches.end(), [](const MeasuredTouch& touch) {
    return touch.position_sd && (!touch.normal || touch.normal_sd);
  });
}

}  // namespace rollfix

namespace rollfix::touch {
namespace {

/// Of all -v with v in the interval.
Interval negative(const Interval& interval) { return {-interval.hi, -interval.lo}; }

/// Lengths and turns run the other way, centres change the sign of x.
void mirror(RollFacts& roll) {
  for (Vec2& centre : roll.track) centre.x() = -centre.x();
  for (double& length : roll.reading.length) length = -length;
  roll.reading.turn = -roll.reading.turn;
  roll.searched = in_mirror(std::move(roll.searched));
}

/// (X, Y, phi) becomes (-X, Y, -phi): x and the heading change their signs in extents, intervals, means, densities and
/// in the covariance.
void mirror(TouchPose& pose) {
  pose.pose = mirrored(pose.pose);
  for (std::array<Interval, 3>* one : {&pose.extent, &pose.interval}) {
    (*one)[0] = negative((*one)[0]);
    (*one)[2] = negative((*one)[2]);
  }
  pose.spread = mirrored(pose.spread);
  for (const std::size_t i : {0U, 2U}) {
    for (MixtureTerm& term : pose.density[i]) term.mean = -term.mean;
  }
  for (TouchContact& contact : pose.contacts) {
    if (contact.turn) contact.turn = -*contact.turn;
  }
}

}  // namespace

/// With noise units are standard deviations and tolerances kPossibleSigmas of them, at most pi of an angle; without,
/// both are the tolerances. Trees are set by AllContacts.
std::vector<Measured> measured(const TouchProblem& problem) {
  std::vector<Measured> touches;
  for (const MeasuredTouch& touch : problem.touches) {
    Measured one;
    one.has_place = touch.has_place();
    if (one.has_place) one.at = touch.at;
    if (touch.normal) one.tangent = *touch.normal + 0.5 * std::numbers::pi;
    const Noise none;
    const Noise& noise = problem.noise ? *problem.noise : none;
    one.place_unit = problem.noise ? touch.position_sd.value_or(noise.position) : problem.tolerance->length;
    one.angle_unit = problem.noise ? touch.normal_sd.value_or(noise.angle) : problem.tolerance->angle;
    const double most = problem.noise ? kPossibleSigmas : 1;
    // Without a place nothing is too far.
    one.place_most = one.has_place ? most * one.place_unit : std::numeric_limits<double>::infinity();
    one.angle_most = std::min(most * one.angle_unit, std::numbers::pi);
    touches.push_back(one);
  }
  return touches;
}

/// All touches share one path and one tree. An empty path leaves them without: `one_fits_nowhere` says so.
AllContacts::AllContacts(const TouchProblem& problem, double radius, std::vector<RollContact> of_rolls)
    : rolls(std::move(of_rolls)) {
  for (const RollContact& roll : rolls) each.push_back(roll.measured);
  // Rolls alone need no path of a finger that touches.
  if (problem.touches.empty()) return;
  path.emplace(problem.part, radius);
  if (!path->stretches().empty()) tree.emplace(*path);
  for (Measured touch : measured(problem)) {
    if (tree) touch.tree = &*tree;
    each.push_back(touch);
  }
}

bool AllContacts::one_fits_nowhere() const {
  return (path && path->stretches().empty()) ||
         std::any_of(rolls.begin(), rolls.end(), [](const RollContact& roll) { return roll.fits_nowhere(); });
}

/// A direction a becomes pi - a, a place (-x, y).
RollSearched in_mirror(RollSearched roll) {
  if (roll.at) roll.at->x() = -roll.at->x();
  roll.normal = nearest_angle(std::numbers::pi - roll.normal);
  return roll;
}

/// Of all that was measured and of the prior x changes its sign; the part stays. Seen so, a part that lies face down
/// looks as it is stored.
TouchProblem in_mirror(const TouchProblem& problem) {
  TouchProblem result = problem;
  for (MeasuredTouch& touch : result.touches) {
    touch.at.x() = -touch.at.x();
    if (touch.normal) touch.normal = std::numbers::pi - *touch.normal;
  }
  for (Clear& path : result.clear) {
    path.from.x() = -path.from.x();
    path.to.x() = -path.to.x();
  }
  // u and psi of all rows, and centres: of a mirrored roll.
  for (Log& roll : result.rolls) mirror(roll.fingers.front(), problem.finger ? &*problem.finger : nullptr);
  // A finger with an outline is mirrored too; a disk of touches is its own image.
  if (result.finger && !result.rolls.empty()) result.finger = rollfix::mirrored(*problem.finger);
  if (result.pose) result.pose->mean = mirrored(result.pose->mean);
  return result;
}

/// Its own inverse.
void out_of_mirror(TouchAnswer& answer) {
  for (TouchPose& pose : answer.poses) mirror(pose);
  for (RollFacts& roll : answer.rolls) mirror(roll);
}

}  // namespace rollfix::touch
