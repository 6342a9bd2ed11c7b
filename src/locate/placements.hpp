#pragma once

#include <vector>

#include "corner_sets.hpp"
#include "rollfix/locate.hpp"

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

}  // namespace rollfix::locating
