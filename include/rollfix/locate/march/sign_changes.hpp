#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/locate/march/path.hpp"
#include "rollfix/locate/march/samples.hpp"

namespace rollfix::march {

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
