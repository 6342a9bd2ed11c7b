#pragma once

// From contacts that share a pose, touches without rolling and rolls, to every pose of the part: docs/touch.md.
//
//     TouchProblem problem{load_part("gallery:ellipse,a=2,b=1")};
//     problem.touches = {{{2, 0}, 0.0}, {{0, 1}, std::numbers::pi / 2}};  // place, direction out of the part
//     problem.tolerance = TouchTolerance{1e-6, 1e-6};
//     const TouchAnswer answer = solve(problem);
//     answer.verdict_text();  // "ambiguous (2)"
//
// Degenerate cases: one touch alone is `unobservable`; touches on one straight side, or on a circle, leave a continuum,
// of which `extent` says where it lies; a part with m-fold symmetry has m poses.
//
// Accuracy: docs/touch.md has the share of simulated questions whose true pose is listed and in its intervals.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

/// One contact without rolling, in the world: a probe's ball, or a round finger.
struct MeasuredTouch {
  Vec2 at = Vec2::Zero();               // the finger's centre, in the outline's unit; of a point the contact itself;
                                        // NaN: it was not measured, and the normal alone counts
  std::optional<double> normal{};       // direction out of the part, radians; none: it was not measured
  std::optional<double> position_sd{};  // of each coordinate of `at`, length; none: TouchProblem::noise has it
  std::optional<double> normal_sd{};    // radians; likewise

  bool has_place() const { return !at.hasNaN(); }
};

/// Where the finger's centre went straight through the world and felt nothing. It may be off as a touch's place may.
struct Clear {
  Vec2 from = Vec2::Zero();
  Vec2 to = Vec2::Zero();
};

/// How far a measurement may be off, where no noise is stated.
struct TouchTolerance {
  double length = 0;  // distance of a finger's centre from where the part allows it, above 0
  double angle = 0;   // of a normal, radians; above 0 where a touch has one. Of rolls: of their readings, as of one
                      // roll, and of the headings of two rolls from one another
};

/// With noise, a pose is a candidate where every measurement is within so many standard deviations. The true pose is
/// beyond it once in 25,000 touches.
inline constexpr double kPossibleSigmas = 4.5;

/// Touches and rolls on one part at rest, with one finger that is lifted in between.
struct TouchProblem {
  Part part;
  std::vector<MeasuredTouch> touches;
  std::optional<Finger> finger{};             // of touches a disk; none: a point, which does not roll
  std::optional<Noise> noise{};               // of touches `position` and `angle`: standard deviations; none needed
                                              // where touches have theirs
  std::optional<TouchTolerance> tolerance{};  // without noise; of rolls alone none: from the digits of their logs
  std::optional<PosePrior> pose{};            // with noise: about how the part lies
  std::optional<std::size_t> budget{};        // comparisons before giving up; none: kTouchBudget
  bool mirrored = false;                      // the part lies face down
  bool diagnose = true;                       // if the touches contradict the noise, the usual mistakes are tried
  std::vector<Log> rolls{};                   // each of u and psi; with x and y they tell where the part is as well:
                                              // with noise where `position` is stated. Of one row: a touch of a finger
                                              // with skin
  bool robust = false;                        // with noise: any touch, and any row of a roll, may be an outlier
  std::vector<Clear> clear{};                 // where nothing was felt: poses in which the part is in the way go
};

/// Whether each touch has its own standard deviations, so that they need no others.
bool have_own_noise(const std::vector<MeasuredTouch>& touches);

/// Comparisons of two stretches of the boundary: a second or two.
inline constexpr std::size_t kTouchBudget = 200000000;

/// Where a contact is on the part, in one pose; of a roll its first contact.
struct TouchContact {
  double s = 0;                 // of the contact, in [0, P)
  Vec2 point = Vec2::Zero();    // of it, in the part's frame
  double tangent = 0;           // its direction there in the part's frame, radians, in (-pi, pi]; at a corner a pivot's
  double distance = 0;          // residual: from the finger's centre to where this pose has it, length
  std::optional<double> turn;   // residual: measured normal less that of the part, radians
  std::optional<double> end{};  // of a roll: s of its last contact, in [0, P)
  std::optional<Interval> extent{};  // of a roll: the arc around s where it can have started by itself; lo in [0, P),
                                     // hi may exceed P
};

/// One of the normal distributions that a number's density is a sum of.
struct MixtureTerm {
  double weight = 0;  // of all of a density 1
  double mean = 0;
  double sd = 0;
};

/// One answer: a connected set of poses, all of which fit.
struct TouchPose {
  Pose pose;                           // that fits best
  std::vector<TouchContact> contacts;  // in that pose: one for each roll, then one for each touch
  PoseResidual residual;               // the largest of theirs
  double worst = 0;                    // the largest residual as a share of its tolerance, at most 1
  bool continuum = false;              // the touches leave the part free to slide or to turn: `pose` is one of many
  bool any_heading = false;            // the heading can be anything, as of a disk
  std::array<Interval, 3> extent{};    // x, y, heading: no pose of the set is outside; heading unwrapped
  double chi_square = 0;               // of all residuals, in units of their standard deviations or tolerances

