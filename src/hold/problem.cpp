#include "held_rows.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "box_search.hpp"
#include "log/log_rows.hpp"
#include "log/mirrored.hpp"
#include "roll/noise.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/error.hpp"

// A problem's logs by number, what of it is refused, and what a mirror shows of it.
namespace rollfix::hold {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw InputError("fingers on a free part: " + what); }

/// Two bodies at least, one of them with skin; one finger that holds for all logs, or one for each. No finger with
/// corners.
void require_fingers(const HoldProblem& problem) {
  const std::size_t count = problem.logs.size();
  const std::size_t all = count + problem.wheels.size();
  if (all < 2 || all > kMostFingers) {
    refuse(fmt::format("expected logs of 2 to {} fingers, found {}", kMostFingers, all));
  }
  if (count == 0) {
    refuse(
        "expected a finger with skin, found wheels alone: where pins were says nothing of a part that may lie "
        "anywhere; add the log of a finger with u and psi, as of a jaw");
  }
  if (problem.fingers.empty()) {
    refuse(
        "expected the fingers that rolled, found none; give one that holds for all, as in disk,r=R, or one for each");
  }
  if (problem.fingers.size() != 1 && problem.fingers.size() != count) {
    refuse(fmt::format("expected one finger for all logs, or {}, one for each log, found {}", count,
                       problem.fingers.size()));
  }
  for (const Finger& finger : problem.fingers) rollfix::require_valid(finger);
  require_no_corners(problem.fingers, problem.wheels.empty() ? "three and more fingers" : "a finger beside a wheel");
}

/// The log of one finger, of u and psi, with two rows at least.
void require_log(const Log& log) {
  if (log.fingers.size() != 1) {
    refuse(fmt::format("{}: expected the log of one finger, found one of two; give each finger its own log", log.name));
  }
  if (log.kind != LogKind::contact) {
    refuse(fmt::format(
        "{}: expected columns u and psi, which say how the contact's normal points, found lengths and turns",
        log.name));
  }
  if (log.rows() < 2) refuse(fmt::format("{}: expected at least 2 rows, found {}", log.name, log.rows()));
}

/// Wheels with a radius and two rows of x and y. They need a finger with skin that has x and y as well: a pin tells
/// something only as seen from it. A squeeze needs one finger and one wheel.
void require_wheels(const HoldProblem& problem) {
  for (const PassiveWheel& wheel : problem.wheels) {
    rollfix::require_valid(Finger(disk(wheel.radius)));
    const FingerRows& rows = wheel.log.rows.fingers.front();
    if (rows.x.size() != rows.u.size() || rows.y.size() != rows.u.size() || rows.u.size() < 2) {
      refuse(fmt::format("{}: expected at least 2 rows with x and y of the wheel's pin", wheel.log.rows.name));
    }
  }
  if (problem.squeezed) {
    if (!(std::isfinite(*problem.squeezed) && *problem.squeezed > 0)) {
      refuse(fmt::format("squeezed: expected a standard deviation above 0, an angle, found {}", *problem.squeezed));
    }
    if (problem.logs.size() != 1 || problem.wheels.size() != 1) {
      refuse(
          fmt::format("squeezed: expected one finger with skin and one wheel, found {} and {}: with others the forces "
                      "do not lie on one line; leave it out",
                      problem.logs.size(), problem.wheels.size()));
    }
  }
  if (problem.wheels.empty()) return;
  bool any_place = false;
  for (const Log& log : problem.logs) any_place = any_place || !log.fingers.front().x.empty();
  if (!any_place) {
    refuse(
        fmt::format("{}: expected columns x and y, where the origin of the finger's frame was, found none: a wheel "
                    "says something by where its pin was as seen from the finger; without both any place "
                    "on the part fits",
                    problem.logs.front().name));
  }
  // Without a stated error x and y are no evidence.
  if (problem.noise && !(problem.noise->position > 0)) {
    refuse("expected noise with position=SD beside a wheel, found none: all that a wheel says is where its pin was");
  }
}

/// Two logs with the same rows are one file given twice: two fingers are not at one place.
void require_different(const std::vector<Log>& logs) {
  for (std::size_t k = 1; k < logs.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      const FingerRows &one = logs[i].fingers.front(), &other = logs[k].fingers.front();
      if (one.u != other.u || one.psi != other.psi || one.x != other.x || one.y != other.y) continue;
      refuse(fmt::format("the logs of fingers {} and {} have the same rows, {} and {}; expected one log of each finger",
                         finger_letter(i), finger_letter(k), logs[i].name, logs[k].name));
    }
  }
}

