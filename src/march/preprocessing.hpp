#pragma once

#include <cstddef>
#include <vector>

#include "march/path.hpp"

namespace rollfix::march {

/// A simple zero of the density, the paper's z_i, or a joint at which its sign jumps.
struct SignChange {
  /// with length and integral from s = 0
  Position at;
  /// of the density just beyond it
  int sign_after = 1;
};

/// What section 2.2 computes once per shape, in one walk of T/h steps: the z_i, with the length l(z_1, z_i) and the
/// integral Phi(z_1, z_i) of each as differences of their sums from s = 0.
struct Preprocessed {
  Position front;                    // s = 0
  Position back;                     // s = P, at the end of the last step
  Span loop;                         // over the whole outline: P and the total integral
  double variation = 0;              // integral of |g|, to a few digits: what rounding errors are measured against
  int first_sign = 1;                // of g just after s = 0
  std::vector<SignChange> changes;   // in order, s in [0, P)
  std::vector<double> curve_starts;  // arc length at which each curve of the outline starts
};

/// Throws Refusal for what the paper excludes: see Reason.
Preprocessed preprocess(const Path& path);

/// The density's value at a point of a curve.
struct Sample {
  double u = 0;
  double density = 0;
};

/// The density along each curve, at a few points per step, both ends of the curve included.
struct Samples {
  std::vector<std::vector<Sample>> curves;
  double scale = 0;  // largest |g| over the outline
};

Samples sample(const Path& path);

/// A zero of the density, or a joint at which its sign jumps.
struct Zero {
  std::size_t curve = 0;
  double u = 0;
  int sign_after = 1;
  bool simple = true;  // false: the slope vanishes too, with or without a sign change
};

struct Zeros {
  std::vector<Zero> list;  // in order; one at the seam of a closed outline comes first
  int first_sign = 1;      // of the density just after s = 0
};

/// Every zero of the density that is wider than the samples' spacing, or whose dip shows in them. REQUIRES that the
/// density is not zero on a whole curve.
Zeros find_zeros(const Path& path, const Samples& samples);

}  // namespace rollfix::march
