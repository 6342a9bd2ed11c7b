#pragma once

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "rollfix/locate.hpp"
#include "rollfix/part.hpp"
#include "root_search.hpp"

namespace rollfix {

/// What a simple root is accurate to: this share of the perimeter, or kRootTurn over the slope of f (of two fingers,
/// through the inverse of J).
inline constexpr double kRootLength = 1e-9;
/// |f| at a root, radians.
inline constexpr double kRootTurn = kLeastTolerance;
/// A slope of f, or a singular value of J, below this share of the curvatures that it is made of is rounding noise.
inline constexpr double kNoSlope = 1e-10;
/// The search takes places no further apart than kLengthAccuracy P for one; what bounds it has so many times that to
/// spare.
inline constexpr double kSamePlaces = 4;
/// An angle is rounded to this share of itself.
inline constexpr double kAngleRounding = 1e-15;

/// At a convex corner Theta takes every value between its one-sided limits: the limit of a rounding of radius 0. So it
/// does at the tiny concave joint (kJointTurn) of a drawing whose digits were rounded. Elsewhere (a concave corner
/// included) the interval is the limits' hull or a single value.
struct AngleSet {
  Interval angles;
  bool pivot = false;    // a convex corner or a tiny joint: every value in between is taken
  bool concave = false;  // a concave corner: only the two ends are
};

/// Theta at s as a set. Places within kLengthAccuracy * P of a corner are at it, of a convex one as near as
/// `at_corner`.
AngleSet angle_set(const Part& part, double s, double at_corner = 0);

/// What is asked of first contacts: f_k = 0 for each reading, and of two fingers the facing equation where it is known.
struct ContactEquations {
  const Part& part;
  std::span<const Reading> readings;  // one or more, all of one finger or all of two
  // C in Theta(s) - Theta(t) = C mod 2 pi, radians; empty: not known, or one finger.
  std::optional<double> facing{};
  double at_corner = 0;  // contacts that are no further from a convex corner may be at it: lengths are known no better

  std::size_t fingers() const { return readings.front().fingers(); }
  /// How many equations: one for each reading, and the facing.
  std::size_t rows() const { return readings.size() + (facing ? 1 : 0); }
  /// More equations than unknown first contacts: roots are where all of them are 0 at once, if at all.
  bool is_overdetermined() const { return rows() > fingers(); }
  /// No reading says more than an interval: every contact was on a corner of the finger.
  bool is_open() const {
    return std::none_of(readings.begin(), readings.end(), [](const Reading& reading) { return reading.is_exact(); });
  }
};

/// The largest |f_k| at these first contacts, the facing equation's included, corners taken as sets: for the best
/// choice within the pivots, those of the first contacts being the same for all readings.
double residual_at(const ContactEquations& question, const PerFinger<double>& at);

/// Theta at a first contact of one finger ([0]) and where reading k's roll ends from there ([k + 1]), unwrapped,
/// radians; for a part without corners.
using Tangents = boost::container::small_vector<double, 4>;
Tangents tangents_of(const ContactEquations& question, std::size_t finger, double at);

/// Of two fingers the same as residual_at their first contacts. REQUIRES a part without corners.
double residual_of(const ContactEquations& question, const Tangents& of_a, const Tangents& of_b);

/// The tangents at the first and the last contacts, `at` and `end`, that are left possible. With noise the last ones
/// need not be where the last lengths end.
PerFinger<Pivot> pivots_at(const ContactEquations& question, const PerFinger<double>& at, const PerFinger<double>& end);

}  // namespace rollfix

