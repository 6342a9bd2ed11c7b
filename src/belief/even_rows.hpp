#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace rollfix::belief {

/// One measurement of neighbouring rows, or of means over lots of them.
struct Course {
  std::vector<double> values;
  double sd = 0;               // of the noise of one of them
  std::vector<double> rows{};  // of each lot; none: as many in each
};

/// Of rows with noise no fewer means are taken, where few are enough.
inline constexpr std::size_t kFewestMeans = 12;

/// Whether rows follow a smooth motion, but for noise.
bool is_even(const Course& rows);

/// What the measurement was in the middle of each mean's rows; none: it goes too uneven for that.
/// REQUIRES kFewestMeans values or more.
std::optional<std::vector<double>> at_middles(const Course& means);

}  // namespace rollfix::belief