/// `robust`, `prior` and `pose` need noise and take no wheels. A pose with x and y needs centres as evidence.
void require_weighing(const HoldProblem& problem) {
  struct Weighed {
    bool given;
    const char* name;
    const char* why;
  };
  const std::array<Weighed, 3> all = {{{problem.robust, "robust", "is about outliers among noisy rows"},
                                       {problem.prior.has_value(), "prior", "is weighed against noisy rows"},
                                       {problem.pose.has_value(), "pose", "is weighed against noisy rows"}}};
  for (const Weighed& one : all) {
    if (!one.given) continue;
    if (!problem.noise) refuse(fmt::format("`{}` {}: expected noise as well, found none", one.name, one.why));
    if (!problem.wheels.empty()) refuse(fmt::format("`{}` is not taken beside a wheel; leave it out", one.name));
  }
  if (problem.prior &&
      !(std::isfinite(problem.prior->s) && std::isfinite(problem.prior->sd) && problem.prior->sd > 0)) {
    refuse(fmt::format("expected a prior of a place and a standard deviation above 0, found {} and {}",
                       problem.prior->s, problem.prior->sd));
  }
  if (!problem.pose) return;
  const PosePrior& pose = *problem.pose;
  if (!(std::isfinite(pose.mean.heading) && pose.heading_sd > 0 && pose.place_sd > 0)) {
    refuse(fmt::format("expected a pose with standard deviations above 0, found {} of the heading and {} of the place",
                       pose.heading_sd, pose.place_sd));
  }
  const bool any_place =
      problem.noise->position > 0 && std::any_of(problem.logs.begin(), problem.logs.end(),
                                                 [](const Log& log) { return !log.fingers.front().x.empty(); });
  if (std::isfinite(pose.place_sd) && !any_place) {
    refuse(
        "a pose with x and y says something where the fingers' centres are evidence: expected logs with x and y and "
        "noise with position=SD; else give the heading alone");
  }
}

/// Kinds of noise that this problem takes; the contact's or the angle's is above 0.
void require_noise(const HoldProblem& problem) {
  const Noise& noise = *problem.noise;
  rollfix::require_valid(noise);
  require_kinds(noise, {&Noise::contact, &Noise::angle, &Noise::slip, &Noise::radius, &Noise::position},
                "three and more fingers");
  if (noise.contact <= 0 && noise.angle <= 0) {
    refuse(
        "expected a standard deviation of the contact or of the angle above 0, found neither; "
        "give noise with contact=SD,angle=SD");
  }
  if (noise.angle > BeliefOptions::kMostAngle) {
    refuse(fmt::format("expected an angle's standard deviation of at most {} rad, found {}; degrees are written {}deg",
                       BeliefOptions::kMostAngle, noise.angle, noise.angle));
  }
  if (!problem.at.empty()) refuse("with noise all rows are used, found instants to use; leave `at` out");
  if (problem.tolerance) refuse("`noise` already says how far rows are off, found `tolerance` as well; leave one out");
}

}  // namespace

/// Each test names what was expected, what was found, and where.
void require_valid(const HoldProblem& problem) {
  require_fingers(problem);
  for (const Log& log : problem.logs) require_log(log);
  require_wheels(problem);
  require_different(problem.logs);
  if (problem.noise) require_noise(problem);
  require_weighing(problem);
  if (!problem.tolerance) return;
  const TouchTolerance& given = *problem.tolerance;
  const bool is_valid =
      std::isfinite(given.length) && given.length >= 0 && std::isfinite(given.angle) && given.angle > 0;
  if (!is_valid) {
    refuse(fmt::format("expected a tolerance with an angle above 0 and a length of at least 0, found {} and {}",
                       given.angle, given.length));
  }
}

void require_clear(const HoldProblem& problem, const std::vector<Log>& logs) {
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const bool has_angles = !logs[k].fingers.front().psi.empty();  // a wheel without an encoder has none
    if (has_angles) rollfix::require_clear(logs[k], 0, shape_of(problem, k));
  }
}

}  // namespace rollfix::hold