namespace rollfix::locating {

/// A connected set of first contacts, as either search leaves it.
struct FoundSet {
  Kind kind = Kind::crossing;
  PerFinger<double> start;             // the first root, else where the residual is least; not wrapped
  PerFinger<Interval> extent;          // not wrapped
  PerFinger<bool> whole_loop;          // the extent is all of a closed boundary
  ShortList<PerFinger<double>> roots;  // not wrapped
  // Of two fingers' stretch a line through it, unwrapped, that is off by `family_error` at most; else empty.
  std::vector<PerFinger<double>> family{};
  double family_error = 0;
};

/// f_k at a place with its slopes: the curvature at each finger's last contact and at its first.
struct SlopeSample {
  double value = 0;  // f_k, radians
  PerFinger<double> start_curvature;
  PerFinger<double> end_curvature;
};

/// Makes placements of connected sets: wraps places, adds points and tangents, and says how sure they are.
class PlacementMaker {
 public:
  /// The part and the readings of the question must outlive it.
  explicit PlacementMaker(const ContactEquations& question) : question_(question) {}

  /// Fills in all that the search knows of a placement. What noise tells, such as its probability, stays unset.
  void make(FoundSet&& found, Placement& placement) const;
  /// The most frequent set, made directly: of one finger and one reading, one simple root that the search has a sample
  /// of. `panel`: that the root is on or next to, 0 where that is not known.
  void make_crossing(double root, std::size_t panel, const Interval& extent, const SlopeSample& sample,
                     Placement& placement) const;

 private:
  /// Start and end in [0, P), points and tangents there.
  void place(const PerFinger<double>& start, std::size_t likely_panel, Placement& placement) const;
  /// The residual, then error and sensitivity: of slopes, and (`describe_corner`) where a corner holds a finger.
  void describe_contacts(const PerFinger<double>& start, Placement& placement) const;
  void describe_corner(const FoundSet& found, Placement& placement) const;

  ContactEquations question_;
};

/// f_k of a reading at first contacts `at`, with both contacts' curvatures, as limits from above.
SlopeSample slope_sample(const Part& part, const Reading& reading, const PerFinger<double>& at);

/// Error and sensitivity of a crossing from the samples at its start, one per reading: where J has no inverse the error
/// is infinite and the sensitivity empty.
void describe_slopes(const ContactEquations& question, const SlopeSample* samples, Placement& placement);

/// Stretches of the boundary; mostly there are few.
using Stretches = boost::container::small_vector<Interval, 4>;

/// What the tree over the part's spirals leaves of the first contacts.
struct Candidates {
  Stretches stretches;
  SearchCounts counts;  // pairs of blocks that were looked at
};

/// The stretches of `range`, in rising order and apart, on which one finger's first contact can lie: everywhere else
/// some reading is off by more than the tolerance, whatever pivots at corners do, which bounds over runs of spirals
/// prove. They start and end where spirals do, or the range does; s = 0 of a closed outline may be in the last one, as
/// s = P. All of the range where the part has too few spirals to make it worth while.
Candidates find_candidates(const ContactEquations& question, const Interval& range, double tolerance);

/// A finger's first contacts whose rolls stay on the part: all of a closed outline, of an open one what leaves room for
/// every reading. Throws InputError: a roll longer than the open curve.
Interval first_contacts(const ContactEquations& question, std::size_t finger);

/// One finger: eqs. (4) and (5). The options' tolerance is at least kTurnAccuracy. Gives all but the status.
Search search_one(const ContactEquations& question, const LocateOptions& options);

/// Two: eqs. (8) and (9), and the facing equation.
Search search_two(const ContactEquations& question, const LocateOptions& options);

/// Joins pieces that touch into connected sets (across s = 0 on a closed outline), one placement each, and says
/// what kind of answer each is. What was found may be in any order, of all readings together.
std::vector<Placement> make_placements(const ContactEquations& question, Findings found);

}  // namespace rollfix::locating

namespace rollfix {

/// The tangent's angles anywhere in an interval of s; corners within rounding of its ends are in it.
Interval tangents_over(const Part& part, const Interval& contacts);

/// What a placement of two fingers consists of: its extent, or of a continuum boxes along its line in which both first
/// contacts move by no more than about `step`.
std::vector<PerFinger<Interval>> pieces_of(const Placement& placement, double step);

}  // namespace rollfix
