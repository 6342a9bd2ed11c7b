#pragma once

// The search alone: from readings to all placements, with what the library promises about them.
//
//     const Part part = load_part("gallery:ellipse,a=2,b=1");
//     const Search found = locate(part, Reading(1.0, 0.5));
//     found.status == Status::complete;  // true
//     found.placements.size();           // 4
//     found.placements[0].residual < 1e-9;  // true
//
// Laws, which tests/laws_test.cpp checks on random parts by these numbers:
//   (1) The start that made the readings is among the placements.
//   (2) To move or turn the part changes no placement.
//   (3) To scale the part by c, and all lengths, scales every place by c.
//   (4) To mirror the part, and to reverse the readings, mirrors every place.
//   (5) The direction in which a closed outline was drawn changes nothing.
//   (6) Other parameters of the same curves change nothing; neither does cutting them.
//   (7) Another first point shifts every place by as much.
//   (8) The order of the readings does not matter.
//   (9) To swap two fingers swaps their places.
//   (10) The roll backwards starts where the roll ended.
//   (11) One more reading of the same roll leaves only placements that were there before.
//
// Degenerate cases, by Kind: `touching` is a double root or a near miss, whose `error` is infinite and whose `extent`
// says how far; `stretch` a continuum, as on a circle; `corner` a pivot at a convex corner.
//
// Accuracy (docs/search.md, "ACCURACY"):
//   a simple root      |start - root| <= error, the larger of 1e-9 P and 4e-12 rad / |kappa(t) - kappa(s)|
//   an extent's end    1e-9 P, or where f is nearly straight 2e-3 of its width
//   Theta(s)           1e-12 rad

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/turning_function.hpp"

// What a search says. Names are those of the JSON document; what is of a finger has an entry for each.
namespace rollfix {

/// What a search promises.
enum class Status {
  complete,   // every placement is listed, and there is no other
  incomplete  // the budget ran out or something could not be decided: `unresolved` says where
};
const char* name_of(Status status);

/// How a placement answers, in terms of f_k(s) = Theta(s + L_k) - Theta(s) - theta_k, of two fingers
/// f_k(s, t) = Phi(s, s + La_k) - Phi(t, t + Lb_k) - theta_k.
enum class Kind {
  crossing,  // f changes sign
  touching,  // f does not: a double root, a kink, or a near miss within the tolerance
  stretch,   // f = 0 to 1e-12 rad on an interval: a continuum of answers
  corner     // decided by the pivot at a convex corner
};
const char* name_of(Kind kind);

/// With noise a place, a pose or a part of this probability is the only one, `unique`; ...
inline constexpr double kSureProbability = 0.95;
/// ... and one of less than this does not count among those that remain.
inline constexpr double kLeastProbability = 0.01;

/// What all placements together come to.
struct Verdict {
  enum Name {
    unique,        // one place
    ambiguous,     // several, or a stretch
    unobservable,  // all the way round a boundary fits: no such roll can tell
    inconsistent,  // nothing fits
    undecided      // the search is incomplete; with noise more than 5 % of the probability is unresolved
  };
  Name name = undecided;
  std::size_t places = 0;     // of ambiguous: that remain, and ...
  std::size_t stretches = 0;  // ... how many of them are continua
  bool fits_badly = false;    // with noise: the rows are off more than it allows, or not independently

  /// "unique", "ambiguous (4)", "ambiguous (1 stretch)", "ambiguous (3, of them 1 stretch)", ...; where they fit badly
  /// "unique, but the rows fit badly" and so on; "inconsistent" says that itself.
  std::string text() const;

  bool operator==(const Verdict& other) const = default;

