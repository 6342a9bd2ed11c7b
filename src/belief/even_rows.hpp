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

/// The fewest means, at most so many, that say what the rows say. `means_of(lots)` makes them of so many lots; none:
/// the motion goes too uneven for that.
template <class MeansOf>
auto fewest_means(std::size_t most, const MeansOf& means_of) {
  decltype(means_of(most)) means;
  for (std::size_t lots = kFewestMeans; lots <= most && !means; lots *= 2) means = means_of(lots);
  return means;
}

/// Whether rows follow a smooth motion, but for noise.
bool is_even(const Course& rows);

/// What the measurement was in the middle of each mean's rows; none: it goes too uneven for that.
/// REQUIRES kFewestMeans values or more.
std::optional<std::vector<double>> at_middles(const Course& means);

}  // namespace rollfix::belief
