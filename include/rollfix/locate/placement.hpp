#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/contact/reading.hpp"
#include "rollfix/outline/curve.hpp"
#include "rollfix/part/boundary.hpp"
#include "rollfix/per_finger.hpp"

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

/// What all placements together come to.
struct Verdict {
  enum Name {
    unique,        // one place
    ambiguous,     // several, or a stretch
    unobservable,  // all the way round a boundary fits: no such roll can tell
    inconsistent,  // nothing fits
    undecided      // the search is incomplete
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

/// How badly what the fingers felt fits a part in its poses, at worst.
struct PoseResidual {
  double length = 0;  // how far contacts in the world are from where the part has them
  double turn = 0;    // radians: how far the headings are apart that the contacts' normals ask for
};

/// One answer: a connected set of first contacts on which every |f_k| is within the tolerance.
struct Placement {
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

  bool clockwise = false;  // of Problem::either_way: for lengths that count clockwise

  // With noise: what all samples together say of it.
  double probability = std::numeric_limits<double>::quiet_NaN();  // of the first contacts being in here; NaN: no noise
  PerFinger<double> mean;                                         // of them, given that they are in here; in [0, P)
  PerFinger<double> sd;                                           // length
  Mat2 covariance = Mat2::Zero();                                 // of two fingers, length^2
  PerFinger<Interval> interval;  // holds 95 % of this placement's probability; lo in [0, P), hi may exceed P
  PerFinger<double> end_mean;    // of where the contacts are now, in [0, P)
  PerFinger<double> end_sd;

  // From a log that has the fingers' orientation and place in the world.
  std::vector<Pose> pose;                     // the part's, at each row
  std::optional<PoseResidual> pose_residual;  // over all rows
  bool is_contradicted = false;           // without noise: by other rows of the log, or by the contacts in the world
  std::optional<PoseSpread> pose_spread;  // with noise: at the first contacts

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

}  // namespace rollfix