 private:
  std::string places_text() const;
};

/// How a placement's first contacts move when a reading does. Empty where that is undefined; NaN where it is for one.
/// Of two fingers with J the rows [kappa(s_k) - kappa(s0), -(kappa(t_k) - kappa(t0))]; least squares when there are
/// more readings than unknowns.
struct Sensitivity {
  PerFinger<ShortList<double>> per_turn;               // [finger][reading], length per radian
  PerFinger<ShortList<PerFinger<double>>> per_length;  // [finger][reading][which finger's length], dimensionless
  PerFinger<double> per_facing;                        // [finger], length per radian of the facing
};

/// Where the tangent may point at the two ends of a roll that starts or ends at a convex corner.
struct Pivot {
  Interval start;  // Theta at the first contact, radians, unwrapped
  Interval end;    // Theta at the last one
};

/// How badly what the fingers measured fits a part in its poses, at worst.
struct PoseResidual {
  double length = 0;  // how far contacts in the world are from where the part has them
  double turn = 0;    // radians: how far the headings are apart that the contacts' normals ask for
};

/// Where a connected set of first contacts is on which every |f_k| is within the tolerance.
struct PlaceFound {
  Kind kind = Kind::crossing;
  PerFinger<double> start;     // s of the first contact, in [0, P): the first root, else where the residual is least;
                               // with noise as of a Mode: where the density is largest
  PerFinger<double> end;       // s of the last contact, in [0, P)
  PerFinger<Interval> extent;  // around the connected set: lo in [0, P), hi may exceed P; a loop is [0, P]
  PerFinger<bool> whole_loop;  // the extent is all of a closed boundary
  ShortList<PerFinger<double>> roots;  // every exact root in it, in [0, P); of a stretch the first of its continuum
  double error = 0;                    // bound on |start - true root|, length; infinite where it is not simple
  double residual = 0;                 // largest |f_k(start)|, radians, the facing equation's included
  PerFinger<Vec2> point{Vec2(Vec2::Zero())};  // positions of the first contacts
  PerFinger<double> tangent;                  // directions of the tangents there, radians, in (-pi, pi]
  Sensitivity sensitivity;
  std::optional<PerFinger<Pivot>> pivot;  // of a corner
  std::vector<PerFinger<double>> family;  // of two fingers' stretch: a line of pairs that runs through all of it,
                                          // unwrapped; it may go over parts of itself again where branches meet
  double family_error = 0;                // no pair of the stretch is further from that line, length
  bool clockwise = false;                 // of Problem::either_way: for lengths that count clockwise
};

/// What all samples together say of a place, where noise is stated.
struct PlaceWeight {
  double probability = std::numeric_limits<double>::quiet_NaN();  // of the first contacts being in here; NaN: no noise
  PerFinger<double> mean;                                         // of them, given that they are in here; in [0, P)
  PerFinger<double> sd;                                           // length
  Mat2 covariance = Mat2::Zero();                                 // of two fingers, length^2
  PerFinger<Interval> interval;  // holds 95 % of this placement's probability; lo in [0, P), hi may exceed P
  PerFinger<double> end_mean;    // of where the contacts are now, in [0, P)
  PerFinger<double> end_sd;
};

/// What a log that has the fingers' orientation and place in the world says besides.
struct PlacePoses {
  std::vector<Pose> pose;                     // the part's, at each row
  std::optional<PoseResidual> pose_residual;  // over all rows
  bool is_contradicted = false;           // without noise: by other rows of the log, or by the contacts in the world
  std::optional<PoseSpread> pose_spread;  // with noise: at the first contacts
};

/// One answer: a connected set of first contacts, how probable it is, and where the part is then.
struct Placement : PlaceFound, PlaceWeight, PlacePoses {
  /// Whether the first contacts can have been at s, across s = 0 as anywhere else: of each finger in `interval` with
  /// noise, else in `extent`, both with their ends and rounding. Any s that names a place of a closed boundary does.
  bool contains(const Boundary& boundary, const PerFinger<double>& s) const;
};

/// The work that a search did.
struct SearchCounts {
  std::size_t intervals = 0;    // looked at; of two fingers boxes
  std::size_t evaluations = 0;  // of the turning function
};

/// What these placements come to. One that the rows of a log contradict does not count.
Verdict verdict_of(Status status, const std::vector<Placement>& placements);

/// What a search found.
struct Search {
  Status status = Status::complete;
  std::vector<Placement> placements;            // ordered by start
  std::vector<PerFinger<Interval>> unresolved;  // where a placement may be that is not listed
  SearchCounts counts;

