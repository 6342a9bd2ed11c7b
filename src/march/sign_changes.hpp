#pragma once

#include <cstddef>
#include <vector>

#include "march/path.hpp"

namespace rollfix::march {

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