namespace rollfix {

namespace {

constexpr std::array<std::pair<HoldCause, const char*>, 18> kHoldCauseNames = {
    {{HoldCause::noise, "noise"},
     {HoldCause::radius, "radius"},
     {HoldCause::unit, "unit"},
     {HoldCause::late, "late"},
     {HoldCause::mirrored, "mirrored"},
     {HoldCause::u_clockwise, "u_clockwise"},
     {HoldCause::psi_clockwise, "psi_clockwise"},
     {HoldCause::both_clockwise, "both_clockwise"},
     {HoldCause::u_degrees, "u_degrees"},
     {HoldCause::psi_degrees, "psi_degrees"},
     {HoldCause::angles_degrees, "angles_degrees"},
     {HoldCause::u_psi_swapped, "u_psi_swapped"},
     {HoldCause::fingers_swapped, "fingers_swapped"},
     {HoldCause::prior, "prior"},
     {HoldCause::stray, "stray"},
     {HoldCause::slip, "slip"},
     {HoldCause::x_y_swapped, "x_y_swapped"},
     {HoldCause::squeezed, "squeezed"}}};
static_assert(kHoldCauseNames.size() == static_cast<std::size_t>(HoldCause::squeezed) + 1, "each cause has a name");

}  // namespace

const char* name_of(HoldCause cause) {
  for (const auto& [one, name] : kHoldCauseNames) {
    if (one == cause) return name;
  }
  return "";
}

namespace hold {

/// One finger for all logs is number 0.
const Finger& finger_of_log(const HoldProblem& problem, std::size_t log) {
  return problem.fingers[problem.fingers.size() == 1 ? 0 : log];
}

Finger shape_of(const HoldProblem& problem, std::size_t number) {
  const std::size_t fingers = problem.logs.size();
  return number < fingers ? finger_of_log(problem, number) : disk(problem.wheels[number - fingers].radius);
}

std::size_t count_of_logs(const HoldProblem& problem) { return problem.logs.size() + problem.wheels.size(); }

const Log& log_of(const HoldProblem& problem, std::size_t number) {
  const std::size_t fingers = problem.logs.size();
  return number < fingers ? problem.logs[number] : problem.wheels[number - fingers].log.rows;
}

Log& log_of(HoldProblem& problem, std::size_t number) {
  const std::size_t fingers = problem.logs.size();
  return number < fingers ? problem.logs[number] : problem.wheels[number - fingers].log.rows;
}

HoldRoll roll_of(const HoldProblem& problem, const Log& log, std::size_t number) {
  const FingerRows& rows = log.fingers.front();
  const Finger finger = shape_of(problem, number);
  HoldRoll roll;
  roll.is_jaw = finger.is_jaw();
  roll.is_wheel = number >= problem.logs.size();
  // A wheel's psi is its encoder.
  roll.has_encoder = roll.is_wheel && !rows.psi.empty();
  if (!rows.psi.empty()) {
    roll.psi = {rows.psi.front(), rows.psi.back()};
    roll.u = {rows.u.front(), rows.u.back()};
  }
  roll.name = log.name;
  if (!rows.line.empty()) roll.lines = {rows.line.front(), rows.line.back()};
  roll.has_centre = !rows.x.empty();
  for (std::size_t row = 0; row < rows.x.size(); ++row) roll.track.emplace_back(rows.x[row], rows.y[row]);
  if (finger.is_disk()) roll.radius = finger.disk()->radius;
  return roll;
}

/// The logs, the fingers' shapes and a pose known beforehand, all mirrored at the y axis. `logs`: changed in place;
/// those inside the problem stay.
HoldProblem in_mirror(const HoldProblem& problem, std::vector<Log>& logs) {
  HoldProblem result = problem;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const Finger finger = shape_of(problem, k);
    mirror(logs[k].fingers.front(), &finger);
  }
  for (Finger& finger : result.fingers) finger = rollfix::mirrored(finger);
  if (result.pose) result.pose->mean = rollfix::mirrored(result.pose->mean);
  return result;
}

/// Poses back. Places s on the part stay.
void out_of_mirror(HoldAnswer& answer) {
  for (HoldPlacement& placement : answer.placements) {
    for (Pose* pose : {&placement.first, &placement.last}) *pose = rollfix::mirrored(*pose);
    for (PoseSpread* spread : {&placement.first_spread, &placement.last_spread}) *spread = rollfix::mirrored(*spread);
  }
}

}  // namespace hold

}  // namespace rollfix
