#pragma once

#include <vector>

#include "march/walker.hpp"

namespace rollfix::march {

/// A simple zero of the density, the paper's z_i, or a joint at which its sign jumps.
struct SignChange {
  Position at;
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

}  // namespace rollfix::march