  // With noise.
  double probability = std::numeric_limits<double>::quiet_NaN();  // of the part's pose being in this set
  PoseSpread spread{};                                            // mean and covariance, given that it is
  std::array<Interval, 3> interval{};                 // x, y, heading: each holds 95 % of this set's probability
  std::array<std::vector<MixtureTerm>, 3> density{};  // of each, given that it is; heading unwrapped as `interval`
  std::vector<std::size_t> outliers{};                // robust: touches that most probably say nothing then, ascending

  /// What to go by: with noise the mean, about which the intervals lie; without, and of a continuum, the pose that fits
  /// best.
  const Pose& estimate() const { return std::isnan(probability) || continuum || any_heading ? pose : spread.mean; }
};

/// How well the best pose fits the stated noise.
struct TouchFit {
  double chi_square = 0;
  int freedom = 0;  // as much is to be expected of it; 0: the touches can't contradict each other
  double p = 1;     // probability of a chi-square at least as large

  /// Below this p the touches contradict the stated noise.
  static constexpr double kLeastP = 1e-3;
  bool is_bad() const { return freedom > 0 && p < kLeastP; }
};

/// A usual mistake.
enum class TouchCause {
  unit,              // the touches are in another unit: `factor`
  outlier,           // one touch is wrong: `touch`
  radius,            // the finger has another radius: `radius`
  normals_reversed,  // normals point into the part
  normals_clockwise,
  mirrored,    // the part lies face down, or its image was measured
  swapped,     // x and y are swapped, normals are not
  other_side,  // an open outline is touched on its left side
  pose,        // what is known of the pose beforehand is wrong
  clear,       // the part is in the way of a path on which nothing was said to be felt
  moved,       // the part was moved after a roll: `roll`
  noise        // the noise is larger than stated: `factor`
};
const char* name_of(TouchCause cause);

/// A mistake that would explain touches that fit nowhere, or contradict the noise.
struct TouchDiagnosis {
  TouchCause cause = TouchCause::noise;
  double factor = 1;      // unit: by which the touches' coordinates are to be multiplied; noise: how many times
  std::string unit{};     // unit: the one that the touches seem to be in, and ...
  std::string into{};     // ... that of the part, both as guessed
  std::size_t touch = 0;  // outlier: its number, from 0
  double radius = 0;      // radius: the one that fits
  std::size_t roll = 0;   // moved: the last roll before it, from 0
  TouchFit fit{};         // without the mistake
  std::size_t poses = 0;  // that remain without it
  Pose pose{};            // the likeliest of them
};

/// What tells where the part is.
enum class PlaceKnown {
  measured,   // the finger's centre, where it is evidence
  reference,  // the centre at the first contact of the first roll alone: with noise that has no `position`
  unknown     // nothing: the rolls have no x and y, and only the heading of a pose means anything
};

/// What a search takes of a roll: its first contact, and the readings that tell where it can have been.
struct RollSearched {
  double normal = 0;                // out of the part at the first contact, in the world, radians
  std::optional<Vec2> at{};         // where a disk's centre was then, of another finger the contact; none: not known
  std::vector<Reading> readings{};  // along the outline as it is stored, whichever side of the part is up
  double tolerance = 0;             // of their turns, radians
};

/// A roll by itself.
struct RollFacts {
  std::string name{};                // of its log
  std::vector<std::size_t> lines{};  // of the file: its first and its last row; of simulated rows none
  std::size_t rows = 0;
  Reading reading{};           // of its last row, in the direction in which the part is stored
  bool has_centre = false;     // its log has x and y
  std::vector<Vec2> track{};   // then: the finger's centres, in the world
  Verdict alone{};             // without the other contacts
  std::size_t placements = 0;  // likewise: where it can have started; of a roll of one row none is listed
  RollSearched searched{};
};

