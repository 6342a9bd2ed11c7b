#pragma once

// Several fingers that hold and roll on a part that moves: docs/two_fingers.md, "Three and more fingers"; a finger with
// skin beside a wheel without: docs/rig.md.
//
//     HoldProblem problem{load_part("gallery:cam")};
//     problem.logs = {read_log("examples/rig-jaw.csv")};
//     problem.fingers = {jaw()};
//     problem.wheels = {{read_pin_log("examples/rig-pin.csv"), 0.4}};
//     problem.noise = Noise{.contact = 0.01, .angle = 0.005, .position = 0.01};
//     solve(problem).verdict_text();  // "unique"
//
// Degenerate cases: fingers on parallel sides leave a continuum; logs in which nothing moves tell what touches at one
// instant would.
//
// Accuracy: docs/rig.md and docs/two_fingers.md have how often the true places are listed, and in their intervals.

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/touch.hpp"

namespace rollfix {

/// A wheel without skin that turns freely on a pin, and rolls on the part beside fingers with skin. That it touches,
/// and enters the part nowhere, is what its log says.
struct PassiveWheel {
  PinLog log;         // row k at the same instant as row k of the fingers' logs
  double radius = 0;  // r > 0, in the outline's unit
};

/// What several fingers measured while they all touched one part that is free to move. At least two of them, wheels
/// included, and one of them with skin; beside wheels a finger's log needs x and y, and noise `position`.
struct HoldProblem {
  Part part;
  std::vector<Log> logs;         // one of each finger with skin; of u and psi, row k of all at the same instant
  std::vector<Finger> fingers;   // one that holds for all, or one for each log
  std::optional<Noise> noise{};  // contact, angle, slip, radius; with `position` x and y are evidence
  std::optional<TouchTolerance> tolerance{};  // without noise; none: from the digits of the logs
  std::vector<double> at{};                   // instants to search with besides the first, seconds; none: kHoldInstants
  std::optional<std::size_t> budget{};        // comparisons before giving up; none: kHoldBudget
  bool mirrored = false;                      // the part lies face down
  std::vector<PassiveWheel> wheels{};         // without skin
  std::optional<double> squeezed{};  // one finger and one wheel: the part is squeezed between both, and friction
                                     // of the floor and of the pin are small: the wheel's normal points
                                     // through the finger's contact, to this standard deviation, radians;
                                     // without noise to this tolerance
  bool may_overlap = false;          // at different heights fingers and wheels pass one another
  // Of fingers with skin alone:
  bool robust = false;              // with noise: stray measurements don't count
  std::optional<Prior> prior{};     // with noise: about where finger a started
  std::optional<PosePrior> pose{};  // with noise: about how the part lay at the first contacts; x and y of it only
                                    // where noise `position` makes centres evidence
  bool diagnose = true;             // where nothing fits, or fits badly, the usual mistakes are tried
};

/// Instants to search with where none are chosen, spread evenly over the logs.
inline constexpr std::size_t kHoldInstants = 9;
/// Comparisons of places of all fingers at one instant: a few seconds.
inline constexpr std::size_t kHoldBudget = 20000000;

/// Where one finger, or wheel, is in an answer.
struct HoldContact {
  double start = 0;           // s of the first contact, in [0, P)
  double end = 0;             // s of the last one: at the last row, with `at` at the last of these instants
  Interval extent{};          // no first contact of the set is outside; lo in [0, P), hi may exceed P
  Vec2 point = Vec2::Zero();  // of the first contact, in the part's frame
  double tangent = 0;         // direction of the tangent there, in the part's frame, radians, in (-pi, pi]
  double distance = 0;        // residual: how far the contact is from the boundary in these poses, length, at worst
  double turn = 0;            // residual of the normal, radians, at worst; of a wheel that of its encoder

  // With noise.
  double mean = 0;      // of the first contact, in [0, P)
  double sd = 0;        // length
  Interval interval{};  // holds 95 % of its probability; lo in [0, P), hi may exceed P
  double end_mean = 0;
  double end_sd = 0;
  double length_scale = 1;     // lengths are so many times what was measured, as far as noise `slip` or `radius` ...
  double length_scale_sd = 0;  // ... leaves that open, give or take; of a wheel its radius, as of what was said
};

/// One answer: a connected set of first contacts, with a pose of the part at each instant.
struct HoldPlacement {
  std::vector<HoldContact> contacts;  // of each finger, then of each wheel, those that fit best
  Pose first{};                       // of the part at the first contacts, ...
  Pose last{};                        // ... and at the last ones; without x and y only the heading is known
  PoseResidual residual{};            // the largest of the contacts'
  double worst = 0;                   // the largest residual as a share of its tolerance, at most 1
  bool continuum = false;             // the measurements leave the first contacts free to slide
  double chi_square = 0;              // of all rows, with noise

