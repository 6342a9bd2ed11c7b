#pragma once

#include <boost/container/small_vector.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/locate/reading.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// What a search promises.
enum class Status {
  complete,   // every placement is listed, and there is no other
  incomplete  // the budget ran out or an interval could not be decided: Search::unresolved says where
};

/// How a placement answers, in terms of f_k(s) = Theta(s + L_k) - Theta(s) - theta_k.
enum class Kind {
  crossing,  // f changes sign
  touching,  // f does not: a double root, a kink, or a near miss within the tolerance
  stretch,   // f = 0 to 1e-12 rad on an interval: a continuum of answers
  corner     // decided by the pivot at a convex corner
};

using Values = boost::container::small_vector<double, 2>;  // few numbers, kept in place

/// How a placement's start moves when a reading does; one entry per reading, NaN where undefined.
struct Sensitivity {
  Values per_turn;    // ds/dtheta, length per radian: 1 / (kappa(t) - kappa(s))
  Values per_length;  // ds/dL, dimensionless: -kappa(t) / (kappa(t) - kappa(s))
};

/// Where the tangent may point at the two ends of a roll that starts or ends at a convex corner.
struct Pivot {
  Interval start;  // Theta at the first contact, radians, unwrapped
  Interval end;    // Theta at the last one
};

/// One answer: a connected set of first contacts on which every |f_k| is within the tolerance.
struct Placement {
  Kind kind = Kind::crossing;
  double start = 0;         // s of the first contact, in [0, P): the first root, else where the residual is least
  double end = 0;           // s of the last contact, in [0, P)
  Interval extent;          // the connected set: lo in [0, P), hi may exceed P; the whole loop is [0, P]
  bool whole_loop = false;  // the extent is all of a closed boundary
  Values roots;             // every exact root in it, in [0, P); of a stretch the first of its continuum
  double error = 0;         // bound on |start - true root|, length; infinite where the root is not simple
  double residual = 0;      // largest |f_k(start)|, radians
  Vec2 point;               // position of the first contact
  double tangent = 0;       // direction of its tangent, radians, in (-pi, pi]
  Sensitivity sensitivity;
  std::optional<Pivot> pivot;  // of a corner
};

/// The work that a search did.
struct SearchCounts {
  std::size_t intervals = 0;    // looked at
  std::size_t evaluations = 0;  // of the turning function
};

struct Search {
  Status status = Status::complete;
  std::vector<Placement> placements;  // ordered by start
  std::vector<Interval> unresolved;   // where a placement may be that is not listed
  SearchCounts counts;

  /// In plain words: "unique", "ambiguous (k)", "ambiguous (1 stretch)", "unobservable" (all of a closed part fits),
  /// "inconsistent" (nothing fits), or "undecided" (incomplete).
  std::string verdict() const;
};

struct LocateOptions {
  double tolerance = 1e-9;       // radians: how far |f_k| may be from 0; at least kTurnAccuracy is used
  std::size_t budget = 1000000;  // intervals to look at, beyond the part's own, before giving up (status incomplete)
};

/// Every place on the part where a finger can have started, given one reading, or several of the same roll (all
/// measured from the same first contact). Equations (4) and (5) by branch and prune on spirals: see docs/search.md.
/// Throws InputError: no reading, a number that is not finite, a roll longer than an open curve.
Search locate(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options = {});
Search locate(const Part& part, const Reading& reading, const LocateOptions& options = {});

}  // namespace rollfix