  Verdict verdict() const { return verdict_of(status, placements); }
};

/// The least tolerance that is used, radians: |f| at a root, up to four tangents each with its rounding. Below it,
/// whether a root of one reading fits another would be decided by rounding.
inline constexpr double kLeastTolerance = 4e-12;

struct LocateOptions {
  double tolerance = 1e-9;       // radians: how far |f_k| may be from 0; at least kLeastTolerance is used
  std::size_t budget = 1000000;  // intervals (of two fingers boxes) to look at, beyond the part's own, before giving up
  // Of two fingers, the facing equation: Theta(s0) - Theta(t0) = facing mod 2 pi, facing = (u + psi)_a - (u + psi)_b.
  std::optional<double> facing{};
};

/// Every place on the part where a roll can have started, given one reading or several of the same roll, all measured
/// from the same first contacts. One finger on a part at rest: eqs. (4) and (5), by branch and prune on spirals. Two on
/// a part that is free to move: eqs. (8) and (9), by branch and prune on pairs of spirals; two readings are the least
/// without the facing equation, one with it. See docs/search.md.
/// Throws InputError: too few readings, readings of one finger and of two, a number that is not finite, a roll longer
/// than an open curve or than a million laps of a closed one, a facing of one finger or beyond 1e6 rad.
Search locate(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options = {});
Search locate(const Part& part, const Reading& reading, const LocateOptions& options = {});

/// Why a finger can't go on.
struct Obstruction {
  double s = 0;                 // where the contact is when it can't, in [0, P)
  bool concave_corner = false;  // it would have to roll over a concave corner there; else it would ...
  Hit hit;                      // ... enter the part: the deepest that it comes to
};

/// A placement that the readings allow and the fingers do not: one of them leaves its reach, or they overlap.
struct Impossible {
  enum class Reason { reach, overlap };
  Placement placement;
  Reason reason = Reason::reach;
  std::size_t finger = 0;   // the one that leaves its reach, and ...
  Obstruction obstruction;  // ... where
  std::size_t instant = 0;  // when they overlap: 0 at the first contacts, then the readings, then the rows ...
  double depth = 0;         // ... and by how much there, length, from the placement's own start
};

/// Can a finger that first touches somewhere in `starts` roll over all of `roll` (lo <= 0 <= hi, from the first
/// contact) within its reach? Never no where it is yes: what is rounded counts as within reach.
bool can_roll(const Reach& reach, const Interval& starts, const Interval& roll);

/// Where a roll from s leaves the reach; nothing when it does not.
std::optional<Obstruction> obstruction_of(const Part& part, const Reach& reach, double s, const Interval& roll);

/// Takes the placements out of a list that no roll within reach can have: all of their extent is impossible.
/// `reach`: of each finger. `readings`: what was searched with; `more`: other instants of the same roll, of a log all
/// its rows. The contact has been everywhere in between. `length_error`: how far a length may be off, so that a finger
/// that rolled until it met something is not taken to have gone further, nor one beside a corner to have pivoted. Two
/// disks overlap where their centres are closer together than their radii (less the larger slack), a disk and a jaw
/// where the disk is beyond the jaw's line, which has no ends; looked at where both are at the same instant: at the
/// first contacts and at each of the others. Jaws are not compared with each other, nor are fingers at different
/// heights, which `may_overlap`.
std::vector<Impossible> drop_unreachable(const Part& part, const PerFinger<Reach>& reach,
                                         const std::vector<Reading>& readings, std::vector<Placement>& placements,
                                         const std::vector<Reading>& more = {}, double length_error = 0,
                                         bool may_overlap = false);

}  // namespace rollfix