  // With noise.
  double probability = std::numeric_limits<double>::quiet_NaN();
  PoseSpread first_spread{};
  PoseSpread last_spread{};
};

/// A usual mistake.
enum class HoldCause {
  noise,            // the measurements are noisier than said
  radius,           // lengths are off by one factor: the radius, or slip all along
  unit,             // x and y are in another unit
  late,             // one log's rows are of other instants than the others'
  mirrored,         // the part lies the other way up
  u_clockwise,      // u is counted clockwise, ...
  psi_clockwise,    // ... psi is
  both_clockwise,   // ... both are
  u_degrees,        // u is in degrees, ...
  psi_degrees,      // ... psi is
  angles_degrees,   // ... both are
  u_psi_swapped,    // u was taken for psi, and psi for u
  fingers_swapped,  // two fingers were given in the wrong order, or their logs were
  prior,            // what was said of the first contact, or of the pose, beforehand
  stray,            // a few measurements are anything
  slip,             // lengths are off here and there
  x_y_swapped,      // x was taken for y, and y for x; u and psi were not
  squeezed          // the part is not squeezed, or not as well as said
};
const char* name_of(HoldCause cause);

/// A mistake that would explain logs that fit nowhere, or contradict the noise; and the answer without it.
struct HoldDiagnosis {
  HoldCause cause = HoldCause::noise;
  std::optional<std::size_t> finger{};  // whose log, or radius, alone is wrong, from 0, wheels last; none: of all
  std::optional<std::size_t> other{};   // fingers swapped: with this one
  double factor = 1;       // radius: lengths are this many times what was measured; unit: by which x and y are to be
                           // multiplied; noise: this many times what was said
  double factor_sd = 0;    // radius: give or take
  std::string unit{};      // unit: the one that x and y seem to be in, and ...
  std::string into{};      // ... that of the part, both as guessed
  int rows = 0;            // late: row k + this of this log belongs to row k of the others
  std::size_t strays = 0;  // stray: measurements
  Noise noise{};           // with which that was found
  double log_odds = 0;     // of it against logs without mistake that are as noisy as they seem
  TouchFit fit{};          // without the mistake
  Verdict verdict{};       // likewise, as are these:
  std::vector<HoldPlacement> placements{};  // the most probable first
};

/// What the log of one finger, or wheel, says.
struct HoldRoll {
  std::string name{};
  std::vector<std::size_t> lines{};  // of the file: its first and its last row; of simulated rows none
  double length = 0;                 // that the contact travelled by the last instant, along the stored outline
  bool has_centre = false;           // x and y
  std::vector<Vec2> track{};         // then: of the finger's centre, in the world
  double radius = 0;                 // of a disk or a wheel, else 0
  bool is_jaw = false;
  bool is_wheel = false;        // without skin: `length` is 0, it was not measured
  bool has_encoder = false;     // of a wheel
  std::array<double, 2> psi{};  // of a finger with skin: its orientation at the first and at the last row
  std::array<double, 2> u{};    // likewise where it touched
};

/// Every set of first contacts that fits.
struct HoldAnswer {
  Part part;
  std::vector<HoldRoll> rolls;  // of the fingers, then of the wheels
  std::size_t rows = 0;
  std::vector<double> instants{};  // that were searched with, seconds, or of logs without times row numbers from 0
  std::optional<Noise> noise{};
  TouchTolerance tolerance{};  // without noise; the largest of all fingers'
  std::optional<double> squeezed{};
  bool mirrored = false;  // poses are of the part face down: x = -x of the outline, then the pose
  PlaceKnown place = PlaceKnown::measured;
  Status status = Status::complete;
  Verdict verdict{};
  std::vector<HoldPlacement> placements{};  // with noise the most probable first, else by the first finger's start
  std::size_t improbable = 0;               // with noise: sets within the tolerance that are not listed, ...
  double rest = 0;                          // ... and their probability together
  std::vector<std::vector<Interval>> unresolved{};  // if incomplete: arcs, one of each finger, on which the first
                                                    // contacts of a placement that is not listed may be
  std::optional<TouchFit> fit{};                    // with noise, of the best placement
  double log_evidence = 0;                          // with noise: of all measurements, but for a constant
  std::size_t overlap = 0;                          // sets that fit but for fingers that would enter each other
  bool robust = false;                              // as in the problem
  std::size_t strays = 0;                           // robust: measurements of the best placement that do not count, ...
  std::vector<std::string> jumps{};  // ... besides rows that jump away, which were left out: "b.csv, line 17"
  std::optional<Prior> prior{};      // as in the problem
  std::optional<PosePrior> pose{};
  double prior_p = 1;                      // probability that the best placement is as far from both, together
  std::vector<HoldDiagnosis> diagnoses{};  // where nothing fits, or fits badly: what explains it, the likeliest first
  bool was_diagnosed = false;              // whether that was looked for

  /// Whether the rows contradict the noise, or what was known beforehand.
  bool is_contradicted() const { return (fit && fit->is_bad()) || prior_p < TouchFit::kLeastP; }
  std::size_t comparisons = 0;

  /// "unique", "ambiguous (2)", "unique, but the measurements contradict the stated noise", ...
  std::string verdict_text() const;
};

/// Every set of first contacts from which all fingers can have rolled as their logs say, while the part moved as it
/// would: complete, by branch and prune over the first contacts of all fingers. Each instant has its own pose of the
/// part; contacts travel as their logs say. Places where a disk would enter the part are left out, and those where
/// fingers would enter each other. With noise also the posterior, from all rows, if contacts are as likely anywhere on
/// the boundary. Throws InputError: fewer than two logs, logs without u and psi or with different instants, fingers
/// that are missing, fingers and wheels that enter each other by their own x and y, wheels beside logs without x and y,
/// a wheel that fits nowhere, kinds of noise that it can't take, and what `read_log` of two files throws.
HoldAnswer solve(const HoldProblem& problem);

}  // namespace rollfix