/// Every pose of the part that fits the touches and the rolls.
struct TouchAnswer {
  Part part;
  std::vector<MeasuredTouch> touches;
  std::vector<Clear> clear{};
  double radius = 0;  // of the finger; 0: a point
  std::optional<Noise> noise{};
  std::optional<PosePrior> pose{};          // that was given
  std::vector<TouchTolerance> tolerance{};  // that was searched with, for each contact
  bool mirrored = false;                    // poses are of the part face down: x = -x of the outline, then the pose
  Status status = Status::complete;
  Verdict verdict{};
  std::vector<TouchPose> poses{};      // with noise the most probable first, else by heading
  std::size_t improbable = 0;          // with noise: sets of poses within the tolerance that are not listed, ...
  double rest = 0;                     // ... and their probability together
  std::vector<Interval> unresolved{};  // if incomplete: arcs of the boundary on which the first touch of a pose that
                                       // is not listed may be; lo in [0, P), hi may exceed P
  std::size_t unresolved_touch = 0;    // which contact they are of: rolls are the first ones
  std::optional<TouchFit> fit{};       // with noise, if a pose fits
  /// With noise: logarithm of the likelihood of all touches and of all rows of rolls, averaged over all poses and over
  /// contacts (of rolls the first ones) that are anywhere on the boundary alike, up to what does not depend on the
  /// part. NaN: not known.
  double log_evidence = std::numeric_limits<double>::quiet_NaN();
  std::vector<TouchDiagnosis> diagnoses{};  // what explains touches that do not fit, the likeliest first
  std::size_t comparisons = 0;
  std::vector<RollFacts> rolls{};
  PlaceKnown place = PlaceKnown::measured;
  bool robust = false;            // as in the problem, and then: ...
  std::vector<double> outlier{};  // ... probability of each touch to be an outlier, ...
  double anywhere = 0;            // ... and that so few contacts count that the pose is open

  std::size_t contact_count() const { return rolls.size() + touches.size(); }
  /// "unique", "ambiguous (2)", "unique, but the touches contradict the stated noise", ...
  std::string verdict_text() const;
};

/// Every pose of a part at rest that fits touches of one finger, and its rolls: complete, by branch and prune over the
/// places of two contacts on the boundary, of a roll over those that its readings leave. Places where a disk would
/// enter the part elsewhere are left out. With noise also the posterior, if contacts are as likely anywhere on the
/// boundary. If it is robust, a touch is an outlier, which says nothing, with probability 2 %: of each set of touches
/// that may be outliers all poses that fit the others, added up. One touch, without `pose` and its place, leaves a
/// continuum: the verdict is `unobservable` and no pose is listed. One roll is what `solve` of a Problem makes of it.
/// Throws InputError: no contact, none that has a place beside touches, a number that is not finite, a finger that is
/// no disk for a touch, noise without `position` for a touch (or without `angle` where it has a normal), neither noise
/// nor tolerance for a touch, a roll without u and psi or without a finger, and what `solve` of a Problem throws of
/// each roll.
TouchAnswer solve(const TouchProblem& problem);

/// How to read a table of touches.
struct TouchTableOptions {
  /// What the header calls columns that it does not have under their known names; of parse_touch_columns.
  std::vector<ColumnSource> columns{};
  std::string unit{};  // the part's: columns with a unit of length are converted to it; empty: not known
  std::optional<bool> decimal_comma{};  // as of a log
  bool may_be_empty = false;            // a table that grows: there may be no touch in it yet
};

/// Touches from a file, with the lines that they stand in.
struct TouchTable {
  std::vector<MeasuredTouch> touches;
  std::vector<std::size_t> lines;
  std::vector<Clear> clear{};        // between rows of which at least one has contact 0
  std::vector<std::string> notes{};  // what was left out, or taken for granted
};

/// "x=px:mm,y=py:mm,normal=n:deg": COLUMN=NAME or COLUMN=NAME:UNIT, any number of them. Throws InputError: not of this
/// form, a column that is not known or there twice, a unit that is not the column's.
std::vector<ColumnSource> parse_touch_columns(std::string_view text);

/// Whether "COLUMN=NAME,..." names a column that only touches have, such as normal.
bool names_touch_columns(std::string_view text);

/// Whether a text, or its beginning, is a table of touches: a probe's report, see parse_touches; or a header with x and
/// y, nothing of a roll (u, psi, length, turn, ...), and no name that sounds like it, unless there is another one of
/// touches as well, such as normal.
bool is_touch_table(std::string_view text, const TouchTableOptions& options = {});

/// A touch in each row: columns x and y, and if there normal, position_sd, normal_sd and contact (0: not a touch), in
/// any order, in capitals or not; others are ignored. Bare angles are radians, "73deg" degrees; a header may name a
/// unit, as in "x [mm]", "x_mm" or "normal [deg]". An empty normal or sd: not measured, not known.
/// Also the places that a probe leaves: lines with GRBL's [PRB:x,y,z:1], and rows of nine numbers without a header, as
/// LinuxCNC writes them between PROBEOPEN and PROBECLOSE.
/// `name`: of the file, for messages. Throws InputError, naming the line: no such columns, a cell that is no number, no
/// row.
TouchTable parse_touches(std::string_view text, const std::string& name, const TouchTableOptions& options = {});

/// What a part does that touches on parallel straight sides leave free.
struct Slide {
  double direction = 0;  // along the sides, in the world, radians, in (-pi/2, pi/2]
  double length = 0;     // no two poses of the set are further apart; with noise, of its 95 % intervals
};

/// How a part slides from one pose of a continuum to another; none if it does not, or turns as well.
std::optional<Slide> slide_of(const TouchAnswer& answer, const TouchPose& pose);

}  // namespace rollfix
